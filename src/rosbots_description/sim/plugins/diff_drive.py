"""The differential drive: two wheel joints follow a planar velocity, odometry comes back.

Behaviour, defaults and timing are those of libgazebo_ros_diff_drive.so in gazebo_ros_pkgs 2.9.2.
"""

import logging
import math
from dataclasses import dataclass

from ..pose import Twist
from ..readings import JointStates, Odometry, Port
from ..wheel_geometry import drives_towards_x, radius_of, same_way, track_of
from .drive import (
    ENCODER,
    Drive,
    DriveConfig,
    Encoders,
    above_zero,
    as_rate,
    odometry_source,
    wheel_transforms,
    world_odometry,
)
from .params import Params
from .registry import register

logger = logging.getLogger(__name__)

REACHED = 0.01  # [m/s] rim speed this close to the target ends a ramp
DRAGGED = 0.015  # share of its speed that a robot loses that drags a caster (doc/physics.md)
TOLERATED = 0.02  # share by which a wheel may differ from its description without a warning


@dataclass(frozen=True)
class DiffDriveConfig(DriveConfig):
    """The plugin's tags, read and checked."""

    left_joint: str
    right_joint: str
    wheel_separation: float  # [m]
    wheel_diameter: float  # [m]
    wheel_acceleration: float  # [m/s^2] at the rim; 0: no limit
    wheel_torque: float  # [N m] per wheel
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
    return DiffDriveConfig(
        ros_debug_level=read('rosDebugLevel', 'na'),
        command_topic=read('commandTopic', 'cmd_vel'),
        odometry_topic=read('odometryTopic', 'odom'),
        odometry_frame=read('odometryFrame', 'odom'),
        robot_base_frame=read('robotBaseFrame', 'base_footprint'),
        publish_tf=read('publishTf', True),
        publish_wheel_tf=read('publishWheelTF', False),
        publish_odom_tf=read('publishOdomTF', True),
        publish_wheel_joint_state=read('publishWheelJointState', False),
        wheel_separation=above_zero(params, 'wheelSeparation', read('wheelSeparation', 0.34)),
        wheel_diameter=above_zero(params, 'wheelDiameter', read('wheelDiameter', 0.15)),
        wheel_acceleration=read('wheelAcceleration', 0.0),
        wheel_torque=read('wheelTorque', 5.0),
        update_rate=as_rate(params, 'updateRate', read('updateRate', 100.0)),
        left_joint=read('leftJoint', 'left_joint'),
        right_joint=read('rightJoint', 'right_joint'),
        odometry_source=odometry_source(params),
    )


@register('libgazebo_ros_diff_drive.so')
class DiffDrive(Drive):
    """Drive two wheel joints from a planar velocity command; report odometry.

    Outputs, each a `Port`: `odometry` (`Odometry`), `wheel_transform` (`FrameTransform`, once per
    wheel) and `joint_states` (`JointStates`: right, left). `wheels` are the joints, left first.
    """

    prefix = 'DiffDrive(ns = {}/): '

    def read_config(self, params: Params) -> DiffDriveConfig:
        """Read all tags with upstream's defaults and in upstream's order."""
        return read_config(params)

    def find_joints(self) -> None:
        """Find the two wheels.

        Raises:
            PluginError: one of them is missing.
        """
        config = self.config
        self.wheel_transform, self.joint_states = Port(), Port()
        self.wheels = tuple(
            self.joint(name, 'wheel hinge') for name in (config.left_joint, config.right_joint)
        )
        self._encoders = Encoders(*self.wheels, config.wheel_diameter, config.wheel_separation)
        self._warn_geometry()
        self._warn_sides()

    @property
    def every_step(self) -> bool:
        """Tell whether encoders are to be read."""
        return self.config.odometry_source == ENCODER

    @property
    def sends_odometry(self) -> bool:
        """Tell whether odometry is published."""
        return self.config.publish_tf

    @property
    def sends_transform(self) -> bool:
        """Tell whether the odometry transform is published, too."""
        return self.config.publish_tf and self.config.publish_odom_tf

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
        self._encoders.reset(self.world.clock.now_ns)
        super().reset()

    def sample(self, now_ns: int) -> None:
        """Read the encoders."""
        self._encoders.advance(now_ns)

    def follow(self, elapsed: float) -> None:
        """Set the wheels' speeds."""
        config, (x, _, yaw_rate) = self.config, self.target
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

    def report(self) -> None:
        """Tell odometry, wheel transforms and joint states."""
        config = self.config
        odometry = self.sends_odometry and self.odometry.wanted()
        wheels = config.publish_wheel_tf and self.wheel_transform.wanted()
        if odometry or wheels:
            pose, twist = self.model.state()  # once: the engine takes its time to tell
        if odometry:
            encoder = config.odometry_source == ENCODER
            self.odometry.send(
                self._encoder_odometry() if encoder else world_odometry(pose, twist)
            )
        if wheels:
            for transform in wheel_transforms(self.model, self.wheels, pose):
                self.wheel_transform.send(transform)
        if config.publish_wheel_joint_state and self.joint_states.wanted():
            left, right = self.wheels
            self.joint_states.send(
                JointStates((right.name, left.name), (right.position, left.position))
            )

    def _encoder_odometry(self) -> Odometry:
        """Return what the encoders tell, by upstream's formula: the speed is never negative."""
        vx, vy, yaw_rate = self._encoders.rate
        speed = math.hypot(vx, vy)
        return Odometry(self._encoders.pose, Twist((speed, 0.0, 0.0), (0.0, 0.0, yaw_rate)))

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

