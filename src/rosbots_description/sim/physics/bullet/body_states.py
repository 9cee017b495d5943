"""Reads and sets the motion of bodies in a PyBullet world, their motors and applied forces.

Converts conventions: PyBullet's poses are of the centre of mass, ours of the link frame.
Quaternions are (x, y, z, w) in both.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

from ...core import MAX_COORDINATE, Pose, Twist, Vector, add, compose, cross, rotate, subtract
from ..engine import JointState, Motion, Wrench
from .body import Body, Part
from .body_maker import ANY_SPEED
from .client import pybullet
from .exact_poses import ExactPlacement
from .fast_rotation import FastBodies
from .integral_action import AT_REST, integral
from .sleep import Sleep

# Forces are clamped to this value. The squares of greater ones overflow to NaN, which spreads
# through contacts to other bodies, first of all to the ground.
_ANY_FORCE = 1e15  # [N or N m]

AppliedForce = tuple[Callable[..., None], tuple[Any, ...]]  # method, arguments


class BodyStates:
    """State of the bodies of one PyBullet world; see `PhysicsEngine`."""

    placements = advances = 0

    def __init__(self, client: int) -> None:
        """Work in the world of that PyBullet client."""
        self._client = client
        self._enabled = True
        self._fast = FastBodies(client)
        self._sleep = Sleep(client, self._make_void_step)
        self._driven: dict[Body, None] = {}  # bodies with motors, in the order they were added
        self._applied_forces: list[AppliedForce] = []  # since the last step
        # Joint states read since the last step, by PyBullet's body, in the order of Body.indices:
        # reading one joint costs as much as reading all joints of a body.
        self._joint_readings: dict[int, Sequence[tuple[Any, ...]]] = {}

    def motion(self, body: Body) -> Motion:
        """Return poses and twists of roots, joint states and motor commands of a model."""
        return Motion(
            {link: self.link_state(body, link) for link in body.roots},
            {name: state[:2] for name, state in self.joint_states(body).items()},
            dict(body.motors),
        )

    def set_motion(self, body: Body, motion: Motion) -> None:
        """Set the motion of a model to one recorded from a model of the same links and joints."""
        self._sleep.wake_all()
        self._joint_readings.clear()
        self.set_root_poses(body, {link: pose for link, (pose, _) in motion.roots.items()})
        for link, (_, twist) in motion.roots.items():
            self.set_root_twist(body, link, twist)
        for name, state in motion.joints.items():
            pybullet.resetJointState(*body.joints[name], *state, self._client)
            self.set_joint_motor(body, name, *motion.motors[name])

    def has_diverged(self, body: Body) -> bool:
        """Tell whether any coordinate or velocity of a model is not finite or out of range."""
        # Static models too: a hit at infinite speed gives them a velocity of NaN.
        most = MAX_COORDINATE
        return not all(-most < number < most for number in self._coordinates(body))

    def _coordinates(self, body: Body) -> Iterator[float]:
        """Yield all coordinates and velocities of the roots and joints of a model."""
        for number in body.bodies:
            for numbers in pybullet.getBasePositionAndOrientation(number, self._client):
                yield from numbers
            for numbers in pybullet.getBaseVelocity(number, self._client):
                yield from numbers
            indices = body.indices.get(number)
            if indices:
                for state in pybullet.getJointStates(number, indices, self._client):
                    yield from state[:2]

    def link_pose(self, body: Body, link: str) -> Pose:
        """Return the pose of the link's frame in the world."""
        part = body.parts[link]
        if part.index < 0:
            com = Pose(*pybullet.getBasePositionAndOrientation(part.body, self._client))
        else:
            com = Pose(*self._link_state(part, velocity=False)[:2])
        return compose(com, part.origin_in_com)

    def link_state(self, body: Body, link: str) -> tuple[Pose, Twist]:
        """Return the pose of the link's frame and the velocity of its origin, in world axes."""
        part = body.parts[link]
        if part.index < 0:
            com = Pose(*pybullet.getBasePositionAndOrientation(part.body, self._client))
            linear, angular = pybullet.getBaseVelocity(part.body, self._client)
        else:
            state = self._link_state(part, velocity=True)
            com, linear, angular = Pose(*state[:2]), state[6], state[7]
        return _state_of_frame(part, com, linear, angular)

    def link_states(self, body: Body) -> dict[str, tuple[Pose, Twist]]:
        """Return pose and twist of all links."""
        states = {}
        for number in {part.body: None for part in body.parts.values()}:
            mine = [(name, part) for name, part in body.parts.items() if part.body == number]
            indices = [part.index for _, part in mine if part.index >= 0]
            rows = iter(
                pybullet.getLinkStates(number, indices, 1, 1, self._client) if indices else ()
            )
            for name, part in mine:
                if part.index < 0:
                    states[name] = self.link_state(body, name)
                    continue
                row = next(rows)
                states[name] = _state_of_frame(part, Pose(*row[:2]), row[6], row[7])
        return states

    def _link_state(self, part: Part, velocity: bool) -> tuple[Any, ...]:
        state: tuple[Any, ...] = pybullet.getLinkState(
            part.body,
            part.index,
            computeLinkVelocity=velocity,
            computeForwardKinematics=1,
            physicsClientId=self._client,
        )
        return state

    def set_root_poses(self, body: Body, poses: Mapping[str, Pose]) -> None:
        """Set the poses of root link frames; joint positions do not change.

        Velocities are kept, which PyBullet would zero.
        """
        self.placements += 1
        self._sleep.wake_all()
        for link, pose in poses.items():
            part = body.parts[link]
            near = Pose(_at_most(pose.position, MAX_COORDINATE), pose.orientation)
            com = compose(near, part.com_in_origin)
            velocity = pybullet.getBaseVelocity(part.body, self._client)
            for number in (part.body, *part.also):
                pybullet.resetBasePositionAndOrientation(number, *com, self._client)
                pybullet.resetBaseVelocity(number, *velocity, physicsClientId=self._client)
            self._fast.allow_external_work(part.body)

    def settle_poses(self, body: Body) -> dict[str, Pose]:
        """Move roots by rounding errors so that `match_poses` restores all links; return axes."""
        self._sleep.wake_all()
        axes = {}
        for root in body.roots:
            placement = self._placement(body, root, body.parts)
            if root not in body.fixed_roots:
                placement.settle()
                self.placements += 1
            axes[root] = placement.axes
        return axes

    def match_poses(self, body: Body, axes: Mapping[str, Pose], links: Mapping[str, Pose]) -> None:
        """Move roots by rounding errors so that principal axes and links are these again."""
        self.placements += 1
        self._sleep.wake_all()
        for root in (root for root in body.roots if root in axes):
            mine = [pose for name, pose in links.items() if self._is_of(body, name, root)]
            self._placement(body, root, links).match(axes[root], mine)

    def _placement(self, body: Body, root: str, links: Iterable[str]) -> ExactPlacement:
        names = [name for name in links if self._is_of(body, name, root)]
        return ExactPlacement(
            self._client, body.parts[root], lambda: [self.link_pose(body, name) for name in names]
        )

    def _is_of(self, body: Body, link: str, root: str) -> bool:
        """Tell whether a link depends on a root."""
        return link in body.parts and body.parts[link].body == body.parts[root].body

    def set_root_twist(self, body: Body, link: str, twist: Twist) -> None:
        """Set the twist of a root link at its origin, in world axes; joint velocities are kept.

        A root that is fixed to the world stays at rest.
        """
        if link in body.fixed_roots:
            return
        part = body.parts[link]
        self._sleep.wake(part.body)
        com = rotate(self.link_pose(body, link).orientation, part.com_in_origin.position)
        angular = _at_most(twist.angular, ANY_SPEED)
        linear = add(_at_most(twist.linear, ANY_SPEED), cross(angular, com))
        pybullet.resetBaseVelocity(part.body, linear, angular, physicsClientId=self._client)
        self._fast.set_in_motion(part.body)

    def set_twist(self, body: Body, twist: Twist) -> None:
        """Set the twist of all roots at their origins, in world axes, and stop all joints."""
        self._joint_readings.clear()
        for link in body.roots:
            self.set_root_twist(body, link, twist)
        for number, index in body.joints.values():
            position = pybullet.getJointState(number, index, self._client)[0]
            pybullet.resetJointState(number, index, position, 0.0, self._client)

    def joint_state(self, body: Body, joint: str) -> JointState:
        """Return the state of a joint."""
        position, velocity, _, effort = self._joint_reading(body, joint)
        # PyBullet still reports the last effort of a motor that has been switched off.
        return JointState(position, velocity, effort if body.motors[joint][1] else 0.0)

    def joint_states(self, body: Body) -> dict[str, JointState]:
        """Return the states of all joints."""
        return {name: self.joint_state(body, name) for name in body.joints}

    def _joint_reading(self, body: Body, joint: str) -> tuple[Any, ...]:
        """Return PyBullet's state of a joint; one call reads all joints of a body."""
        number, row = body.rows[joint]
        readings = self._joint_readings.get(number)
        if readings is None:
            readings = pybullet.getJointStates(number, body.indices[number], self._client)
            self._joint_readings[number] = readings
        return readings[row]

    def set_joint_position(
        self, body: Body, joint: str, position: float, velocity: float = 0.0
    ) -> None:
        """Put a joint at `position` [rad or m], moving at `velocity` [rad/s or m/s]."""
        self.placements += 1
        self._sleep.wake_all()
        self._joint_readings.clear()
        number, index = body.joints[joint]
        pybullet.resetJointState(number, index, position, velocity, self._client)
        self._fast.allow_external_work(number)

    def motor(self, body: Body, joint: str) -> tuple[float, float]:
        """Return the motor's target velocity and effort limit."""
        return body.motors[joint]

    def set_joint_motor(self, body: Body, joint: str, velocity: float, effort: float) -> None:
        """Drive a joint towards `velocity` [rad/s or m/s] with at most `effort` [N m or N]."""
        if body.motors.get(joint) == (velocity, effort):
            return  # unchanged
        self._sleep.wake(body.joints[joint][0])
        velocity = max(-ANY_SPEED, min(ANY_SPEED, velocity))
        if velocity * body.motors.get(joint, (0.0, 0.0))[0] <= 0.0:
            body.integrals.pop(joint, None)  # the load turns with the direction
        body.motors[joint] = (velocity, effort)
        self._driven[body] = None
        self._apply_motor(body, joint)

    def _apply_motor(self, body: Body, joint: str) -> None:
        velocity, effort = body.motors[joint]
        pybullet.setJointMotorControl2(
            *body.joints[joint],
            pybullet.VELOCITY_CONTROL,
            targetVelocity=velocity + body.integrals.get(joint, AT_REST).offset,
            force=effort,
            physicsClientId=self._client,
        )

    def _correct_motors(self) -> None:
        """Look at all motors, and correct what they get by the integral of their errors."""
        for body in self._driven:
            for joint, (target, limit) in body.motors.items():
                if limit > 0.0:
                    _, velocity, _, effort = self._joint_reading(body, joint)
                    before = body.integrals.get(joint, AT_REST)
                    now = integral(before, target, velocity, effort / limit)
                    body.integrals[joint] = now
                    if now.offset != before.offset:
                        self._apply_motor(body, joint)

    def apply_wrench(
        self, body: Body, link: str, force: Vector, torque: Vector, place: Vector | None = None
    ) -> None:
        """Apply a force [N] and a torque [N m] to a link in the next step, added to others.

        Args:
            place: point of application [m], None for the centre of mass; all in world axes.
        """
        if not self._enabled:
            return  # PyBullet would accumulate them until its next step
        part = body.parts[link]
        self._sleep.wake(part.body)
        if place is None:
            place = compose(self.link_pose(body, link), part.com_in_origin).position
        world, client = pybullet.WORLD_FRAME, self._client
        force, torque = _at_most(force, _ANY_FORCE), _at_most(torque, _ANY_FORCE)
        pybullet.applyExternalForce(part.body, part.index, force, place, world, client)
        pybullet.applyExternalTorque(part.body, part.index, torque, world, client)
        self._applied_forces.append((self.apply_wrench, (body, link, force, torque, place)))
        self._fast.allow_external_work(part.body)

    def apply_joint_effort(self, body: Body, joint: str, effort: float) -> None:
        """Apply `effort` [N m or N] to a joint in the next step, added to its motor's."""
        if not self._enabled:
            return
        self._sleep.wake(body.joints[joint][0])
        effort = max(min(effort, _ANY_FORCE), -_ANY_FORCE)
        pybullet.setJointMotorControl2(
            *body.joints[joint], pybullet.TORQUE_CONTROL, force=effort, physicsClientId=self._client
        )
        self._applied_forces.append((self.apply_joint_effort, (body, joint, effort)))
        self._fast.allow_external_work(body.joints[joint][0])

    def _make_void_step(self) -> None:
        """Make a step of PyBullet that is undone, so that it wakes bodies before the next one."""
        for body in self._driven:
            for joint in body.joints:
                self._joint_reading(body, joint)  # PyBullet does not restore efforts
        state = pybullet.saveState(physicsClientId=self._client)
        pybullet.stepSimulation(self._client)
        pybullet.restoreState(stateId=state, physicsClientId=self._client)
        pybullet.removeState(state, physicsClientId=self._client)
        applied = [*self._applied_forces]
        self._applied_forces.clear()
        for call, arguments in applied:
            call(*arguments)

    def measure_reaction(self, body: Body, joint: str, wanted: bool = True) -> None:
        """Enable or disable the measurement of a joint's reaction."""
        self._sleep.wake_all()
        if wanted:
            self._sleep.measured.add(body.joints[joint])
        else:
            self._sleep.measured.discard(body.joints[joint])
        self._joint_readings.clear()
        pybullet.enableJointForceTorqueSensor(*body.joints[joint], int(wanted), self._client)

    def joint_reaction(self, body: Body, joint: str) -> Wrench:
        """Return the wrench of the parent on the child through a joint in the last step."""
        # PyBullet reports it in the principal axes of the child, without the motor's effort.
        values = self._joint_reading(body, joint)[2]
        turn = next(
            part.com_in_origin.orientation
            for part in body.parts.values()
            if (part.body, part.index) == body.joints[joint]
        )
        force, torque = rotate(turn, values[:3]), rotate(turn, values[3:])
        if not any(values):
            return Wrench(force, torque)
        axis, turns = body.joint_axes[joint]
        effort = self.joint_state(body, joint).effort
        driven = (effort * axis[0], effort * axis[1], effort * axis[2])
        return Wrench(force, add(torque, driven)) if turns else Wrench(add(force, driven), torque)


def _state_of_frame(part: Part, com: Pose, linear: Vector, angular: Vector) -> tuple[Pose, Twist]:
    """Return pose and twist of a link's frame, given those of its centre of mass."""
    pose = compose(com, part.origin_in_com)
    arm = subtract(pose.position, com.position)
    return pose, Twist(add(linear, cross(angular, arm)), angular)


def _at_most(vector: Vector, most: float) -> Vector:
    """Return a vector with its components clamped to [-most, most]."""
    x, y, z = (max(min(component, most), -most) for component in vector)  # NaN stays
    return (x, y, z)
