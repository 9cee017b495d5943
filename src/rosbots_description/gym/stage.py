"""A world with a robot at rest, to which each episode returns."""

import logging
import os
from collections import deque
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..sim import Fault, Pose, SimError, World, yaw_of
from ..sim.core import MOST_FAULTS, Receiver, log_fault
from .actions import Actions, Limits
from .observations import forget, observed
from .pictures import Pictures
from .placement import Place, Range, move, move_freely

logger = logging.getLogger(__name__)
_logged: set[str] = set()  # what was logged of descriptions in this process

_NANOSECONDS = 1_000_000_000
Path = str | os.PathLike[str]


@dataclass(frozen=True)
class Setting:
    """What a stage is made of; see `SimEnv`."""

    world: Path
    robot: Path
    pose: Pose
    arguments: Mapping[str, str]
    actions: Limits | None
    sensors: Sequence[str] | None
    settle: float
    package_path: Sequence[Path]
    model_path: Sequence[Path]
    controllers: Mapping[str, object]


class Stage:
    """A world with a robot; the robot has come to rest, and that state was saved.

    `touched` are the names of the models that the robot touches at rest, such as the ground;
    `found` are the faults that came while both were loaded.
    """

    def __init__(self, setting: Setting) -> None:
        """Load the world and the robot.

        Raises:
            SimError: one of them cannot be loaded, or the robot has no such sensor or plugin.
            ValueError: a number is out of range.
        """
        self._setting = setting
        self._new: deque[Fault] = deque(maxlen=MOST_FAULTS)
        self.is_open = True
        self._load()

    def _load(self) -> None:
        found: list[Fault] = []
        try:
            self._load_parts(found.append)
        finally:
            _log(found)
        self.world.faults.on_fault = self._take
        self.found = tuple(found)
        self.touched = frozenset(self.world.touching(self.robot))
        forget(self.robot)
        self._start = self.world.save_state()
        self._started_ns = self.world.clock.now_ns
        self._rebuilds = self.world.rebuilds

    def _load_parts(self, on_fault: Receiver) -> None:
        given = self._setting
        self.world = World.from_file(
            given.world,
            package_path=given.package_path,
            model_path=given.model_path,
            on_fault=on_fault,
        )
        try:
            self.robot = self.world.spawn(given.robot, pose=given.pose, arguments=given.arguments)
            if given.controllers:
                self.robot.plugin('gazebo_ros_control').start_all(given.controllers)
            self.actions = Actions(self.world, self.robot, given.actions)
            self.pictures = Pictures(self.world, self.robot)
            self.observed = observed(self.robot, given.sensors)
            self.world.run(seconds=given.settle)
        except BaseException:
            self.world.close()
            raise

    def _take(self, fault: Fault) -> None:
        """Log a fault, and keep it for the next info."""
        self._new.append(fault)
        log_fault(fault)

    def new_faults(self) -> tuple[Fault, ...]:
        """Return what was reported since the last call, at most `MOST_FAULTS`."""
        new = tuple(self._new)
        self._new.clear()
        return new

    def close(self) -> None:
        """Free the world; idempotent."""
        self.is_open = False
        self.world.close()

    def restore(self) -> None:
        """Return to the saved state; where that is not possible any more, load everything again.

        Raises:
            SimError: it is closed.
        """
        if not self.is_open:
            raise SimError('this environment is closed; make another one')
        try:
            self.world.restore(self._start)
        except SimError as error:
            logger.warning('the world is loaded again: %s', error)
            self.world.close()
            self._load()

    @property
    def time(self) -> float:
        """Return the time since the saved state [s, simulated]."""
        return (self.world.clock.now_ns - self._started_ns) / _NANOSECONDS

    @property
    def has_diverged(self) -> bool:
        """Tell whether numbers of the world were no longer finite, so that it was rebuilt."""
        return self.world.rebuilds != self._rebuilds

    @property
    def pose(self) -> Place:
        """Return the robot's true x, y [m] and yaw [rad]."""
        (x, y, _), orientation = self.robot.pose
        return x, y, yaw_of(orientation)

    def place(self, place: Place) -> None:
        """Move the robot; height, roll and pitch stay."""
        move(self.robot, place)

    def place_freely(self, random: np.random.Generator, xs: Range, ys: Range) -> Place:
        """Move the robot to a random place where it overlaps nothing; see `move_freely`."""
        return move_freely(self.world, self.robot, self.touched, random, xs, ys)

    def bumps(self) -> bool:
        """Tell whether the robot touches a model that it did not touch at rest."""
        return any(name not in self.touched for name in self.world.touching(self.robot))

    def whole_steps(self, period: float) -> int:
        """Return the steps of a control period [s].

        Raises:
            ValueError: it is no multiple of the step size.
        """
        step_ns = self.world.clock.step_ns
        steps = round(period * _NANOSECONDS / step_ns) if 0.0 < period < np.inf else 0
        if steps < 1 or abs(steps * step_ns - period * _NANOSECONDS) > 0.5:
            raise ValueError(
                f'period is {period} s; it must be a multiple of the step size of the '
                f'world, {step_ns / _NANOSECONDS:g} s'
            )
        return steps


def _log(faults: Iterable[Fault]) -> None:
    """Log errors, and warnings as one, unless this process has: a robot gives the same again."""
    for fault in faults:
        if fault.severity > logging.WARNING:
            log_fault(fault)
    found = [str(fault) for fault in faults if fault.severity == logging.WARNING]
    count = f'{len(found)} warnings' if len(found) > 1 else 'a warning'
    given = f'loading the robot and its world gave {count}'
    message = f'{given}, not to be repeated: {"; ".join(found)}'
    if found and message not in _logged:
        _logged.add(message)
        logger.warning('%s', message)
