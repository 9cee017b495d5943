"""What differs between episodes: drawn by the seed, undone by the next reset."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, NoReturn, SupportsFloat

import numpy as np

from ..sim import Model, SimError, World, yaw_of
from ..sim.sensors import Sensor
from .placement import Range, move_freely

Colour = tuple[float, float, float, float]

_FACTORS = 'mass', 'friction', 'light', 'noise'
_MAX_FACTOR, _MAX_SHIFT = 1e6, 1e6  # [m or rad]; numbers beyond these are mistakes


@dataclass(frozen=True)
class Randomisation:
    """Ranges (least, greatest) of factors, and greatest shifts; each is drawn uniformly.

    Attributes:
        mass: factor, at most 1e6 like the others, on the robot's masses and moments of inertia.
        friction: factor on the friction of all contacts of the robot.
        light: factor on the brightness of all lights.
        noise: factor on the deviation of the <noise> of the robot's sensors.
        pose: greatest shift of the robot along x and y [m] and of its yaw [rad]; at most 1e6.
        obstacles: greatest shift of models along x and y [m], by name; their yaw is any.
    """

    mass: Range | None = None
    friction: Range | None = None
    light: Range | None = None
    noise: Range | None = None
    pose: tuple[float, float, float] = (0.0, 0.0, 0.0)
    obstacles: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name in _FACTORS:
            limits = getattr(self, name)
            if limits is not None and not (
                len(found := _numbers(limits)) == 2 and 0.0 < found[0] <= found[1] <= _MAX_FACTOR
            ):
                self._refuse(
                    name,
                    'it is a range of factors, the least and the greatest, both '
                    f'above 0 and at most {_MAX_FACTOR:g}',
                )
        if not (len(shifts := _numbers(self.pose)) == 3 and _are_shifts(shifts)):
            self._refuse('pose', f'it is three shifts, numbers from 0 to {_MAX_SHIFT:g}')
        if not isinstance(self.obstacles, Mapping) or not all(
            _are_shifts(_numbers([shift])) for shift in self.obstacles.values()
        ):
            self._refuse(
                'obstacles',
                f'it is a dict of shifts by names of models, numbers from 0 to {_MAX_SHIFT:g}',
            )

    def _refuse(self, name: str, right: str) -> NoReturn:
        raise ValueError(f'randomisation of {name} is {getattr(self, name)!r}; {right}')

    def require(self, world: World, robot: Model) -> None:
        """Raise a `SimError` if the world or the robot lacks what is to differ."""
        for name in self.obstacles:
            world.model(name)
        if self.noise and not _noisy(robot):
            raise SimError(
                f"no sensor of model '{robot.name}' has noise that could be multiplied; "
                'give one a <noise>'
            )

    def apply(self, world: World, robot: Model, random: np.random.Generator) -> dict[str, Any]:
        """Change the world, which has just been restored; return what was drawn, by name."""
        world.seed = int(random.integers(1 << 63))
        drawn: dict[str, Any] = {
            name: random.uniform(*limits)
            for name in _FACTORS
            if (limits := getattr(self, name)) is not None
        }
        if 'mass' in drawn:
            robot.scale_mass(drawn['mass'])
        if 'friction' in drawn:
            for link in robot.links.values():
                link.scale_friction(drawn['friction'])
        if 'noise' in drawn:
            for sensor in _noisy(robot):
                sensor.noise_scale = drawn['noise']
        if 'light' in drawn:
            world.lights.update(
                {
                    name: replace(
                        light,
                        diffuse=_brighter(light.diffuse, drawn['light']),
                        specular=_brighter(light.specular, drawn['light']),
                    )
                    for name, light in world.lights.items()
                }
            )
        for name, most in self.obstacles.items():
            obstacle = world.model(name)
            x, y, _ = obstacle.pose.position
            drawn[name] = move_freely(
                world,
                obstacle,
                world.touching(obstacle),
                random,
                (x - most, x + most),
                (y - most, y + most),
            )
        if any(self.pose):
            (x, y, _), orientation = robot.pose
            xs, ys, yaws = (
                (here - most, here + most)
                for here, most in zip((x, y, yaw_of(orientation)), self.pose, strict=True)
            )
            drawn['pose'] = move_freely(world, robot, world.touching(robot), random, xs, ys, yaws)
        return drawn


def _numbers(values: Iterable[SupportsFloat]) -> list[float]:
    """Return values as finite numbers; none of them if they are not."""
    try:
        numbers = [float(value) for value in values]
    except (OverflowError, TypeError, ValueError):
        return []
    return numbers if all(map(math.isfinite, numbers)) else []


def _are_shifts(numbers: list[float]) -> bool:
    return bool(numbers) and all(0.0 <= one <= _MAX_SHIFT for one in numbers)


def _noisy(robot: Model) -> list[Sensor]:
    return [one for one in robot.sensors.values() if isinstance(one, Sensor) and one.is_noisy]


def _brighter(colour: Colour, factor: float) -> Colour:
    red, green, blue, alpha = colour
    return (factor * red, factor * green, factor * blue, alpha)
