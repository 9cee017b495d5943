"""The differential drive: two wheel joints follow a planar velocity, odometry comes back.

Behaviour, defaults and timing are those of libgazebo_ros_diff_drive.so in gazebo_ros_pkgs 2.9.2.
"""

import logging
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..clock import NANOSECONDS
from ..errors import NotFoundError, PluginError
from ..pose import Pose, Twist, compose, from_rpy, inverse, yaw_of
from ..readings import FrameTransform, JointStates, Odometry, Port
from ..wheel_geometry import drives_towards_x, radius_of, same_way, track_of
from .base import ModelPlugin
from .params import Params
from .registry import register

if TYPE_CHECKING:
    from ..model import Joint

logger = logging.getLogger(__name__)

ENCODER, WORLD = 'encoder', 'world'
SLOWEST_RATE = 1e-3  # [Hz] updates rarer than that are a mistake
REACHED = 0.01  # [m/s] rim speed this close to the target ends a ramp
DRAGGED = 0.015  # share of its speed that a robot loses that drags a caster (doc/physics.md)
TOLERATED = 0.02  # share by which a wheel may differ from its description without a warning


@dataclass(frozen=True)
class DiffDriveConfig:
    """The plugin's tags, read and checked. Names are as written, without namespace or prefix."""

    command_topic: str
    odometry_topic: str
    odometry_frame: str
    robot_base_frame: str
    left_joint: str
    right_joint: str
    wheel_separation: float  # [m]
    wheel_diameter: float  # [m]
    wheel_acceleration: float  # [m/s^2] at the rim; 0: no limit
    wheel_torque: float  # [N m] per wheel
    update_rate: float  # [Hz]; not above 0: every step
    odometry_source: str  # ENCODER or WORLD
    publish_tf: bool  # odometry message and its transform
    publish_odom_tf: bool  # only the transform
    publish_wheel_tf: bool
    publish_wheel_joint_state: bool
    ros_debug_level: str


def read_config(params: Params) -> DiffDriveConfig:
    """Read all tags with upstream's defaults and in upstream's order.

    Raises:
        PluginError: a number is none, or a size is not above zero.
    """
    read = params.read
    params.ignore('robotNamespace', 'alwaysOn')
    config = DiffDriveConfig(
        ros_debug_level=read('rosDebugLevel', 'na'),
        command_topic=read('commandTopic', 'cmd_vel'),
        odometry_topic=read('odometryTopic', 'odom'),
        odometry_frame=read('odometryFrame', 'odom'),
        robot_base_frame=read('robotBaseFrame', 'base_footprint'),
        publish_tf=read('publishTf', True),
        publish_wheel_tf=read('publishWheelTF', False),
        publish_odom_tf=read('publishOdomTF', True),
        publish_wheel_joint_state=read('publishWheelJointState', False),
        wheel_separation=read('wheelSeparation', 0.34),
        wheel_diameter=read('wheelDiameter', 0.15),
        wheel_acceleration=read('wheelAcceleration', 0.0),
        wheel_torque=read('wheelTorque', 5.0),
        update_rate=read('updateRate', 100.0),
        left_joint=read('leftJoint', 'left_joint'),
        right_joint=read('rightJoint', 'right_joint'),
        odometry_source=_odometry_source(params),
    )
    for tag, value in (
        ('wheelSeparation', config.wheel_separation),
        ('wheelDiameter', config.wheel_diameter),
    ):
        if value <= 0.0:
            raise PluginError(f'{params.prefix}<{tag}> is {value:g} m; it must be above 0')
    if 0.0 < config.update_rate < SLOWEST_RATE:
        raise PluginError(
            f'{params.prefix}<updateRate> is {config.update_rate:g} Hz; it must be at least '
            f'{SLOWEST_RATE:g}, or 0 for every step'
        )
    return config


def _odometry_source(params: Params) -> str:
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


@register('libgazebo_ros_diff_drive.so')
class DiffDrive(ModelPlugin):
    """Drive two wheel joints from a planar velocity command; report odometry.

    Outputs, each a `Port`: `odometry` (`Odometry`), `wheel_transform` (`FrameTransform`, once per
    wheel) and `joint_states` (`JointStates`: right, left). `wheels` are the joints, left first.
    """

    def load(self) -> None:
        """Read the tags, find the joints, set the motors.

        Raises:
            PluginError: a joint is missing or a tag makes no sense.
        """
        self.namespace = self._namespace()
        self.log_prefix = f'DiffDrive(ns = {self.namespace}/): '
        self.params = Params(self.spec.element, self.log_prefix)
        self.config = read_config(self.params)
        self.odometry, self.wheel_transform, self.joint_states = Port(), Port(), Port()
        self.wheels = (self._wheel(self.config.left_joint), self._wheel(self.config.right_joint))
        self._warn_unread()
        self._warn_geometry()
        self._warn_sides()
        rate = self.config.update_rate
        self._period_ns = round(NANOSECONDS / rate) if rate > 0.0 else 0
        self.restart()

    def restart(self) -> None:
        """Forget everything, the ramp too, and let the motors hold the wheels."""
        # Rim speeds [m/s], left and right, that the ramp has come to. As upstream's, they are
        # never brought in line with the wheels.
        self._setpoint = [0.0, 0.0]
        self.reset()
        for wheel in self.wheels:
            wheel.set_motor(0.0, self.config.wheel_torque)

    def reset(self) -> None:
        """Forget command, encoder odometry and the time of the last update."""
        self._command = (0.0, 0.0)
        self._encoder_pose = (0.0, 0.0, 0.0)  # x [m], y [m], yaw [rad]
        self._encoder_twist = (0.0, 0.0)  # forward [m/s], yaw rate [rad/s]
        self._encoder_ways = self._ways()
        self._encoder_ns = self.world.clock.now_ns
        self._reports = False
        self._last_ns = self.world.clock.now_ns
        self._set_due()

    def command(self, linear_x: float, angular_z: float) -> None:
        """Drive forward at `linear_x` [m/s] turning left at `angular_z` [rad/s] until told else."""
        self._command = (linear_x, angular_z)

    def update(self) -> None:
        """Steer when the period has passed; `observe` then publishes."""
        now_ns = self.world.clock.now_ns
        elapsed_ns = now_ns - self._last_ns
        self._reports = elapsed_ns > self._period_ns
        if self._reports:
            self._steer(elapsed_ns / NANOSECONDS)
            self._last_ns = self._last_ns + self._period_ns if self._period_ns else now_ns
        self._set_due()

    def observe(self) -> None:
        """Integrate the encoders at every step; publish in those in which the robot was steered."""
        if self.config.odometry_source == ENCODER:
            self._integrate_encoders(self.world.clock.now_ns)
        if self._reports:
            self._publish()

    def _set_due(self) -> None:
        clock = self.world.clock
        if self.config.odometry_source == ENCODER:
            self.due = clock.steps + 1
        else:
            self.due = clock.first_step_after(self._last_ns + self._period_ns)

    def _steer(self, elapsed: float) -> None:
        config, (x, yaw_rate) = self.config, self._command
        half = yaw_rate * config.wheel_separation / 2.0
        target = (x - half, x + half)
        limit = config.wheel_acceleration * elapsed
        radius = config.wheel_diameter / 2.0
        missing = [
            goal - wheel.velocity * radius for goal, wheel in zip(target, self.wheels, strict=True)
        ]
        if limit > 0.0 and min(abs(missing[0]), abs(missing[1])) >= REACHED:
            for i in (0, 1):
                self._setpoint[i] += max(-limit, min(limit, missing[i]))
            target = self._setpoint
        for wheel, speed in zip(self.wheels, target, strict=True):
            wheel.set_motor(speed / radius, config.wheel_torque)

    def _publish(self) -> None:
        config = self.config
        odometry = config.publish_tf and self.odometry.wanted()
        wheels = config.publish_wheel_tf and self.wheel_transform.wanted()
        if odometry or wheels:
            pose, twist = self.model.state()  # once: the engine takes its time to tell
        if odometry:
            encoder = config.odometry_source == ENCODER
            self.odometry.send(
                self._encoder_odometry() if encoder else _world_odometry(pose, twist)
            )
        if wheels:
            self._send_wheel_transforms(pose)
        if config.publish_wheel_joint_state and self.joint_states.wanted():
            left, right = self.wheels
            self.joint_states.send(
                JointStates((right.name, left.name), (right.position, left.position))
            )

    def _send_wheel_transforms(self, model_pose: Pose) -> None:
        world_in_model = inverse(model_pose)
        for spec in (wheel.spec for wheel in self.wheels):
            pose = compose(world_in_model, self.model.links[spec.child].pose)
            self.wheel_transform.send(FrameTransform(spec.parent, spec.child, pose))

    def _encoder_odometry(self) -> Odometry:
        x, y, yaw = self._encoder_pose
        speed, yaw_rate = self._encoder_twist
        return Odometry(
            Pose((x, y, 0.0), from_rpy(0.0, 0.0, yaw)),
            Twist((speed, 0.0, 0.0), (0.0, 0.0, yaw_rate)),
        )

    def _integrate_encoders(self, now_ns: int) -> None:
        """Add one step of wheel motion by upstream's formula; its speed is never negative.

        The wheels' angles are what is added up, so that odometry and joint states agree.
        """
        elapsed = (now_ns - self._encoder_ns) / NANOSECONDS
        self._encoder_ns = now_ns
        before, self._encoder_ways = self._encoder_ways, self._ways()
        if elapsed <= 0.0:
            return
        left, right = (now - then for now, then in zip(self._encoder_ways, before, strict=True))
        x, y, yaw = self._encoder_pose
        difference = right - left
        forward = (left + right) / 2.0
        heading = yaw + difference / (2.0 * self.config.wheel_separation)
        dx, dy = forward * math.cos(heading), forward * math.sin(heading)
        turn = difference / self.config.wheel_separation
        self._encoder_pose = (x + dx, y + dy, yaw + turn)
        self._encoder_twist = (math.hypot(dx, dy) / elapsed, turn / elapsed)

    def _ways(self) -> tuple[float, ...]:
        """Return how far the rims of the wheels have turned [m]."""
        return tuple(wheel.position * self.config.wheel_diameter / 2.0 for wheel in self.wheels)

    def _namespace(self) -> str:
        """Return the tag's text; the model's name where it is absent or empty."""
        child = self.spec.element.child('robotNamespace')
        return (child.text.strip() if child is not None else '') or self.model.name

    def _wheel(self, name: str) -> 'Joint':
        try:
            return self.model.joint(name)
        except NotFoundError as error:
            raise PluginError(
                f"{self.log_prefix}couldn't get wheel hinge joint named {name}: {error}"
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

    def _warn_geometry(self) -> None:
        """Say so when the numbers given contradict the wheels that touch the ground."""
        left, right = self.wheels
        radius, track = radius_of(left), abs(track_of(left, right))
        if radius is None or radius_of(right) is None or not track:
            return
        config = self.config
        forward = 2.0 * radius / config.wheel_diameter
        turn = forward * config.wheel_separation / track
        if abs(forward - 1.0) > TOLERATED or abs(turn / forward - 1.0) > TOLERATED:
            logger.warning(
                '%swheelDiameter %g m and wheelSeparation %g m contradict the collision geometry '
                '(%.3g m and %.3g m): expect the robot to drive at %.2f of the commanded speed and '
                'to turn at %.2f of the commanded rate, or at %.2f and %.2f if it drags a caster',
                self.log_prefix,
                config.wheel_diameter,
                config.wheel_separation,
                2.0 * radius,
                track,
                forward,
                turn,
                forward * (1.0 - DRAGGED),
                turn * (1.0 - DRAGGED),
            )

    def _warn_sides(self) -> None:
        """Say so when the robot will not go where it is asked to, in Gazebo as here."""
        left, right = self.wheels
        faults = []
        if not same_way(left, right):
            faults.append('spin when asked to drive straight; give both joints the same axis')
        else:
            if track_of(left, right) < 0.0:
                faults.append(
                    f"turn right when asked to turn left, for '{left.name}' is on the right side; "
                    'swap <leftJoint> and <rightJoint>'
                )
            if not drives_towards_x(left):
                faults.append('drive backwards when asked to drive on; reverse the joint axes')
        if faults:
            logger.warning('%sthis robot will %s', self.log_prefix, '. It will '.join(faults))


def _world_odometry(pose: Pose, twist: Twist) -> Odometry:
    """Return the model's true pose, and its twist in the plane in the model's own axes."""
    (vx, vy, _), (_, _, yaw_rate) = twist
    yaw = yaw_of(pose.orientation)
    cos, sin = math.cos(yaw), math.sin(yaw)
    linear = (cos * vx + sin * vy, cos * vy - sin * vx, 0.0)
    return Odometry(pose, Twist(linear, (0.0, 0.0, yaw_rate)))
