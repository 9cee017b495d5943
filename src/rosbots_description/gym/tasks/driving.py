"""Base class of the tasks: the article's robot, an episode of which ends at a collision."""

import math
from collections.abc import Mapping
from typing import Any, ClassVar

from ..env import SimEnv

BUMPED = -1.0  # reward for touching something, which ends the episode


class Driving(SimEnv):
    """A task with settings of its own, which the arguments of `SimEnv` replace."""

    settings: ClassVar[dict[str, Any]] = {}
    takes: ClassVar[dict[str, int]] = {'start': 3}  # options of `reset`, and how many numbers each

    def __init__(self, **options: object) -> None:
        """Load world and robot; the arguments are those of `SimEnv`."""
        super().__init__(
            **{
                'arguments': {'laser': 'true'},
                'sensors': ['laser', 'odometry'],
                'actions': {'differential_drive_controller': (0.8, 0.8)},
                **self.settings,
                **options,
            }
        )

    def numbers(self, options: Mapping[str, Any]) -> dict[str, tuple[float, ...]]:
        """Return the options of `reset`, checked.

        Raises:
            ValueError: there is no such option, or it is not as many finite numbers.
        """
        found = {}
        for name, value in options.items():
            size = self.takes.get(name)
            if size is None:
                raise ValueError(
                    f"there is no option '{name}'; {type(self).__name__} takes "
                    f'{", ".join(self.takes)}'
                )
            try:
                numbers = tuple(map(float, value))
            except (TypeError, ValueError):
                numbers = ()
            if len(numbers) != size or not all(map(math.isfinite, numbers)):
                raise ValueError(
                    f"the option '{name}' takes {size} finite numbers; it got {value!r}"
                )
            found[name] = numbers
        return found
