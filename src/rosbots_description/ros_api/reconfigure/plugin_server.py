"""The dynamic_reconfigure server of a plugin."""

import contextlib
from collections.abc import Callable, Sequence

import rospy
from dynamic_reconfigure.encoding import Config
from dynamic_reconfigure.server import Server

from ..transport import NO_MASTER
from .parameters import Parameter, description

Post = Callable[[Callable[[], None]], None]  # passes a command to the thread that owns the world
_AT_START = ~0  # level of the library's call with the defaults or presets


class PluginReconfigure(Server):  # type: ignore[misc]  # it has no types
    """Advertises parameters of a plugin, and applies what is requested."""

    def __init__(
        self,
        parameters: Sequence[Parameter],
        name: str,
        post: Post,
        apply: Callable[[Config], None],
        use_presets: bool = False,
    ) -> None:
        """Advertise them in the namespace `name`.

        Args:
            apply: applies values, on the thread that owns the world.
            use_presets: whether to apply the values at the start, too, which the parameter server
                may have; otherwise the plugin has its own.
        Raises:
            rospy.ServiceException: there is a server in this namespace.
        """
        self._post, self._apply, self._use_presets = post, apply, use_presets
        try:
            super().__init__(description(parameters), self._reconfigure, name)
        except rospy.ServiceException:
            self._unregister_topics()
            raise

    def close(self) -> None:
        """Unregister the service and topics."""
        self.set_service.shutdown()
        self._unregister_topics()

    def _unregister_topics(self) -> None:
        for topic in (self.descr_topic, self.update_topic):
            topic.unregister()

    def _copy_to_parameter_server(self) -> None:
        with contextlib.suppress(*NO_MASTER):
            super()._copy_to_parameter_server()

    def _reconfigure(self, config: Config, level: int) -> Config:
        if self._use_presets or level != _AT_START:
            self._post(lambda: self._apply(config))
        return config
