"""A goal of an action, such as a trajectory to follow, and what becomes of it."""

from typing import Any

from ..runtime import Output

ACTIVE, SUCCEEDED, ABORTED, CANCELED, REJECTED = (
    'active',
    'succeeded',
    'aborted',
    'canceled',
    'rejected',
)


class Goal:
    """A goal that is followed, or was; a subclass has its result.

    Attributes:
        status: active, succeeded, aborted, canceled or rejected.
        done: output of itself, sent once when it is no longer active.
    """

    def __init__(self) -> None:
        self.status = ACTIVE
        self.done: Output[Any] = Output(lambda: None)

    @property
    def is_active(self) -> bool:
        """Whether it is still followed."""
        return self.status == ACTIVE

    def end(self, status: str) -> None:
        """Set the status of an active goal, whose result is set, and send `done`."""
        self.status = status
        self.done.send(self)
