"""What the panels of all browsers ask a simulator again and again: asked once, however many ask."""

import threading
from collections.abc import Sequence

from ..sim.core import Pose, SimError, Twist
from ..sim.description import GROUND_PLANE, CommandTopic
from .controls import Panel
from .simulator import Simulator

LOOKS = 10  # refreshes between two looks at what can be inserted


class Polled(Panel):
    """Answers as old as the last refresh; it is refreshed before the panels of browsers."""

    def __init__(self, simulator: Simulator) -> None:
        self._simulator = simulator
        self.drive_topics: Sequence[str] = ()  # that take velocity commands
        self.command_topics: Sequence[CommandTopic] = ()  # of controllers of joints
        # What can be inserted: models of the model path, and parameters that hold a URDF.
        self.insertable: tuple[Sequence[str], Sequence[str]] = (), ()
        self._states: dict[tuple[str, str | None], tuple[Pose, Twist]] = {}
        self._fault = ''  # why the simulator did not answer since the last refresh
        self._refreshes = 0
        self._look = threading.Thread()

    def open(self) -> None:
        """Look at once."""
        self._refreshes = 0

    def refresh(self) -> None:
        """Ask anew, what can be inserted now and then; a slow answer to that delays nothing."""
        self._states, self._fault = {}, ''
        if self._simulator.robots is not None:
            self.drive_topics = tuple(self._simulator.robots.drive_topics())
        if self._simulator.joints is not None:
            self.command_topics = tuple(self._simulator.joints.command_topics())
        if self._refreshes % LOOKS == 0 and not self._look.is_alive():
            self._look = threading.Thread(target=self._look_around, daemon=True)
            self._look.start()
        self._refreshes += 1

    def state(
        self, model: str, link: str | None, patience: float | None = None
    ) -> tuple[Pose, Twist]:
        """Return pose and velocity of a model or a link; see `inspector.States`.

        Raises:
            SimError: also if another state was not told since the last refresh, as the next
                answer might take as long.
        """
        assert self._simulator.inspection is not None
        if self._fault:
            raise SimError(self._fault)
        if (model, link) not in self._states:
            try:
                self._states[model, link] = self._simulator.inspection.state(model, link, patience)
            except SimError as error:
                self._fault = str(error)
                raise
        return self._states[model, link]

    def omissions(self, model: str) -> Sequence[str]:
        """Return the parts that a model was spawned without; see `inspector.States`."""
        inspection = self._simulator.inspection
        return inspection.omissions(model) if inspection is not None else ()

    def _look_around(self) -> None:
        library = self._simulator.library
        if library is not None:
            models = tuple(name for name in library.models() if name != GROUND_PLANE.name)
            self.insertable = models, tuple(library.parameters())
