"""The dynamic_reconfigure server of a plugin."""

import contextlib
from collections.abc import Callable, Sequence

import rospy
from dynamic_reconfigure.encoding import Config
from dynamic_reconfigure.server import Server

from ..transport import NO_MASTER
from .parameters import Parameter, description

Post = Callable[[Callable[[], None]], None]  # passes a command to the thread that owns the world


class PluginReconfigure(Server):  # type: ignore[misc]  # it has no types
    """Advertises parameters of a plugin; a subclass applies them in `apply`."""

    def __init__(self, parameters: Sequence[Parameter], name: str) -> None:
        """Advertise them in the namespace `name`.

        Raises:
            rospy.ServiceException: there is a server in this namespace.
        """
        try:
            super().__init__(description(parameters), self._reconfigure, name)
        except rospy.ServiceException:
            self._unregister_topics()
            raise

    def apply(self, config: Config) -> None:
        """Apply the requested values; called from ROS's threads, and once by `__init__`."""
        raise NotImplementedError

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

    def _reconfigure(self, config: Config, _level: int) -> Config:
        self.apply(config)
        return config
