"""The joints of a world, and the controllers that take commands for them."""

from collections.abc import Sequence
from functools import partial

from ..sim import Joint, World
from ..sim.controllers import (
    Controller,
    JointCommandController,
    JointGroupCommandController,
    JointGroupPositionController,
    JointPositionController,
    JointTrajectoryController,
    JointVelocityController,
)
from ..sim.description import CommandTopic
from .commands import WorldCommands

_OF_ONE = JointCommandController, JointPositionController, JointVelocityController
_OF_SEVERAL = (JointGroupCommandController, JointGroupPositionController, JointTrajectoryController)
POSITIONS = 'Position', 'Trajectory'  # in the types of controllers whose commands are positions


class WorldJoints:
    """Commands to joints; each raises SimError with a sentence if it is refused."""

    def __init__(self, world: World, commands: WorldCommands) -> None:
        self._world, self._commands = world, commands

    def position(self, model: str, joint: str) -> float:
        """Return a position [rad or m]."""
        return self._commands.call(lambda: self._joint(model, joint).position)

    def set_position(self, model: str, joint: str, position: float) -> None:
        """Move a joint there [rad or m] at once, whatever it meets."""
        self._commands.call(lambda: self._joint(model, joint).set_position(position))

    def set_velocity(self, model: str, joint: str, velocity: float, effort: float) -> None:
        """Let a motor keep a velocity [rad/s or m/s] with at most an effort [N m or N]."""
        self._commands.call(lambda: self._joint(model, joint).set_motor(velocity, effort))

    def set_effort(self, model: str, joint: str, effort: float) -> None:
        """Apply an effort [N m or N] from now on, in place of the last one."""

        def apply() -> None:
            found = self._joint(model, joint)
            self._world.clear_forces(found)
            if effort:
                self._world.apply_effort(found, effort)

        self._commands.call(apply)

    def command_topics(self) -> list[CommandTopic]:
        """Return what controllers take: a value for each of their joints."""
        return [topic for topic, _ in self._controllers()]

    def command(self, topic: CommandTopic, values: Sequence[float]) -> None:
        """Give a controller a value for each joint; a trajectory takes one second."""
        for offered, controller in self._controllers():
            if offered == topic:
                given = values[0] if isinstance(controller, _OF_ONE) else values
                self._commands.call(partial(controller.command, given))  # type: ignore[attr-defined]  # each kind has it

    def _joint(self, model: str, joint: str) -> Joint:
        return self._world.model(model).joint(joint)

    def _controllers(self) -> list[tuple[CommandTopic, Controller]]:
        found: list[tuple[CommandTopic, Controller]] = []
        for model in tuple(self._world.models.values()):
            for plugin in tuple(model.plugins.values()):
                for name, one in tuple(plugin.controllers.items()):
                    if isinstance(one, (*_OF_ONE, *_OF_SEVERAL)):
                        found.append((_topic(f'{model.name}/{name}', one), one))
        return found


def _topic(name: str, controller: Controller) -> CommandTopic:
    if isinstance(controller, _OF_ONE):
        return CommandTopic(name)
    joints = tuple(joint.name for joint in controller.joints)  # type: ignore[attr-defined]  # each kind has it
    return CommandTopic(name, joints, any(word in type(controller).__name__ for word in POSITIONS))
