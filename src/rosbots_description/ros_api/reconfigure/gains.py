"""The gains of a PID for dynamic_reconfigure, as control_toolbox describes them.

Publishes:
    <pid>/parameter_descriptions (dynamic_reconfigure/ConfigDescription, latched)
    <pid>/parameter_updates (dynamic_reconfigure/Config, latched)
Services:
    <pid>/set_parameters (dynamic_reconfigure/Reconfigure)
Parameters:
    <pid>/p, i, d, i_clamp_min, i_clamp_max, antiwindup: written
"""

from dynamic_reconfigure.encoding import Config

from ...sim.controllers import Gains, Pid
from .parameters import Parameter
from .plugin_server import PluginReconfigure, Post

_MAX, _MAX_D = 100000.0, 1000.0


def parameters(gains: Gains) -> tuple[Parameter, ...]:
    """Return the description; the defaults are `gains`."""
    return (
        Parameter('p', gains.p, -_MAX, _MAX, 'proportional gain'),
        Parameter('i', gains.i, -_MAX, _MAX, 'integral gain'),
        Parameter('d', gains.d, -_MAX_D, _MAX_D, 'derivative gain'),
        Parameter('i_clamp_min', gains.i_min, -_MAX, 0.0, 'lower bound of the integral term'),
        Parameter('i_clamp_max', gains.i_max, 0.0, _MAX, 'upper bound of the integral term'),
        Parameter(
            'antiwindup',
            gains.antiwindup,
            False,
            True,
            'bound the integral itself, not only its term',
        ),
    )


def serve_gains(pid: Pid, name: str, post: Post) -> PluginReconfigure:
    """Let dynamic_reconfigure change the gains of a PID, in the namespace `name`."""

    def apply(config: Config) -> None:
        pid.gains = Gains(
            config['p'],
            config['i'],
            config['d'],
            config['i_clamp_max'],
            config['i_clamp_min'],
            config['antiwindup'],
        )

    return PluginReconfigure(parameters(pid.gains), name, post, apply)
