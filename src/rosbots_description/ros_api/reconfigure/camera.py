"""The rate of a camera for dynamic_reconfigure.

Publishes:
    <camera>/parameter_descriptions (dynamic_reconfigure/ConfigDescription, latched)
    <camera>/parameter_updates (dynamic_reconfigure/Config, latched)
Services:
    <camera>/set_parameters (dynamic_reconfigure/Reconfigure)
Parameters:
    <camera>/imager_rate: written; the sensor's own rate applies until it is changed here
"""

from ...sim.sensors import CameraPlugin
from .parameters import Parameter
from .plugin_server import PluginReconfigure, Post

RATE = 'imager_rate'
PARAMETERS = (Parameter(RATE, 2.0, 1.0, 50.0, 'images per second of simulated time [Hz]'),)


def serve_rate(plugin: CameraPlugin, name: str, post: Post) -> PluginReconfigure:
    """Let dynamic_reconfigure change the rate of a camera, in the namespace `name`."""
    return PluginReconfigure(PARAMETERS, name, post, lambda config: plugin.set_rate(config[RATE]))
