"""A link without gravity that follows a frame, pulled by critically damped springs.

Tags and behaviour are those of libgazebo_ros_hand_of_god.so in gazebo_ros_pkgs 2.9.2, including an
oddity: the torque is that of half the angle. Different on purpose: it takes the shorter rotation,
and the springs are no stiffer than stability allows: in Gazebo a small link flies away.
"""

import logging
import math
from dataclasses import replace

from ...core import (
    PluginError,
    Pose,
    Vector,
    as_vector,
    compose,
    conjugate,
    inverse,
    multiply,
    normalise,
    rotate,
    subtract,
)
from ...plugin_registry import register
from ...runtime import NEVER, FrameTransform, Output
from ..base import ModelPlugin


@register('libgazebo_ros_hand_of_god.so')
class HandOfGod(ModelPlugin):
    """Pull <linkName> towards the target pose.

    Output: `actual`, in each step since the first `follow`.
    """

    prefix = 'hand_of_god: '
    missing_level = logging.DEBUG
    target: Pose | None = None

    def load(self) -> None:
        """Read the tags; find the link and turn off its gravity."""
        read = self.params.read
        self._link, self._mount = self.link('linkName')
        self.frame = read('frameId', 'hog')
        self.stiffness = read('kl', 200.0)  # [N/m]
        self.angular_stiffness = read('ka', 200.0)  # [N m/rad]
        spec = self._link.spec
        if self.model.static or spec.inertial is None:
            raise PluginError(f"{self.log_prefix}link '{spec.name}' cannot move")
        if min(self.stiffness, self.angular_stiffness) < 0.0:
            raise PluginError(f'{self.log_prefix}<kl> and <ka> must not be negative')
        self._inertial = spec.inertial
        self.model.change_links(lambda one: replace(one, gravity=False) if one is spec else one)
        self.actual: Output[FrameTransform] = self.output('actual')

    def follow(self, pose: Pose) -> None:
        """Pull the link towards a pose in the world, until the next call.

        Raises:
            ValueError: a number is not finite.
        """
        if not all(map(math.isfinite, (*pose.position, *pose.orientation))):
            raise ValueError(f'a link follows finite numbers; it got {pose}')
        self.target = Pose(pose.position, normalise(pose.orientation))
        self.reset()

    def reset(self) -> None:
        """Keep the target."""
        self.due = NEVER if self.target is None else self.world.clock.steps + 1

    def before_step(self) -> None:
        """Apply the springs."""
        if self.target is None:
            return
        pose, (linear, angular) = self._link.state()
        target, inertial = compose(self.target, inverse(self._mount)), self._inertial
        force = self._spring(
            subtract(target.position, pose.position),
            linear,
            self.stiffness,
            inertial.mass,
            inertial.mass,
        )
        back = conjugate(pose.orientation)
        torque = self._spring(
            _half_rotation(multiply(back, target.orientation)),
            rotate(back, angular),
            self.angular_stiffness,
            inertial.ixx,
            min(inertial.ixx, inertial.iyy, inertial.izz),
        )
        self._link.apply_wrench(force, rotate(pose.orientation, torque))
        self.runs_after_step, self.due = self.is_read, self.world.clock.steps + 1

    def after_step(self) -> None:
        """Send the pose of the link."""
        pose = compose(self._link.pose, self._mount)
        self.actual.send(FrameTransform('world', f'{self.frame}_actual', pose))

    def _spring(
        self, away: Vector, velocity: Vector, stiffness: float, inertia: float, least: float
    ) -> Vector:
        """Return the effort of a spring that is critically damped for an inertia.

        Args:
            away: displacement to the target.
            least: the least inertia of all axes.
        """
        # With explicit steps h the critical damping c = 2 sqrt(k I) must satisfy c h / I <= 1.
        step = self.world.physics.step_size
        stiffness = min(stiffness, (least / step) ** 2 / (4.0 * inertia))
        damping = 2.0 * math.sqrt(stiffness * inertia)
        return as_vector(stiffness * s - damping * v for s, v in zip(away, velocity, strict=True))


def _half_rotation(q: tuple[float, float, float, float]) -> Vector:
    """Return half the angle [rad] of a rotation times its axis; the angle is at most pi."""
    x, y, z, w = q if q[3] >= 0.0 else tuple(-part for part in q)
    sine = math.sqrt(x * x + y * y + z * z)
    share = math.atan2(sine, w) / sine if sine else 1.0
    return (share * x, share * y, share * z)
