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


class DiffDriveReconfigure(PluginReconfigure):
    """Lets dynamic_reconfigure change a diff_drive_controller."""

    def __init__(self, controller: DiffDriveController, name: str, post: Post) -> None:
        """Advertise its settings in the namespace `name`."""
        self._controller, self._post = controller, post
        self._is_first = True
        super().__init__(
            (
                *(
                    Parameter(one, getattr(controller, one), 0.5, 1.5, 'factor of the wheels')
                    for one in MULTIPLIERS
                ),
                Parameter(
                    RATE, float(controller.params.values[RATE]), 0.0, 2000.0, 'of odometry [Hz]'
                ),
                Parameter(
                    TRANSFORM,
                    controller.enable_odom_tf,
                    False,
                    True,
                    'whether the transform to the base is published',
                ),
            ),
            name,
        )

    def apply(self, config: Config) -> None:
        """Set them, but not for the library's first call: they are those of the controller."""
        if not self._is_first:
            self._post(lambda: self._set(config))
        self._is_first = False

    def _set(self, config: Config) -> None:
        for one in (*MULTIPLIERS, TRANSFORM):
            setattr(self._controller, one, config[one])
        if config[RATE] != self._controller.params.values[RATE]:
            self._controller.params.values[RATE] = config[RATE]
            self._controller.set_publish_rate(config[RATE])
