"""The states of the listed joints of a model, in the order of the list.

Tags, defaults and timing are those of libgazebo_ros_joint_state_publisher.so in gazebo_ros_pkgs
2.9.2. An unknown joint is named in the log, and the others are published; Gazebo crashes.
"""

import logging
from collections.abc import Mapping

from ...core import Fault, NotFoundError, report
from ...plugin_registry import register
from ...runtime import Joint, JointStates, Output
from ..base import PeriodicPlugin
from ..parameters import says_defaults_to


@register('libgazebo_ros_joint_state_publisher.so')
class JointStatePublisher(PeriodicPlugin):
    """Report positions and velocities of the `joints` in <jointName>. Output: `joint_states`."""

    topic_names: Mapping[str, str] = {'joint_states': 'joint_states'}
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
                what = f'{self.log_prefix}Joint {name} does not exist! It is left out: {error}'
                report(Fault(what, logging.ERROR))
        self.set_rate(self.params.rate('updateRate', 100.0))
        self.joint_states: Output[JointStates] = self.output('joint_states')

    def report(self) -> None:
        """Send the states."""
        states = [joint.state() for joint in self.joints]
        positions, velocities = zip(*states, strict=True) if states else ((), ())
        self.joint_states.send(
            JointStates(tuple(joint.name for joint in self.joints), positions, velocities)
        )
