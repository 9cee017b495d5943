"""Settings of a diff_drive_controller for dynamic_reconfigure.

Publishes:
    <controller>/parameter_descriptions (dynamic_reconfigure/ConfigDescription, latched)
    <controller>/parameter_updates (dynamic_reconfigure/Config, latched)
Services:
    <controller>/set_parameters (dynamic_reconfigure/Reconfigure)
Parameters:
    <controller>/left_wheel_radius_multiplier and others: written
"""

from dynamic_reconfigure.encoding import Config

from ...sim.controllers import DiffDriveController
from .parameters import Parameter
from .plugin_server import PluginReconfigure, Post

MULTIPLIERS = (
    'left_wheel_radius_multiplier',
    'right_wheel_radius_multiplier',
    'wheel_separation_multiplier',
)
RATE, TRANSFORM = 'publish_rate', 'enable_odom_tf'


def serve_settings(controller: DiffDriveController, name: str, post: Post) -> PluginReconfigure:
    """Let dynamic_reconfigure change a diff_drive_controller, in the namespace `name`."""
    values = controller.params.values
    parameters = (
        *(
            Parameter(one, getattr(controller, one), 0.5, 1.5, 'factor of the wheels')
            for one in MULTIPLIERS
        ),
        Parameter(RATE, float(values[RATE]), 0.0, 2000.0, 'of odometry [Hz]'),
        Parameter(
            TRANSFORM,
            controller.enable_odom_tf,
            False,
            True,
            'whether the transform to the base is published',
        ),
    )

    def apply(config: Config) -> None:
        for one in (*MULTIPLIERS, TRANSFORM):
            setattr(controller, one, config[one])
        if config[RATE] != values[RATE]:
            values[RATE] = config[RATE]
            controller.set_publish_rate(config[RATE])

    return PluginReconfigure(parameters, name, post, apply)
