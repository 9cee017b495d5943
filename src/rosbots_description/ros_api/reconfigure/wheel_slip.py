"""Slip compliances for dynamic_reconfigure.

Publishes:
    /<namespace>/parameter_descriptions (dynamic_reconfigure/ConfigDescription, latched)
    /<namespace>/parameter_updates (dynamic_reconfigure/Config, latched)
Services:
    /<namespace>/set_parameters (dynamic_reconfigure/Reconfigure)
Parameters:
    /<namespace>/slip_compliance_unitless_lateral and _longitudinal: presets are used
"""

import logging

from dynamic_reconfigure.encoding import Config

from ...sim.plugins import WheelSlip
from .parameters import Parameter
from .plugin_server import PluginReconfigure, Post

logger = logging.getLogger(__name__)

LATERAL, LONGITUDINAL = (
    f'slip_compliance_unitless_{direction}' for direction in ('lateral', 'longitudinal')
)
PARAMETERS = tuple(
    Parameter(name, -1.0, -1.0, 20.0, 'slip over friction, of all wheels; below 0: as described')
    for name in (LATERAL, LONGITUDINAL)
)


def serve_slip(plugin: WheelSlip, post: Post) -> PluginReconfigure:
    """Let dynamic_reconfigure change the slip compliances of a model's wheels.

    Negative ones are those of the description.
    """

    def apply(config: Config) -> None:
        given = {'lateral': config[LATERAL], 'longitudinal': config[LONGITUDINAL]}
        for direction, value in given.items():
            if value >= 0.0:
                logger.info(
                    'Reconfigure request for the gazebo ros wheel_slip: %s. New %s slip '
                    'compliance: %.3e',
                    plugin.model.name,
                    direction,
                    value,
                )
        plugin.set_compliance(**given)

    return PluginReconfigure(PARAMETERS, f'/{plugin.namespace}', post, apply, use_presets=True)
