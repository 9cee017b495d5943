"""The rate of a camera for dynamic_reconfigure.

Publishes:
    <camera>/parameter_descriptions (dynamic_reconfigure/ConfigDescription, latched)
    <camera>/parameter_updates (dynamic_reconfigure/Config, latched)
Services:
    <camera>/set_parameters (dynamic_reconfigure/Reconfigure)
Parameters:
    <camera>/imager_rate: written; the sensor's own rate applies until it is changed here
"""

import contextlib
from collections.abc import Callable

from dynamic_reconfigure.encoding import Config
from dynamic_reconfigure.server import Server as ReconfigureServer

from ...sim.sensors import CameraPlugin
from ..transport import NO_MASTER
from .physics import Parameter, description

RATE = 'imager_rate'
PARAMETERS = (Parameter(RATE, 2.0, 1.0, 50.0, 'pictures per second of simulated time [Hz]'),)


class CameraReconfigure(ReconfigureServer):
    """Lets dynamic_reconfigure change the rate of a camera."""

    def __init__(
        self, plugin: CameraPlugin, name: str, post: Callable[[Callable[[], None]], None]
    ) -> None:
        """Advertise in the namespace `name`; `post` hands a command to the world's thread."""
        self._plugin, self._post = plugin, post
        self._begun = False
        super().__init__(description(PARAMETERS), self._reconfigure, name)

    def close(self) -> None:
        """Unregister the service and topics."""
        self.set_service.shutdown()
        for topic in (self.descr_topic, self.update_topic):
            topic.unregister()

    def _copy_to_parameter_server(self) -> None:
        with contextlib.suppress(*NO_MASTER):
            super()._copy_to_parameter_server()

    def _reconfigure(self, config: Config, _level: int) -> Config:
        # The library's first call is not a request: the sensor keeps its own rate.
        if self._begun:
            rate = config[RATE]
            self._post(lambda: self._plugin.set_rate(rate))
        self._begun = True
        return config
