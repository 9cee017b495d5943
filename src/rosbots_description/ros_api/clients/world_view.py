"""What a window needs of a simulator: its scene while somebody looks, and commands to it.

Subscribes:
    gazebo/view/scene, gazebo/view/motion: between `open` and `close`.
Publishes:
    the topic of `drive` (geometry_msgs/Twist), from its first command on.
"""

import time
from collections.abc import Callable
from typing import Any

import rospy
from gazebo_msgs.srv import GetPhysicsProperties, SetPhysicsProperties
from geometry_msgs.msg import Twist
from rosbots_msgs.srv import Step
from std_msgs.msg import Float64MultiArray, String
from std_srvs.srv import Empty

from ...sim.core import SimError
from ...sim.description import SceneChange, ShownMotion
from ..messages import read_motion, scene_change
from ..transport import NO_MASTER
from .gazebo_interface import interruptibly

TIMEOUT = 10.0  # for an answer [s, wall]
STEP_TIMEOUT = 600.0  # for many steps
CONNECTION = 0.5  # [s, wall] that the first command waits for its robot


class WorldView:
    """A view of the simulator `gazebo` of this node's namespace."""

    def __init__(self) -> None:
        self._subscribers: list[rospy.Subscriber] = []
        self._commands: rospy.Publisher | None = None

    def open(self, change: Callable[[SceneChange], None],
             motion: Callable[[ShownMotion], None]) -> None:
        """Subscribe; the callbacks are called from threads of their own."""
        self._subscribers = [
            rospy.Subscriber('gazebo/view/scene', String, lambda m: change(scene_change(m))),
            rospy.Subscriber('gazebo/view/motion', Float64MultiArray,
                             lambda m: motion(read_motion(m)), queue_size=1, tcp_nodelay=True)]

    def close(self) -> None:
        """Unsubscribe: the simulator computes nothing for this view any more."""
        for subscriber in self._subscribers:
            subscriber.unregister()
        self._subscribers = []

    def drive_topics(self) -> list[str]:
        """Return the topics of velocity commands that other nodes subscribe to; [] if unknown."""
        master = rospy.get_master()
        try:
            types = dict(master.getTopicTypes()[2])
            _, subscribed, _ = master.getSystemState()[2]
        except NO_MASTER:
            return []
        return sorted(name for name, nodes in subscribed
                      if types.get(name) == Twist._type and set(nodes) - {rospy.get_name()})

    def drive(self, topic: str, forward: float, left: float) -> None:
        """Publish a velocity command: forward [m/s], and turning left [rad/s]."""
        if self._commands is None or self._commands.name != topic:
            if self._commands is not None:
                self._commands.unregister()
            self._commands = rospy.Publisher(topic, Twist, queue_size=1)
            end = time.monotonic() + CONNECTION
            while not self._commands.get_num_connections() and time.monotonic() < end:
                time.sleep(0.01)
        command = Twist()
        command.linear.x, command.angular.z = forward, left
        self._commands.publish(command)

    def pause(self) -> None:
        """Pause simulated time."""
        _call('pause_physics', Empty)

    def unpause(self) -> None:
        """Continue simulated time."""
        _call('unpause_physics', Empty)

    def step(self, steps: int) -> None:
        """Pause and make so many steps."""
        self.pause()
        _call('step', Step, timeout=STEP_TIMEOUT, steps=steps)

    def reset_world(self) -> None:
        """Return every model to its spawn pose; time is kept."""
        _call('reset_world', Empty)

    def reset_simulation(self) -> None:
        """Restart at time zero."""
        _call('reset_simulation', Empty)

    def set_speed(self, factor: float) -> None:
        """Set the target real-time factor; 0: as fast as possible."""
        now = _call('get_physics_properties', GetPhysicsProperties)
        _call('set_physics_properties', SetPhysicsProperties, time_step=now.time_step,
              max_update_rate=factor / now.time_step, gravity=now.gravity,
              ode_config=now.ode_config)


def _call(name: str, kind: type[Any], timeout: float = TIMEOUT, **request: object) -> Any:  # noqa: ANN401  of each service's own type
    """Return the answer of a service of the simulator.

    Raises:
        SimError: it was not reached, did not answer in time, or refused.
    """
    service = rospy.resolve_name(f'gazebo/{name}')
    try:
        answer = interruptibly(lambda: rospy.ServiceProxy(service, kind)(**request), timeout)
    except (rospy.ServiceException, rospy.ROSException) as error:
        raise SimError(f'{service}: {error}') from error
    if not getattr(answer, 'success', True):
        raise SimError(answer.status_message)
    return answer
