"""What the page needs of a simulator, by parts."""

from collections.abc import Callable
from typing import Protocol

from ..sim.description import SceneChange, ShownMotion
from .editing import Editor, Inspection, Library
from .panels import (
    Contacts,
    GetFaults,
    Goals,
    Joints,
    Maps,
    Robots,
    ShownTopics,
    Signals,
    TimeControl,
    Worlds,
)


class View(Protocol):
    """The scene of a simulator."""

    def open(
        self, change: Callable[[SceneChange], None], motion: Callable[[ShownMotion], None]
    ) -> None:
        """Begin to call back, from any thread."""

    def close(self) -> None:
        """End that."""


class Simulator(Protocol):
    """A simulator that can be seen and controlled, by parts."""

    @property
    def view(self) -> View:
        """Its scene."""

    @property
    def time(self) -> TimeControl:
        """Its clock."""

    @property
    def robots(self) -> Robots | None:
        """Its robots, if they can be driven."""

    @property
    def joints(self) -> Joints | None:
        """Its joints, if they can be moved."""

    @property
    def inspection(self) -> Inspection | None:
        """Its models and links, if they can be changed."""

    @property
    def contacts(self) -> Contacts | None:
        """What touches in it, if that can be seen."""

    @property
    def library(self) -> Library | None:
        """What can be inserted into it, if anything can."""

    @property
    def editor(self) -> Editor | None:
        """What edits its models, if anything does."""

    @property
    def worlds(self) -> Worlds | None:
        """Its world as a file, if it gives that away."""

    @property
    def sensors(self) -> ShownTopics | None:
        """What its robots sense with, if that can be seen."""

    @property
    def maps(self) -> Maps | None:
        """Maps of it, and what navigation makes of them, if that can be seen."""

    @property
    def goals(self) -> Goals | None:
        """What takes goals and initial poses, if anything does."""

    @property
    def faults(self) -> GetFaults | None:
        """What does not work in it, if it tells that."""

    @property
    def signals(self) -> Signals | None:
        """Numbers that can be plotted, if any can."""
