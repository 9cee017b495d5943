"""The task GoToGoal in MuJoCo: the same room, robot, scan, step size and rewards.

The model is made from the specifications of our own world, so that masses, inertias, wheels, shapes
and joints are the same. MuJoCo combines the friction of a pair by its maximum, we by its minimum:
static shapes have no friction there, so that each pair has that of what moves. Wheels are driven by
velocity actuators of the drive's torque; meshes collide as their convex hulls in both. An inertia
that no rigid body can have, such as that of the article's robot, is replaced by its mean.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any
from xml.sax.saxutils import quoteattr

import mujoco
import numpy as np
from numpy.typing import NDArray

from rosbots_description.gym.tasks.driving import BUMPED
from rosbots_description.gym.tasks.go_to_goal import REACHED, GoToGoal
from rosbots_description.sim import Model, Pose
from rosbots_description.sim.core import compose, inverse, yaw_of
from rosbots_description.sim.description import (
    Box,
    Collision,
    Cylinder,
    LinkSpec,
    Mesh,
    Plane,
    Sphere,
)
from rosbots_description.sim.meshes import read_mesh

MOST_FRICTION = 100.0
GAIN = 20.0  # [N m s/rad] of the wheels' velocity actuators
START, GOAL, LEAST_WAY = ((-2.0, 2.0), (-1.0, 1.0)), ((-2.2, 2.2), (-1.3, 1.3)), 1.0  # [m]
LIMIT = 400  # control steps of an episode
LIMITS = 0.8, 0.8  # greatest command [m/s, rad/s]


def _numbers(*values: float) -> str:
    return quoteattr(' '.join(f'{value:.9g}' for value in values))


def _placed(pose: Pose) -> str:
    x, y, z, w = pose.orientation
    return f'pos={_numbers(*pose.position)} quat={_numbers(w, x, y, z)}'


class _Writer:
    """Writes models as MJCF."""

    def __init__(self) -> None:
        self.meshes: dict[Mesh, str] = {}
        self.actuators: list[str] = []

    def geom(self, shape: Collision, name: str, static: bool) -> str:
        """Return a collision as a geom."""
        match shape.geometry:
            case Box(size):
                form = f'type="box" size={_numbers(*(edge / 2.0 for edge in size))}'
            case Sphere(radius):
                form = f'type="sphere" size={_numbers(radius)}'
            case Cylinder(radius, length):
                form = f'type="cylinder" size={_numbers(radius, length / 2.0)}'
            case Plane():
                form = 'type="plane" size="50 50 1"'
            case Mesh() as mesh:
                form = f'type="mesh" mesh={quoteattr(self.mesh(mesh))}'
        friction = 0.0 if static else min(shape.surface.greatest_mu, MOST_FRICTION)
        return (
            f'<geom name={quoteattr(name)} {form} {_placed(shape.pose)} '
            f'friction={_numbers(friction, 0.0, 0.0)} condim="3"/>'
        )

    def mesh(self, mesh: Mesh) -> str:
        """Return the name of a mesh."""
        return self.meshes.setdefault(mesh, f'mesh{len(self.meshes)}')

    def assets(self) -> Iterator[str]:
        """Yield the meshes, by their vertices."""
        for mesh, name in self.meshes.items():
            vertices, _ = read_mesh(mesh.path).triangles()
            corners = np.unique(np.asarray(vertices) * mesh.scale, axis=0)
            yield f'<mesh name="{name}" inertia="shell" vertex={_numbers(*corners.ravel())}/>'

    def body(self, model: Model, link: LinkSpec, world_pose: Pose, joints: str, inner: str) -> str:
        """Return a link as a body; `joints` and `inner` are what else is in it."""
        geoms = ''.join(
            self.geom(one, f'{model.name}/{link.name}/{one.name}', model.static)
            for one in link.collisions
        )
        mass = ''
        if not model.static:
            own = link.mass_properties
            mass = (
                f'<inertial mass={_numbers(own.mass)} pos={_numbers(*own.pose.position)} '
                f'fullinertia={_numbers(own.ixx, own.iyy, own.izz, own.ixy, own.ixz, own.iyz)}'
                '/>'
            )
        return (
            f'<body name={quoteattr(f"{model.name}/{link.name}")} {_placed(world_pose)}>'
            f'{joints}{mass}{geoms}{inner}</body>'
        )

    def model(self, model: Model, torque: float) -> str:
        """Return a model whose joints, if any, are wheels below its first link."""
        root, *others = model.spec.links
        if not model.static and root.mass_properties.pose.orientation != (0.0, 0.0, 0.0, 1.0):
            raise ValueError(f'{root.name}: a turned inertia is not written')
        free = '' if model.static else f'<freejoint name={quoteattr(model.name)}/>'
        inner = ''
        for link in others:
            (joint,) = (one for one in model.spec.joints if one.child == link.name)
            hinge = (
                f'<joint name={quoteattr(joint.name)} type="hinge" '
                f'axis={_numbers(*joint.axis_in_child)} '
                f'pos={_numbers(*joint.pose.position)}/>'
            )
            self.actuators.append(
                f'<velocity joint={quoteattr(joint.name)} kv="{GAIN}" '
                f'forcerange="{-torque} {torque}"/>'
            )
            inner += self.body(model, link, compose(inverse(root.pose), link.pose), hinge, '')
        return self.body(model, root, model.links[root.name].pose, free, inner)


def mjcf(task: GoToGoal) -> str:
    """Return the world of a task as MuJoCo reads it."""
    writer, drive = _Writer(), task.robot.plugin('diff_drive')
    bodies = ''.join(writer.model(one, drive.wheel_torque) for one in task.world.models.values())
    gravity, step = task.world.physics.gravity, task.world.physics.step_size
    return (
        f'<mujoco><compiler angle="radian" balanceinertia="true"/><option timestep="{step}" '
        f'gravity={_numbers(*gravity)} integrator="implicitfast"/>'
        f'<asset>{"".join(writer.assets())}</asset><worldbody>{bodies}</worldbody>'
        f'<actuator>{"".join(writer.actuators)}</actuator></mujoco>'
    )


class MujocoGoToGoal:
    """GoToGoal with MuJoCo below it; `step` and `reset` return what Gymnasium's do."""

    def __init__(self) -> None:
        """Load the room and the robot at rest."""
        task = GoToGoal()
        try:
            task.reset(seed=0)
            self.model = mujoco.MjModel.from_xml_string(mjcf(task))
            drive, sensor = task.robot.plugin('diff_drive'), task.robot.sensor('laser')
            self._radius, self._half = drive.wheel_diameter / 2.0, drive.wheel_separation / 2.0
            wheels = [wheel.name for wheel in drive.wheels]
            self._limits = np.array(LIMITS)
            self._sensor = sensor.spec.pose
            self._ways = np.ascontiguousarray(sensor.fan.ways.T)
            self._range = sensor.range_max
            self._steps = round(0.1 / task.world.physics.step_size)
            base = sensor.link.name
        finally:
            task.close()
        self.data = mujoco.MjData(self.model)
        number = mujoco.mj_name2id
        kinds = mujoco.mjtObj
        self._motors = [
            next(
                k
                for k in range(self.model.nu)
                if self.model.actuator_trnid[k, 0] == number(self.model, kinds.mjOBJ_JOINT, name)
            )
            for name in wheels
        ]
        self._base = number(self.model, kinds.mjOBJ_BODY, f'rosbots/{base}')
        free = number(self.model, kinds.mjOBJ_JOINT, 'rosbots')
        self._place, self._speed = self.model.jnt_qposadr[free], self.model.jnt_dofadr[free]
        of_body = self.model.body_rootid[self.model.geom_bodyid]
        self._is_robot = of_body == self.model.body_rootid[self._base]
        self._is_ground = self.model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE
        self._found = np.empty(len(self._ways), np.int32), np.empty(len(self._ways))
        mujoco.mj_step(self.model, self.data, 1000)
        self._rest = self.data.qpos.copy(), self.data.qvel.copy()
        self._random = np.random.default_rng()

    def reset(self, seed: int) -> tuple[dict[str, Any], dict[str, Any]]:
        """Start an episode."""
        self._random = np.random.default_rng(seed)
        mujoco.mj_resetData(self.model, self.data)
        self.data.qpos[:], self.data.qvel[:] = self._rest
        while True:
            goal, start = self._place_freely(*GOAL), self._place_freely(*START)
            if math.dist(goal, start) > LEAST_WAY:
                break
        self._goal, self._left, self._count = goal, math.dist(start, goal), 0
        return self._observe(), {}

    def step(
        self,
        action: NDArray[np.float32],
    ) -> tuple[dict[str, Any], float, bool, bool, dict[str, Any]]:
        """Drive for a control period."""
        linear, angular = np.clip(np.asarray(action, float), -1.0, 1.0) * self._limits
        left, right = self._motors
        self.data.ctrl[left] = (linear - angular * self._half) / self._radius
        self.data.ctrl[right] = (linear + angular * self._half) / self._radius
        self.advance()
        self._count += 1
        seen = self._observe()
        before, self._left = self._left, float(seen['goal'][0])
        if self.bumps():
            return seen, BUMPED, True, False, {}
        is_there = self._left < REACHED
        return (
            seen,
            before - self._left + is_there,
            is_there,
            self._count >= LIMIT,
            {'is_success': is_there},
        )

    def advance(self) -> None:
        """Make the steps of a control period."""
        mujoco.mj_step(self.model, self.data, self._steps)

    def bumps(self) -> bool:
        """Tell whether the robot touches anything but the ground."""
        pairs = self.data.contact.geom
        robot = self._is_robot[pairs]
        others = ~(robot | self._is_ground[pairs])
        return bool((robot.any(axis=1) & others.any(axis=1)).any())

    @property
    def pose(self) -> tuple[float, float, float]:
        """Return the robot's x, y [m] and yaw [rad]."""
        x, y, _, w, i, j, k = self.data.qpos[self._place : self._place + 7].tolist()
        return x, y, yaw_of((i, j, k, w))

    def _place_freely(
        self, xs: tuple[float, float], ys: tuple[float, float]
    ) -> tuple[float, float]:
        place = self._place
        while True:
            x, y = self._random.uniform(*xs), self._random.uniform(*ys)
            yaw = self._random.uniform(-math.pi, math.pi)
            self.data.qpos[place : place + 2] = x, y
            self.data.qpos[place + 3 : place + 7] = (
                math.cos(yaw / 2.0),
                0.0,
                0.0,
                math.sin(yaw / 2.0),
            )
            mujoco.mj_forward(self.model, self.data)
            if not self.bumps():
                return x, y

    def _observe(self) -> dict[str, Any]:
        x, y, yaw = self.pose
        vx, vy = self.data.qvel[self._speed : self._speed + 2].tolist()
        cos, sin = math.cos(yaw), math.sin(yaw)
        bearing = math.atan2(self._goal[1] - y, self._goal[0] - x) - yaw
        return {
            'laser': self.scan(),
            'odometry': np.array(
                (
                    x,
                    y,
                    yaw,
                    cos * vx + sin * vy,
                    cos * vy - sin * vx,
                    self.data.qvel[self._speed + 5],
                ),
                np.float32,
            ),
            'goal': np.array(
                (math.dist((x, y), self._goal), math.cos(bearing), math.sin(bearing)), np.float32
            ),
        }

    def scan(self) -> NDArray[np.float32]:
        """Return the ranges of the scan [m], the greatest without a hit."""
        turn = self.data.xmat[self._base].reshape(3, 3)
        origin = self.data.xpos[self._base] + turn @ self._sensor.position
        hit, ranges = self._found
        ways = self._ways @ turn.T
        mujoco.mj_multiRay(
            self.model,
            self.data,
            origin,
            ways.ravel(),
            None,
            True,
            -1,
            hit,
            ranges,
            None,
            len(hit),
            self._range,
        )
        return np.where(ranges < 0.0, self._range, ranges).astype(np.float32)
