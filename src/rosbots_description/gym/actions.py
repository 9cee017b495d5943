"""What a robot is told in each control step: commands of plugins and controllers, and efforts."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from ..sim import Joint, Model, NotFoundError, SimError, World
from ..sim.controllers import (
    Controller,
    DriveController,
    GripperActionController,
    JointCommandController,
    JointGroupCommandController,
    JointGroupPositionController,
    JointPositionController,
    JointVelocityController,
    MecanumDriveController,
)
from ..sim.plugins import Drive, Force, ForceBasedMove, PlanarMove
from ..sim.runtime import Plugin

Action: TypeAlias = Any  # an element of the action space
Floats = NDArray[np.float32]
Limits = Mapping[str, float | Sequence[float]]


class Command(NamedTuple):
    """A command of `size` numbers, in the unit and order of `give`."""

    name: str
    size: int
    give: Callable[[Sequence[float]], None]


def _of_plugin(plugin: Plugin) -> Command | None:
    name = plugin.spec.name
    if isinstance(plugin, PlanarMove | ForceBasedMove):
        return Command(name, 3, lambda numbers: plugin.command(numbers[0], numbers[2], numbers[1]))
    if isinstance(plugin, Drive):
        return Command(name, 2, lambda numbers: plugin.command(numbers[0], numbers[1]))
    if isinstance(plugin, Force):
        return Command(
            name,
            6,
            lambda numbers: plugin.command(
                (numbers[0], numbers[1], numbers[2]), (numbers[3], numbers[4], numbers[5])
            ),
        )
    return None


def _of_controller(controller: Controller) -> Command | None:
    name = controller.name
    match controller:
        case MecanumDriveController():
            return Command(
                name, 3, lambda numbers: controller.command(numbers[0], numbers[2], numbers[1])
            )
        case DriveController():
            return Command(name, 2, lambda numbers: controller.command(*numbers))
        case JointGroupCommandController() | JointGroupPositionController():
            return Command(name, len(controller.joints), controller.command)
        case (
            JointCommandController()
            | JointPositionController()
            | JointVelocityController()
            | GripperActionController()
        ):
            return Command(name, 1, lambda numbers: controller.command(numbers[0]))
    return None


def _effort(world: World, joint: Joint) -> Command:
    def give(numbers: Sequence[float]) -> None:
        world.clear_forces(joint)
        world.apply_effort(joint, numbers[0])

    return Command(joint.name, 1, give)


def _commands(world: World, robot: Model, names: Sequence[str] | None) -> Iterator[Command]:
    plugins = robot.plugins.values()
    loaded = (one for plugin in plugins for one in plugin.controllers.values())
    of_plugins = {
        one.name: one for one in (*map(_of_plugin, plugins), *map(_of_controller, loaded)) if one
    }
    if names is None:
        yield from of_plugins.values()
        return
    for name in names:
        if name in of_plugins:
            yield of_plugins[name]
        elif name in robot.joints:
            yield _effort(world, robot.joints[name])
        else:
            raise NotFoundError(
                f"model '{robot.name}' takes no action '{name}'; its plugins and controllers with "
                f'commands: {", ".join(of_plugins) or "none"}; its joints: '
                f'{", ".join(robot.joints) or "none"}'
            )


class Actions:
    """The commands of a robot as one space: a Box, or a Dict of them if there are several.

    All numbers are from -1 to 1, shares of the limits.
    """

    def __init__(self, world: World, robot: Model, limits: Limits | None) -> None:
        """Find the commands.

        Args:
            limits: the greatest numbers of each command, by the name of its plugin, controller or
                joint; a single number holds for all of them. None: those of all plugins and
                controllers, with limits 1.
        Raises:
            NotFoundError: no plugin, controller or joint has such a name; the message lists those
                that exist.
            SimError: there is no command at all.
            ValueError: the limits of a command are not positive numbers, one for each of its own.
        """
        self._commands = [
            (one, _scale(one, 1.0 if limits is None else limits[one.name]))
            for one in _commands(world, robot, None if limits is None else [*limits])
        ]
        if not self._commands:
            raise SimError(
                f"model '{robot.name}' has no plugin that takes commands; name joints "
                'in `actions`, whose efforts are to be set'
            )
        boxes: dict[str, spaces.Space[Any]] = {
            one.name: spaces.Box(-1.0, 1.0, (one.size,), np.float32) for one, _ in self._commands
        }
        self._is_single = len(boxes) == 1
        self.space: spaces.Space[Any] = (
            next(iter(boxes.values())) if self._is_single else spaces.Dict(boxes)
        )

    def give(self, action: Action) -> None:
        """Give the commands of an action; numbers beyond -1 and 1 count as these.

        Raises:
            ValueError: its shape is not that of the space, or a number is not finite.
        """
        if not self._is_single and not isinstance(action, Mapping):
            raise ValueError(f'an action is a dict of {self._listed()}; it got {action!r}')
        for command, scale in self._commands:
            if self._is_single:
                part = action
            elif command.name in action:
                part = action[command.name]
            else:
                raise ValueError(
                    f"the action has no '{command.name}'; it is a dict of {self._listed()}"
                )
            command.give(_checked(part, command, scale))

    def _listed(self) -> str:
        return ', '.join(command.name for command, _ in self._commands)


def _checked(action: Action, command: Command, scale: list[float]) -> list[float]:
    """Return the numbers of a command in its own units."""
    try:
        numbers = np.asarray(action, float)
    except (TypeError, ValueError):
        numbers = np.empty(0)
    if numbers.shape != (command.size,):
        raise ValueError(
            f"the action of '{command.name}' takes {command.size} numbers from -1 to "
            f'1; it got {action!r}'
        )
    found = numbers.tolist()
    for number in found:
        if not -np.inf < number < np.inf:
            raise ValueError(f"the action of '{command.name}' takes finite numbers; it got {found}")
    return [max(-1.0, min(1.0, number)) * most for number, most in zip(found, scale, strict=True)]


def _scale(command: Command, limits: float | Sequence[float]) -> list[float]:
    numbers = [float(one) for one in np.ravel(np.asarray(limits, float))]
    if len(numbers) == 1:
        numbers *= command.size
    if len(numbers) != command.size or not all(0.0 < one < np.inf for one in numbers):
        raise ValueError(
            f"the limits of the action '{command.name}' are {limits}; they must be "
            f'{command.size} positive numbers, or one for all'
        )
    return numbers
