"""The states of a model's joints, of those that are listed and in that order.

Tags, defaults and timing are those of libgazebo_ros_joint_state_publisher.so in gazebo_ros_pkgs
2.9.2. A joint that is not there is named, and the others are told; Gazebo crashes.
"""

import logging

from ...core import NotFoundError
from ...plugin_registry import register
from ...runtime import Joint, JointStates, Output
from ..base import PeriodicPlugin
from ..parameters import says_defaults_to

logger = logging.getLogger(__name__)


@register('libgazebo_ros_joint_state_publisher.so')
class JointStatePublisher(PeriodicPlugin):
    """Tell positions and velocities of the `joints` in <jointName>. Output: `joint_states`."""

    prefix = 'GazeboRosJointStatePublisher Plugin (ns = {}/) '
    absent_namespace = empty_namespace = '{}'
    missing = staticmethod(says_defaults_to)

    def load(self) -> None:
        """Read the tags and find the joints."""
        names = ''.join(self.params.read('jointName', '').split()).split(',')
        self.joints: list[Joint] = []
        for name in filter(None, names):
            try:
                self.joints.append(self.model.joint(name))
            except NotFoundError as error:
                logger.error('%sJoint %s does not exist! It is left out: %s',
                             self.log_prefix, name, error)
        self.set_rate(self.params.rate('updateRate', 100.0))
        self.joint_states: Output[JointStates] = self.output('joint_states')

    def report(self) -> None:
        """Tell the states."""
        states = [joint.state() for joint in self.joints]
        positions, velocities = zip(*states, strict=True) if states else ((), ())
        self.joint_states.send(JointStates(
            tuple(joint.name for joint in self.joints), positions, velocities))
