"""The true pose and twist of a link, in the world or in another link.

Tags, defaults and timing are those of libgazebo_ros_p3d.so in gazebo_ros_pkgs 2.9.2, including its
oddities: noise is on the twist only, <xyzOffset> is added in the axes of the frame, and in the
frame of another link rotations are multiplied in the wrong order and velocities rotated by the
inverse. A link that fixed joint reduction merged has its true pose; in Gazebo, and in a strict
world, its offset from the parent has the wrong sign.
"""

import logging
import random
from collections.abc import Mapping

from ...core import (
    IDENTITY,
    Fault,
    NotFoundError,
    Pose,
    Twist,
    Vector,
    add,
    as_vector,
    conjugate,
    from_rpy,
    multiply,
    normalise,
    report,
    rotate,
    subtract,
)
from ...plugin_registry import register
from ...runtime import WORLD_FRAMES, Link, Odometry, Output
from ..base import PeriodicPlugin, offsets_in_gazebo

_WORLD = {*WORLD_FRAMES, '/world'} - {''}


@register('libgazebo_ros_p3d.so')
class P3D(PeriodicPlugin):
    """Report pose and twist of <bodyName> in <frameName>, in the axes of that frame.

    Output: `odometry`. `body` is the name of the link, or of its parent after reduction.
    """

    topic_names: Mapping[str, str] = {'odometry': '<topicName>'}
    prefix = 'gazebo_ros_p3d plugin: '
    missing_level = logging.DEBUG
    hints: Mapping[str, str] = {
        'xyzOffsets': ' (the offset is <xyzOffset>)',
        'rpyOffsets': ' (it is <rpyOffset>)',
    }
    strictly_after = keeps_rate = False

    def load(self) -> None:
        """Read the tags; find the link and the frame.

        An unknown frame is an error in the log, and nothing is published.
        """
        params, read = self.params, self.params.read
        self._link, self._mount = self.link('bodyName')
        self.body = self._link.name
        params.required('topicName')
        self._frame: tuple[Link, Pose] | None = None  # None for the world
        frame = read('frameName', 'world')
        is_known = frame in _WORLD
        if not is_known:
            try:
                self._frame = self.model.locate(frame)
                is_known = True
            except NotFoundError as error:
                what = f'{self.log_prefix}frameName: {frame} does not exist, will not publish pose'
                report(Fault(f'{what}: {error}', logging.ERROR))
        self._shift, rpy = params.vector('xyzOffset'), params.vector('rpyOffset')  # [m], [rad]
        self._turn = from_rpy(*rpy)
        if self.world.strict and self._mount != IDENTITY:
            self._shift, self._turn = offsets_in_gazebo(self._mount, self._shift, rpy)
            self._mount = IDENTITY
        self.noise = read('gaussianNoise', 0.0)  # standard deviation [m/s and rad/s]
        self.set_rate(params.rate('updateRate', 0.0))
        self.odometry: Output[Odometry] = self.output('odometry', is_known)

    def report(self) -> None:
        """Send pose and twist."""
        pose, twist = self._link.state_at(self._mount)
        if self._frame is not None:
            link, mount = self._frame
            pose, twist = _seen_from(*link.state_at(mount), pose, twist)
        pose = Pose(
            add(pose.position, self._shift), normalise(multiply(self._turn, pose.orientation))
        )
        self.odometry.send(Odometry(pose, self._noisy(twist) if self.noise else twist))

    def _noisy(self, twist: Twist) -> Twist:
        """Return the twist with noise, which is reproducible whatever other readers do."""
        who = self.world.seed, self.model.name, self.spec.name, self.params.values['topicName']
        source = random.Random(f'{who} {self.world.clock.now_ns}')
        return Twist(*(add(one, self._sample(source)) for one in twist))

    def _sample(self, source: random.Random) -> Vector:
        return as_vector(source.gauss(0.0, self.noise) for _ in range(3))


def _seen_from(frame: Pose, moving: Twist, pose: Pose, twist: Twist) -> tuple[Pose, Twist]:
    """Return pose and twist in a moving frame, by upstream's formula."""
    back = conjugate(frame.orientation)
    position = rotate(back, subtract(pose.position, frame.position))
    return Pose(position, multiply(pose.orientation, back)), Twist(
        *(
            rotate(frame.orientation, subtract(own, others))
            for own, others in zip(twist, moving, strict=True)
        )
    )
