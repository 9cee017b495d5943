"""What all drives share: a velocity command, updates at a rate, odometry of the model's motion."""

import logging
import math
from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..clock import NANOSECONDS
from ..errors import NotFoundError, PluginError
from ..pose import Pose, Twist, compose, from_rpy, inverse, yaw_of
from ..readings import FrameTransform, Odometry, Port
from .base import ModelPlugin
from .params import Params, says_default

if TYPE_CHECKING:
    from ..model import Joint

logger = logging.getLogger(__name__)

ENCODER, WORLD = 'encoder', 'world'
SLOWEST_RATE = 1e-3  # [Hz] updates rarer than that are a mistake
NO_VARIANCES = (0.0,) * 6


@dataclass(frozen=True)
class DriveConfig:
    """The tags that all drives have. Names are as written, without namespace or prefix."""

    command_topic: str
    odometry_topic: str
    odometry_frame: str
    robot_base_frame: str
    update_rate: float  # [Hz]; not above 0: every step


class Drive(ModelPlugin):
    """Follows a velocity command and reports odometry through the port `odometry`.

    A subclass reads its tags in `read_config` and finds its joints in `find_joints`. At the rate of
    its updates it follows the command in `follow`, before physics, and tells the state at the end
    of that step in `report`. As long as `every_step` is true, `advance` and `sample` are called
    before and after physics in every step.
    """

    prefix = ''  # how its log lines begin; {} stands for the namespace
    missing: Callable[[str, object], str] = staticmethod(says_default)
    named_after_model = True  # an absent or empty robotNamespace is the model's name, not the root
    keeps_rate = True  # the mean rate is exact; else each period is a step longer than asked for
    every_step = False
    # Diagonals of the covariances of odometry: x, y, z, roll, pitch, yaw.
    pose_variances = (1e-5, 1e-5, 1e12, 1e12, 1e12, 1e-3)
    twist_variances = NO_VARIANCES
    flat_odometry = False  # z is 0 in the message, though not in the transform
    moves_sideways = False  # whether it follows linear_y, too
    sends_odometry = True
    sends_transform = True

    def load(self) -> None:
        """Read the tags, find the joints, begin.

        Raises:
            PluginError: a joint is missing or a tag makes no sense.
        """
        self.namespace = self._namespace()
        self.log_prefix = self.prefix.format(self.namespace)
        self.params = Params(self.spec.element, self.log_prefix, self.missing)
        self.params.ignore('robotNamespace', 'alwaysOn')
        self.config = self.read_config(self.params)
        self.odometry = Port()
        self.find_joints()
        self._warn_unread()
        rate = self.config.update_rate
        self._period_ns = round(NANOSECONDS / rate) if rate > 0.0 else 0
        self.restart()

    @abstractmethod
    def read_config(self, params: Params) -> DriveConfig:
        """Read all tags with upstream's defaults.

        Raises:
            PluginError: a value makes no sense.
        """

    def find_joints(self) -> None:
        """Find what the plugin drives.

        Raises:
            PluginError: a joint is missing.
        """

    def advance(self, now_ns: int) -> None:
        """Do what is due before physics at every step."""

    def sample(self, now_ns: int) -> None:
        """Read what is to be read after physics at every step."""

    @abstractmethod
    def follow(self, elapsed: float) -> None:
        """Follow the command; the last time was `elapsed` seconds ago."""

    @abstractmethod
    def report(self) -> None:
        """Tell the state at the end of the step, which is that at its stamp."""

    def reset(self) -> None:
        """Forget the command and the time of the last update."""
        self.target = (0.0, 0.0, 0.0)
        self._reports = False
        self._last_ns = self.world.clock.now_ns
        self._set_due()

    def command(self, linear_x: float, angular_z: float, linear_y: float = 0.0) -> None:
        """Drive so until told else, as far as this drive can.

        Args:
            linear_x: forward [m/s].
            angular_z: turning left [rad/s].
            linear_y: to the left [m/s].
        """
        self.target = (linear_x, linear_y, angular_z)

    def update(self) -> None:
        """Do what is due at every step, and follow the command when the period has passed."""
        now_ns = self.world.clock.now_ns
        if self.every_step:
            self.advance(now_ns)
        elapsed_ns = now_ns - self._last_ns
        self._reports = elapsed_ns > self._period_ns
        if self._reports:
            self.follow(elapsed_ns / NANOSECONDS)
            keeps = self._period_ns and self.keeps_rate
            self._last_ns = self._last_ns + self._period_ns if keeps else now_ns
        self._set_due()

    def observe(self) -> None:
        """Read what is to be read at every step, and report in those that followed the command."""
        if self.every_step:
            self.sample(self.world.clock.now_ns)
        if self._reports:
            self.report()

    def _set_due(self) -> None:
        clock = self.world.clock
        later = clock.first_step_after(self._last_ns + self._period_ns)
        self.due = clock.steps + 1 if self.every_step else later

    def joint(self, name: str, what: str) -> 'Joint':
        """Return a joint by its name; `what` it is stands in the message of the `PluginError`."""
        try:
            return self.model.joint(name)
        except NotFoundError as error:
            raise PluginError(
                f"{self.log_prefix}couldn't get {what} joint named {name}: {error}"
            ) from None

    def _warn_unread(self) -> None:
        unread = self.params.unread()
        if unread:
            logger.warning(
                '%snot read by this plugin: %s%s',
                self.log_prefix,
                ', '.join(f'<{tag}>' for tag in unread),
                ' (the motor limit is <wheelTorque>)' if 'torque' in unread else '',
            )

    def _namespace(self) -> str:
        child = self.spec.element.child('robotNamespace')
        given = child.text.strip() if child is not None else ''
        return given or (self.model.name if self.named_after_model else '')


def odometry_source(params: Params) -> str:
    """Read where odometry comes from: ENCODER or WORLD; it is WORLD if that is neither."""
    # Upstream's warning shows the number behind `world`.
    text = params.read('odometrySource', WORLD, shown='1').lower()
    if text in (ENCODER, WORLD, '0', '1'):
        return {'0': ENCODER, '1': WORLD}.get(text, text)
    logger.warning(
        "%s<odometrySource> is '%s', which is neither encoder nor world; default is world",
        params.prefix,
        text,
    )
    return WORLD


def wheel_transforms(model, joints: 'list[Joint]', model_pose: Pose) -> list[FrameTransform]:
    """Return where the links of wheels stand in the model's frame, which upstream calls parent."""
    world_in_model = inverse(model_pose)
    return [
        FrameTransform(one.spec.parent, one.spec.child,
                       compose(world_in_model, model.links[one.spec.child].pose))
        for one in joints
    ]


def world_odometry(pose: Pose, twist: Twist) -> Odometry:
    """Return the model's true pose, and its twist in the plane in the model's own axes."""
    (vx, vy, _), (_, _, yaw_rate) = twist
    yaw = yaw_of(pose.orientation)
    cos, sin = math.cos(yaw), math.sin(yaw)
    linear = (cos * vx + sin * vy, cos * vy - sin * vx, 0.0)
    return Odometry(pose, Twist(linear, (0.0, 0.0, yaw_rate)))


class Encoders:
    """Where two wheels say that a robot is, by the angles that they have turned through.

    Their angles are what joint states tell, so both agree.
    """

    def __init__(self, left: 'Joint', right: 'Joint', diameter: float, separation: float) -> None:
        """Take the wheels, and their diameter and separation [m]; `reset` begins."""
        self._wheels, self._radius, self._separation = (left, right), diameter / 2.0, separation

    def reset(self, now_ns: int) -> None:
        """Begin anew at the origin."""
        self.place = (0.0, 0.0, 0.0)  # x [m], y [m], yaw [rad]
        self.rate = (0.0, 0.0, 0.0)  # of the same, by time
        self._ns, self._ways = now_ns, self._measure()

    def advance(self, now_ns: int, turning: float = 1.0) -> None:
        """Add what the wheels have turned; `turning` is -1 where left counts as right."""
        elapsed, self._ns = (now_ns - self._ns) / NANOSECONDS, now_ns
        before, self._ways = self._ways, self._measure()
        if elapsed <= 0.0:
            return
        left, right = (now - then for now, then in zip(self._ways, before, strict=True))
        x, y, yaw = self.place
        turn = turning * (right - left) / self._separation
        forward, heading = (left + right) / 2.0, yaw + turn / 2.0
        dx, dy = forward * math.cos(heading), forward * math.sin(heading)
        self.place = (x + dx, y + dy, yaw + turn)
        self.rate = (dx / elapsed, dy / elapsed, turn / elapsed)

    def _measure(self) -> tuple[float, ...]:
        """Return how far the rims have turned [m]."""
        return tuple(wheel.position * self._radius for wheel in self._wheels)

    @property
    def pose(self) -> Pose:
        """Return the place as a pose."""
        x, y, yaw = self.place
        return Pose((x, y, 0.0), from_rpy(0.0, 0.0, yaw))


def above_zero(params: Params, tag: str, value: float) -> float:
    """Return a length [m].

    Raises:
        PluginError: it is not above zero.
    """
    if value <= 0.0:
        raise PluginError(f'{params.prefix}<{tag}> is {value:g} m; it must be above 0')
    return value


def as_rate(params: Params, tag: str, value: float) -> float:
    """Return a rate [Hz] at which something can be done.

    Raises:
        PluginError: that would be hardly ever.
    """
    if 0.0 < value < SLOWEST_RATE:
        raise PluginError(
            f'{params.prefix}<{tag}> is {value:g} Hz; it must be at least '
            f'{SLOWEST_RATE:g}, or 0 for every step'
        )
    return value
