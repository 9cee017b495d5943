"""The events that every panel of the page receives, and how it gives commands."""

import logging
from collections.abc import Callable
from typing import TypeVar

import viser

from ...sim.core import SimError
from ...sim.description import SceneChange, ShownMotion

logger = logging.getLogger(__name__)

Allow = Callable[..., None]  # as `Site.allow_viewers`
Value = TypeVar('Value')


def attempt(command: Callable[[], object], complain: Callable[[str], None]) -> None:
    """Carry out a command; if it is refused, complain with the reason."""
    try:
        command()
    except SimError as error:
        logger.warning('%s', error)
        complain(str(error))


def fill(field: viser.GuiInputHandle[Value], value: Value) -> None:
    """Set the value of a field."""
    field.value = value  # type: ignore[misc]  # viser's setter has no type


class Panel:
    """A part of the page that shows or controls something; it overrides what it needs."""

    def open(self) -> None:
        """Begin: the first browser has connected; of a panel of one browser: this one has."""

    def close(self) -> None:
        """End what costs the simulator anything: the last browser, or its own, has left."""

    def apply(self, change: SceneChange) -> None:
        """Take in a change of the scene."""

    def move(self, motion: ShownMotion) -> None:
        """Take in the clock and new poses, up to 60 times a second."""

    def refresh(self) -> None:
        """Look again at what nobody tells of; about twice a second."""
