"""The topics of a world's models, as ROS would have them."""

from collections.abc import Iterable, Mapping
from typing import Any, TypeVar

from ..sim import Output, World
from ..sim.core import suggestion
from ..sim.plugins import Force, ModelPlugin
from .records import check_vectors

Kind = TypeVar('Kind')

_TWIST = 'linear', 'angular'
_WRENCH = 'force', 'torque'


class Topics:
    """Finds outputs and commands of plugins by the names of their topics."""

    def __init__(self, world: World) -> None:
        self._outputs: dict[str, list[Output[Any]]] = {}
        self._commanded: dict[str, list[ModelPlugin]] = {}
        for plugin in _plugins(world):
            for name in plugin.topic_names:
                if name == 'command':
                    self._commanded.setdefault(plugin.topic(name), []).append(plugin)
                elif name in plugin.outputs:
                    self._outputs.setdefault(plugin.topic(name), []).append(plugin.outputs[name])

    def outputs(self, topic: str) -> list[Output[Any]]:
        """Return the outputs that are sent on a topic.

        Raises:
            ValueError: there are none.
        """
        return _found(topic, self._outputs, 'no plugin sends on')

    def send(self, topic: str, message: Mapping[str, Any]) -> None:
        """Command the plugins on a topic: drives by a Twist, `Force` by a Wrench.

        Raises:
            ValueError: nothing is commanded by the topic, or the message is not valid.
        """
        for plugin in _found(topic, self._commanded, 'no plugin takes commands on'):
            if isinstance(plugin, Force):
                plugin.command(*check_vectors(message, _WRENCH))  # type: ignore[arg-type]
            else:
                linear, angular = check_vectors(message, _TWIST)
                plugin.command(linear[0], angular[2], linear[1])  # type: ignore[attr-defined]


def _plugins(world: World) -> Iterable[ModelPlugin]:
    for model in world.models.values():
        for plugin in model.plugins.values():
            if isinstance(plugin, ModelPlugin):
                yield plugin


def _found(topic: str, known: Mapping[str, list[Kind]], what: str) -> list[Kind]:
    found = known.get('/' + topic.lstrip('/'))
    if not found:
        raise ValueError(f"{what} the topic '{topic}'{suggestion(topic, known)}")
    return found
