"""Edits of the models of a world: insert, delete, move, push."""

import math
import time

from ..sim import Pose, SimError, World
from ..sim.core import Vector, compose, rotate
from ..sim.description import LightSpec, ModelText
from ..sim.formats import copy_of_model, load_sdf_light
from ..sim.physics import CrashSandbox
from ..sim.placement import box_around, free_name, placed
from ..sim.resources import own_name, root_tag
from .commands import WorldCommands

PATIENCE = 60.0  # [s, wall] for large meshes
_BLANK = '\ufeff \t\r\n'
_SDF = 'sdf', 'gazebo'


class WorldEditor:
    """Edits models; each method raises SimError with a sentence if it is refused."""

    def __init__(self, world: World, commands: WorldCommands, sandbox: CrashSandbox | None) -> None:
        self._world, self._commands, self._sandbox = world, commands, sandbox

    def insert(self, text: ModelText, on_ground: bool = False, beside: bool = False) -> str:
        """Spawn a model or light under a name that is free; return the name."""
        if not text.xml.lstrip(_BLANK).startswith('<'):  # a path would be read as a file
            raise SimError('this is no URDF or SDF, which is XML and begins with <')
        name = text.name or own_name(text.xml, 'the file')
        light = load_sdf_light(text.xml, name) if root_tag(text.xml) in _SDF else None
        if light is not None:
            return self._commands.call(lambda: self._add_light(light))
        spec, own = self._world.read_model(text.xml, name)
        compiled, pose = self._world.compile(spec), compose(text.pose, own)
        box = box_around(spec, pose)
        if self._sandbox is not None:
            self._sandbox.require(compiled, self._world.physics)

        def add() -> str:
            place = pose if box is None else placed(self._world, pose, box, on_ground, beside)
            model = self._world.spawn(compiled, free_name(self._world, name), place)
            for joint, position in text.joints.items():
                model.joint(joint).set_position(position)
            return model.name

        return self._commands.call(add, PATIENCE)

    def delete(self, name: str) -> None:
        """Delete a model, else the light of that name."""

        def delete() -> None:
            if name not in self._world.models and name in self._world.lights:
                del self._world.lights[name]
            else:
                self._world.delete(name)

        self._commands.call(delete)

    def describe(self, name: str) -> ModelText:
        """Return what is needed to spawn a model again as it is."""

        def describe() -> ModelText:
            model = self._world.model(name)
            return ModelText(
                name,
                copy_of_model(model.spec),
                pose=model.pose,
                joints={joint.name: joint.position for joint in model.joints.values()},
            )

        return self._commands.call(describe)

    def move(self, name: str, pose: Pose) -> None:
        """Move a model, at rest, so that its frame is at a pose in the world."""
        self.hold(name, pose, 0.0)

    def hold(self, name: str, pose: Pose, duration: float) -> None:
        """Hold a model at rest at a pose for a time [s, wall]; zero: let it go there."""
        end = time.monotonic() + duration

        def hold() -> None:
            model = self._world.model(name)
            self._world.holds.hold(model, pose, lambda: time.monotonic() < end)
            if not duration:
                self._world.holds.release(model)

        self._commands.call(hold)

    def push(
        self, link: str, force: Vector, torque: Vector, duration: float, own_axes: bool
    ) -> None:
        """Apply a force [N] at the centre of mass of a link, and a torque [N m]."""
        if not 0.0 <= duration < math.inf:  # neither for NaN
            raise SimError(f'a push lasts at least 0 s, not {duration:g} s')

        def push() -> None:
            model, _, name = link.partition('::')
            found = self._world.model(model).link(name)
            turn = found.pose.orientation
            self._world.apply_wrench(
                found,
                rotate(turn, force) if own_axes else force,
                rotate(turn, torque) if own_axes else torque,
                seconds=duration,
            )

        self._commands.call(push)

    def _add_light(self, light: LightSpec) -> str:
        name = free_name(self._world, light.name)
        self._world.lights[name] = light
        return name
