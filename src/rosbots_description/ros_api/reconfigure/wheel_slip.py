"""Slip compliances for dynamic_reconfigure.

Publishes:
    /<namespace>/parameter_descriptions (dynamic_reconfigure/ConfigDescription, latched)
    /<namespace>/parameter_updates (dynamic_reconfigure/Config, latched)
Services:
    /<namespace>/set_parameters (dynamic_reconfigure/Reconfigure)
Parameters:
    /<namespace>/slip_compliance_unitless_lateral and _longitudinal: presets are used
"""

import contextlib
import logging
from collections.abc import Callable

from dynamic_reconfigure.encoding import Config
from dynamic_reconfigure.server import Server as ReconfigureServer

from ...sim.plugins import WheelSlip
from ..transport import NO_MASTER
from .physics import Parameter, description

logger = logging.getLogger(__name__)

LATERAL, LONGITUDINAL = (f'slip_compliance_unitless_{way}' for way in ('lateral', 'longitudinal'))
PARAMETERS = tuple(
    Parameter(name, -1.0, -1.0, 20.0, 'slip over friction, of all wheels; below 0: as described')
    for name in (LATERAL, LONGITUDINAL)
)


class SlipReconfigure(ReconfigureServer):
    """Lets dynamic_reconfigure change the slip compliances of a model's wheels."""

    def __init__(self, plugin: WheelSlip, post: Callable[[Callable[[], None]], None]) -> None:
        """Advertise them; `post` hands a command to the thread that owns the world."""
        self._plugin, self._post = plugin, post
        super().__init__(description(PARAMETERS), self._reconfigure, f'/{plugin.namespace}')

    def close(self) -> None:
        """Unregister the service and topics."""
        self.set_service.shutdown()
        for topic in (self.descr_topic, self.update_topic):
            topic.unregister()

    def _copy_to_parameter_server(self) -> None:
        with contextlib.suppress(*NO_MASTER):
            super()._copy_to_parameter_server()

    def _reconfigure(self, config: Config, _level: int) -> Config:
        given = {'lateral': config[LATERAL], 'longitudinal': config[LONGITUDINAL]}
        for way, value in given.items():
            if value >= 0.0:
                logger.info('Reconfigure request for the gazebo ros wheel_slip: %s. New %s slip '
                            'compliance: %.3e', self._plugin.model.name, way, value)
        self._post(lambda: self._plugin.set_compliance(**given))
        return config
