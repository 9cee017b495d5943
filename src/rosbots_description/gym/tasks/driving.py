"""What the tasks have in common: the robot of the article, and no touching of what stands."""

from typing import Any, ClassVar

from ..env import SimEnv

BUMPED = -1.0  # reward for touching something, which ends the episode


class Driving(SimEnv):
    """A task with settings of its own, which the arguments of `SimEnv` replace."""

    settings: ClassVar[dict[str, Any]] = {}

    def __init__(self, **options: Any) -> None:  # noqa: ANN401  those of SimEnv
        """Load world and robot; the arguments are those of `SimEnv`."""
        super().__init__(**{
            'arguments': {'laser': 'true'}, 'sensors': ['laser', 'odometry'],
            'actions': {'differential_drive_controller': (0.8, 0.8)},
            **self.settings, **options})
