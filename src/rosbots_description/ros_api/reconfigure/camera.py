"""The rate of a camera for dynamic_reconfigure.

Publishes:
    <camera>/parameter_descriptions (dynamic_reconfigure/ConfigDescription, latched)
    <camera>/parameter_updates (dynamic_reconfigure/Config, latched)
Services:
    <camera>/set_parameters (dynamic_reconfigure/Reconfigure)
Parameters:
    <camera>/imager_rate: written; the sensor's own rate applies until it is changed here
"""

from dynamic_reconfigure.encoding import Config

from ...sim.sensors import CameraPlugin
from .parameters import Parameter
from .plugin_server import PluginReconfigure, Post

RATE = 'imager_rate'
PARAMETERS = (Parameter(RATE, 2.0, 1.0, 50.0, 'images per second of simulated time [Hz]'),)


class CameraReconfigure(PluginReconfigure):
    """Lets dynamic_reconfigure change the rate of a camera."""

    def __init__(self, plugin: CameraPlugin, name: str, post: Post) -> None:
        """Advertise it in the namespace `name`."""
        self._plugin, self._post = plugin, post
        self._is_first = True
        super().__init__(PARAMETERS, name)

    def apply(self, config: Config) -> None:
        """Set the rate, but not for the library's first call: the sensor has its own."""
        if not self._is_first:
            rate = config[RATE]
            self._post(lambda: self._plugin.set_rate(rate))
        self._is_first = False
