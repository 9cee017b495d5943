"""The controllers of a robot: the services and topics of gazebo_ros_control.

Subscribes:
    <ns>/<eStopTopic> (std_msgs/Bool), if the tag is given: true takes the effort from all joints.
Services:
    <ns>/controller_manager/..., see `services`
Parameters:
    <robotParam> (robot_description), searched from the namespace upward: read once; the controllers
        wait for it, and the world goes on.
    <ns>/joint_limits/<joint>/..., <ns>/gazebo_ros_control/pid_gains/<joint>/...: read at that time,
        and by the mimic plugin, if it has the tag <hasPID>, when it is loaded

What controllers alone need is imported when a robot has them.
"""

import logging
import threading
from typing import cast

import rospy
from std_msgs.msg import Bool

from ....sim.controllers import Gains, MimicJointPlugin, Pid, RosControl
from ....sim.core import SimError
from ....sim.formats import load_robot_control
from ...server import LoopError
from ...transport import is_valid_name, read_parameter, search_parameter, topic_name
from ..adapter import Adapter, owner_name
from ..declarations import Endpoint
from ..registry import AdapterSet, declare_topics

logger = logging.getLogger(__name__)

PERIOD = 0.1  # between two looks for the description [s, wall], as upstream
SETTINGS = ('joint_limits', 'gazebo_ros_control')  # parameters of the simulated hardware


class ControlEndpoint(Endpoint):
    """Configures the plugin from parameters, and offers services and topics from then on."""

    def __init__(self, adapter: Adapter) -> None:
        super().__init__(adapter, 'controller_manager')
        self._plugin = cast(RosControl, adapter.plugin)
        self._topics = AdapterSet(adapter.server)
        self._closed = threading.Event()
        if is_valid_name(self.name):  # otherwise it is not opened
            self._plugin.postpone()

    def open(self) -> None:
        """Subscribe to the emergency stop, and begin to wait for the description."""
        self.adapter.on_close(self._closed.set)
        if self._plugin.e_stop_topic:
            self._open_emergency_stop(topic_name(self._plugin.namespace, self._plugin.e_stop_topic))
        threading.Thread(target=self._configure, name='robot_description', daemon=True).start()

    def refresh(self) -> None:
        """Connect the outputs of controllers that have subscribers."""
        self._topics.refresh()

    def disconnect(self) -> None:
        """Close the topics of the controllers."""
        self._closed.set()
        if self._plugin.is_configured:
            self._plugin.manager.changed.disconnect(self._follow)
        self._topics.set_to([])

    def _open_emergency_stop(self, topic: str) -> None:
        if not is_valid_name(topic):
            logger.error(
                "%s: <eStopTopic> is '%s', which is no name of a topic",
                owner_name(self._plugin),
                self._plugin.e_stop_topic,
            )
            return

        def receive(message: Bool) -> None:
            self.adapter.server.loop.post(
                lambda: setattr(self._plugin, 'emergency_stop', message.data)
            )

        self.adapter.subscribe(topic, Bool, receive, 1)

    def _configure(self) -> None:
        """Wait for the description, and bring the controller manager up."""
        from . import (  # noqa: F401  register them
            grippers,
            sensor_states,
            topics,
            trajectories,
        )

        server, plugin = self.adapter.server, self._plugin
        try:
            text = self._wait_for_description()
            if text is None:
                return
            control = load_robot_control(text)
            settings = {
                key: read_parameter(topic_name(plugin.namespace, key), {}) for key in SETTINGS
            }
        except rospy.ROSInterruptException:
            return
        except SimError as error:
            logger.error(
                'Error parsing URDF in gazebo_ros_control plugin, plugin not active: %s', error
            )
            return

        def configure() -> None:
            if not self._closed.is_set():
                plugin.configure(control, settings)
                plugin.manager.changed.connect(self._follow)
                self._follow(None)
                server.registrar.post(self._offer)

        try:
            server.loop.call(configure)
        except LoopError:
            return  # the simulator ends
        except SimError as error:
            logger.critical('%s', error)
            logger.critical('Could not initialize robot simulation interface')

    def _wait_for_description(self) -> str | None:
        """Return the text of the description; None if the robot is deleted meanwhile."""
        plugin, told = self._plugin, False
        while not self._closed.is_set():
            name = search_parameter(plugin.namespace, plugin.robot_param)
            if not told:
                told = True
                logger.info(
                    'gazebo_ros_control plugin is waiting for model URDF in parameter '
                    '[%s] on the ROS param server.',
                    name or plugin.robot_param,
                )
            text = None if name is None else read_parameter(name)
            if isinstance(text, str) and text:
                return text
            self._closed.wait(PERIOD)
        return None

    def _offer(self) -> None:
        """Offer the services; called on the registrar's thread."""
        from .services import ManagerServices
        from .topics import open_gains

        if self._closed.is_set():
            return
        try:
            services = ManagerServices(self.adapter.server, self._plugin)
        except rospy.ServiceException:
            logger.warning(
                '%s: the services of %s are those of another robot; a <robotNamespace> of its '
                'own would give this one its own',
                owner_name(self._plugin),
                self.name,
            )
        else:
            self.adapter.on_close(services.close)
        open_gains(self.adapter, self._plugin.manager.robot.pids)

    def _follow(self, _changed: None) -> None:
        """Give each loaded controller its topics, and no others."""
        self._topics.set_to(list(self._plugin.controllers.values()))


class MimicGains(Endpoint):
    """The gains of a joint that follows another one by a force.

    They are read from the parameter server, and opened to dynamic_reconfigure.
    """

    def __init__(self, adapter: Adapter) -> None:
        super().__init__(adapter)
        self._plugin = cast(MimicJointPlugin, adapter.plugin)
        if self._plugin.gains_path:
            self._plugin.pid = Pid(Gains(0.0))  # until the gains are read

    def open(self) -> None:
        """Read the gains; the plugin has them between two steps."""
        from .topics import open_gains

        adapter, plugin = self.adapter, self._plugin
        path = plugin.gains_path
        if not path:
            return
        *outer, last = path.split('/')
        parameters = {last: read_parameter(topic_name(plugin.namespace, path), {})}
        for key in reversed(outer):
            parameters = {key: parameters}

        def configure() -> None:
            plugin.configure(parameters)
            assert plugin.pid is not None
            gains = {path: plugin.pid}
            adapter.server.registrar.post(lambda: open_gains(adapter, gains))

        adapter.server.loop.post(configure)


declare_topics(RosControl, ControlEndpoint)
declare_topics(MimicJointPlugin, MimicGains)
