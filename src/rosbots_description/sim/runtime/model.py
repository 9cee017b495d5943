"""Models, links, joints and collisions in a world: read and move them by name."""

import math
from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any

from ..core import (
    IDENTITY,
    NotFoundError,
    Pose,
    Twist,
    Vector,
    add,
    compose,
    cross,
    inverse,
    rotate,
    subtract,
)
from ..description import Collision, JointSpec, LinkSpec, ModelSpec
from ..physics import CompiledModel, EngineBody, JointState, PhysicsEngine
from ..plugin_registry import library_name
from .model_part import ModelPart
from .outputs import JointStates
from .plugin import Plugin
from .sensor import SensorPart


class _Named:
    """Prints as its kind and scoped name."""

    scoped_name: str

    def __repr__(self) -> str:
        """Return its kind and name."""
        return f'<{type(self).__name__} {self.scoped_name}>'


class Link(_Named):
    """A rigid body of a model."""

    def __init__(self, model: 'Model', spec: LinkSpec) -> None:
        self.model = model
        self.spec = spec
        self.name = spec.name
        self.scoped_name = f'{model.name}::{spec.name}'
        # A link of a nested model is called `inner::link` here and `link` in its own model.
        self.names = {self.scoped_name, self.name, self.name.rpartition('::')[2]}
        self.collisions = {c.name: CollisionFrame(self, c) for c in spec.collisions}

    @property
    def pose(self) -> Pose:
        """Return the pose of the link's frame in the world."""
        return self.model.engine.link_pose(self.model.body, self.name)

    @property
    def twist(self) -> Twist:
        """Return the velocity of the link's origin, in world axes."""
        return self.state()[1]

    def state(self) -> tuple[Pose, Twist]:
        """Return pose and twist in one read, which is cheaper than two."""
        return self.model.engine.link_state(self.model.body, self.name)

    def state_at(self, offset: Pose) -> tuple[Pose, Twist]:
        """Return pose and twist of a frame that is fixed at `offset` in the link's."""
        pose, (linear, angular) = self.state()
        arm = rotate(pose.orientation, offset.position)
        return compose(pose, offset), Twist(add(linear, cross(angular, arm)), angular)

    def apply_wrench(self, force: Vector, torque: Vector) -> None:
        """Apply a force [N] at the centre of mass and a torque [N m] (world axes) for one step."""
        self.model.engine.apply_wrench(self.model.body, self.name, force, torque)

    @property
    def friction_scale(self) -> float:
        """Return the factor on the friction of each of the link's contacts."""
        return self.model.body.friction_scales.get(self.name, 1.0)

    def scale_friction(self, factor: float) -> None:
        """Multiply the friction of each of the link's contacts by a factor, from the next step on.

        The friction that is described is what is multiplied. `World.restore` undoes it.

        Raises:
            ValueError: the factor is negative or not finite.
        """
        if not 0.0 <= factor < math.inf:
            raise ValueError(
                f"the friction of link '{self.scoped_name}' is multiplied by a finite "
                f'number of at least 0; it got {factor}'
            )
        self.model.engine.scale_friction(self.model.body, self.name, factor)

    def can_slip(self, axis: Vector) -> bool:
        """Tell whether it can have a slip compliance along `axis`, a unit vector in its frame."""
        return self.model.engine.can_slip(self.model.body, self.name, axis)

    def set_slip_compliance(self, axis: Vector, compliances: tuple[float, float]) -> None:
        """Set the slip compliances along `axis` and across it [m/s per N]."""
        self.model.engine.set_slip_compliance(self.model.body, self.name, axis, compliances)


class CollisionFrame(_Named):
    """A collision of a link; it can serve as a reference frame."""

    def __init__(self, link: Link, spec: Collision) -> None:
        self.link = link
        self.spec = spec
        self.name = spec.name
        self.scoped_name = f'{link.scoped_name}::{spec.name}'
        self.names = {self.scoped_name, self.name, self.name.rpartition('::')[2]}

    @property
    def pose(self) -> Pose:
        """Return the pose of the shape in the world."""
        return compose(self.link.pose, self.spec.pose)

    def state(self) -> tuple[Pose, Twist]:
        """Return the pose, and the twist of the shape's link."""
        pose, twist = self.link.state()
        return compose(pose, self.spec.pose), twist


class Joint(_Named):
    """A movable joint between two links of a model."""

    def __init__(self, model: 'Model', spec: JointSpec) -> None:
        self.model = model
        self.spec = spec
        self.name = spec.name
        self.scoped_name = f'{model.name}::{spec.name}'

    @property
    def position(self) -> float:
        """Return the position [rad or m]."""
        return self._state().position

    @property
    def velocity(self) -> float:
        """Return the velocity [rad/s or m/s]."""
        return self._state().velocity

    def state(self) -> tuple[float, float]:
        """Return position and velocity in one read."""
        return self._state()[:2]

    @property
    def effort(self) -> float:
        """Return the motor's effort in the last step [N m or N]."""
        return self._state().effort

    @property
    def motor(self) -> tuple[float, float]:
        """Return the motor's target velocity [rad/s or m/s] and its greatest effort [N m or N]."""
        return self.model.engine.motor(self.model.body, self.name)

    def apply_effort(self, effort: float) -> None:
        """Apply `effort` [N m or N] for one step, added to the motor's.

        Each call is clamped to the joint's effort limit, as in Gazebo.
        """
        limit = self.spec.effort
        if limit is not None and limit >= 0.0:
            effort = max(-limit, min(limit, effort))
        self.model.engine.apply_joint_effort(self.model.body, self.name, effort)

    def set_motor(self, velocity: float, effort: float) -> None:
        """Drive towards `velocity` [rad/s or m/s] with at most `effort` [N m or N]."""
        self.model.engine.set_joint_motor(self.model.body, self.name, velocity, effort)

    def set_position(self, position: float, velocity: float = 0.0) -> None:
        """Set `position` [rad or m] and `velocity` [rad/s or m/s]."""
        self.model.engine.set_joint_position(self.model.body, self.name, position, velocity)

    def _state(self) -> JointState:
        return self.model.engine.joint_state(self.model.body, self.name)


class Model(_Named):
    """A model in the world. Its frame moves with its first link, the canonical one.

    `links`, `joints` (the movable ones), `plugins` and `sensors` are dicts by name, in the order of
    the description. Plugins are those that were loaded, also in sensors. Where several have the
    same name, the first has it as its key; the key of another begins with its link and sensor, or
    ends with a number. `left_out` lists the parts that were left out.
    """

    def __init__(
        self, name: str, compiled: CompiledModel, engine: PhysicsEngine, pose: Pose
    ) -> None:
        self.name = self.scoped_name = name
        self.parent_name = ''  # only nested models have one
        self._compiled = compiled
        self.spec = spec = compiled.spec
        self.static = spec.static
        self.engine = engine
        self.initial_pose = pose
        self.add_to_engine()
        self.links = {link.name: Link(self, link) for link in spec.links}
        self.joints = {
            joint.name: Joint(self, joint)
            for joint in spec.joints
            if joint.name in self.body.joints
        }
        self.plugins: dict[str, Plugin] = {}
        self.sensors: dict[str, SensorPart] = {}
        self.left_out = list(spec.left_out)  # parts that were left out, each in a few words
        self._canonical = spec.links[0].name
        self._model_in_canonical = inverse(spec.links[0].pose)

    @property
    def pose(self) -> Pose:
        """Return the pose of the model's frame in the world."""
        return self.frame(self.engine.link_pose(self.body, self._canonical))

    def frame(self, canonical: Pose) -> Pose:
        """Return the pose of the model's frame where its canonical link has that pose."""
        return compose(canonical, self._model_in_canonical)

    @property
    def twist(self) -> Twist:
        """Return the velocity of the canonical link's origin, in world axes."""
        return self.state()[1]

    def state(self) -> tuple[Pose, Twist]:
        """Return the pose of the model's frame and the twist of its canonical link."""
        pose, twist = self.engine.link_state(self.body, self._canonical)
        return self.frame(pose), twist

    def has_diverged(self) -> bool:
        """Tell whether a pose or velocity of the model is not finite, or beyond all limits."""
        return self.engine.has_diverged(self.body)

    def set_pose(self, pose: Pose) -> None:
        """Move the whole model; joint positions and velocities stay."""
        shift = compose(pose, inverse(self.pose))
        roots = self.body.roots
        self.engine.set_root_poses(
            self.body,
            {name: compose(shift, self.engine.link_pose(self.body, name)) for name in roots},
        )

    def set_twist(self, twist: Twist) -> None:
        """Set the velocity of every link, in world axes; joint velocities become zero."""
        self.engine.set_twist(self.body, twist)

    @property
    def mass_scale(self) -> float:
        """Return the factor on the model's masses and moments of inertia."""
        return self.body.mass_scale

    def scale_mass(self, factor: float) -> None:
        """Multiply all masses and moments of inertia of the model, from the next step on.

        Those that are described are what is multiplied. `World.restore` undoes it.

        Raises:
            ValueError: the factor is not a positive finite number.
        """
        if not 0.0 < factor < math.inf:
            raise ValueError(
                f"the mass of model '{self.name}' is multiplied by a positive finite "
                f'number; it got {factor}'
            )
        self.engine.scale_mass(self.body, factor)

    def move_link(self, link: Link, pose: Pose, twist: Twist) -> None:
        """Set a link's pose and velocity in the world.

        Joint positions stay. A root link takes its descendants along, and joint velocities stay;
        for any other link the whole model is moved, and joint velocities become zero.
        """
        if link.name in self.body.roots:
            self.engine.set_root_poses(self.body, {link.name: pose})
            self.engine.set_root_twist(self.body, link.name, twist)
            return
        shift = compose(pose, inverse(link.pose))
        self.set_pose(compose(shift, self.pose))
        arm = subtract(self.links[self._canonical].pose.position, pose.position)
        linear = add(twist.linear, cross(twist.angular, arm))
        self.set_twist(Twist(linear, twist.angular))

    def add_to_engine(self) -> None:
        """Add the model to the engine, which is new or was reset, at its spawn pose."""
        if not self._compiled.has_files:
            self._compiled = self.engine.compile(self.spec)
        old: EngineBody | None = getattr(self, 'body', None)
        self.body: EngineBody = self.engine.add(self._compiled, self.initial_pose)
        if old is not None:
            self._keep_scales(old)

    def remove_from_engine(self) -> None:
        """Remove the model from the engine for good, with its mesh files."""
        self.engine.remove(self.body)
        del self._compiled

    def respecify(self, spec: ModelSpec) -> None:
        """Replace the description by one with the same parts; the motion stays."""
        motion, old = self.engine.motion(self.body), self.body
        compiled = self.engine.compile(spec)
        self.body = self.engine.add(compiled, self.initial_pose)
        self._compiled = compiled
        self._keep_scales(old)
        self.engine.remove(old)
        self.engine.set_motion(self.body, motion)
        self.spec = spec
        for link in spec.links:
            self.links[link.name].spec = link
            for collision in link.collisions:
                self.links[link.name].collisions[collision.name].spec = collision
        for joint in spec.joints:
            if joint.name in self.joints:
                self.joints[joint.name].spec = joint

    def change_links(self, change: Callable[[LinkSpec], LinkSpec]) -> None:
        """Replace the description of each link by what `change` returns; the motion stays."""
        self.respecify(replace(self.spec, links=tuple(map(change, self.spec.links))))

    def _keep_scales(self, old: EngineBody) -> None:
        """Scale the body as the one that it replaces."""
        self.engine.scale_mass(self.body, old.mass_scale)
        for link, factor in old.friction_scales.items():
            self.engine.scale_friction(self.body, link, factor)

    @property
    def joint_states(self) -> JointStates:
        """Return positions, velocities and efforts of all movable joints, as described."""
        joints = self.joints.values()
        return JointStates(
            tuple(self.joints),
            tuple(joint.position for joint in joints),
            tuple(joint.velocity for joint in joints),
            tuple(joint.effort for joint in joints),
        )

    def link(self, name: str) -> Link:
        """Return the link of that plain or scoped name.

        Raises:
            NotFoundError: the model has no such link; fixed joint reduction may have merged it.
        """
        link = self.links.get(name.removeprefix(f'{self.name}::'))
        if link is None:
            raise self._not_found('link', name, self.links)
        return link

    def locate(self, name: str) -> tuple[Link, Pose]:
        """Return the link of that name, or its parent after reduction, and its pose in that.

        Raises:
            NotFoundError: the description has no such link, or it has no mass.
        """
        parent, pose = self.spec.reduced.get(name.removeprefix(f'{self.name}::'), (name, IDENTITY))
        return self.link(parent), pose

    def plugin(self, name: str) -> Any:  # noqa: ANN401  each class has commands of its own
        """Return the plugin of that name, or the first one from that library.

        Args:
            name: e.g. 'differential_drive_controller', the name in <plugin>; or its library in
                full, 'libgazebo_ros_diff_drive.so', or for short, 'diff_drive'.
        Raises:
            NotFoundError: the model has no such plugin, or it was left out as it was loaded.
        """
        libraries = (library_name(name), library_name(f'gazebo_ros_{name}'))
        if name in self.plugins:
            return self.plugins[name]
        for plugin in self.plugins.values():
            if library_name(plugin.spec.filename) in libraries:
                return plugin
        known = (f"'{key}' ({one.spec.filename})" for key, one in self.plugins.items())
        raise self._not_found('plugin', name, known)

    def controller(self, name: str) -> Any:  # noqa: ANN401  each class has commands of its own
        """Return the controller of that name, as the plugin gazebo_ros_control has loaded it.

        Raises:
            NotFoundError: no such controller is loaded.
        """
        loaded = {
            own: one for plugin in self.plugins.values() for own, one in plugin.controllers.items()
        }
        if name not in loaded:
            raise self._not_found('controller', name, loaded)
        return loaded[name]

    @property
    def parts(self) -> list[ModelPart]:
        """Return plugins and sensors, as they were loaded."""
        return [*self.plugins.values(), *self.sensors.values()]

    def sensor(self, name: str) -> Any:  # noqa: ANN401  each type has its own attributes
        """Return the sensor of that name, or `LINK::NAME`; the first, if there are several.

        Raises:
            NotFoundError: the model has no such sensor, or it was left out as it was loaded.
        """
        if name in self.sensors:
            return self.sensors[name]
        inner = {
            one.scoped_name.removeprefix(f'{self.name}::'): one
            for one in reversed(self.sensors.values())
        }
        if name in inner:
            return inner[name]
        raise self._not_found('sensor', name, reversed(inner))

    def joint(self, name: str) -> Joint:
        """Return the joint of that plain or scoped name.

        Raises:
            NotFoundError: the model has no such movable joint.
        """
        joint = self.joints.get(name.removeprefix(f'{self.name}::'))
        if joint is None:
            raise self._not_found('joint', name, self.joints)
        return joint

    def _not_found(self, kind: str, name: str, known: Iterable[str]) -> NotFoundError:
        names = ', '.join(known) or 'none'
        return NotFoundError(f"model '{self.name}' has no {kind} '{name}'; its {kind}s: {names}")
