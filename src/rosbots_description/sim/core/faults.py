"""Faults as values: what of a description or a world does not work as written, and where."""

import logging
import sys
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, replace
from typing import TypedDict, Unpack, overload

from .clock import SimClock

logger = logging.getLogger(__name__)

MOST_FAULTS = 200  # of a world; older ones are dropped


class FaultPlace(TypedDict, total=False):
    """The fields of a `Fault` that say where it is."""

    model: str
    link: str
    element: str
    line: int


@dataclass(frozen=True)
class Fault:
    """One fault; what is not known is '', or 0.

    Attributes:
        what: the sentence that says what is wrong, and where.
        severity: a level of `logging`: WARNING, or ERROR and above where something is missing.
        model: the name of the model.
        link: the name of its link.
        element: what is wrong in it, such as "plugin 'drive'" or "joint 'wheel'".
        line: of the text that was read: after xacro has expanded it.
        step: the number of steps that the world had made when this was reported first.
        cure: what helps; '' also where `what` says it.
        internal: whether it is a bug of the simulator, or of a plugin, and no fault of a user.
    """

    what: str
    severity: int = logging.WARNING
    model: str = ''
    link: str = ''
    element: str = ''
    line: int = 0
    step: int = 0
    cure: str = ''
    internal: bool = False

    def __str__(self) -> str:
        """Return the message: what is wrong, and what helps."""
        return f'{self.what}; {self.cure}' if self.cure else self.what


Receiver = Callable[[Fault], object]


def worst_first(faults: Iterable[Fault]) -> list[Fault]:
    """Return faults by severity, those of one in the order in which they were given."""
    return sorted(faults, key=lambda fault: -fault.severity)


def log_fault(fault: Fault) -> None:
    """Log a fault; an internal one with the traceback of the exception that is handled."""
    handled = sys.exception() if fault.internal else None
    logger.log(fault.severity, '%s', fault, exc_info=handled)


_context: ContextVar[tuple[Receiver, FaultPlace]] = ContextVar('context', default=(log_fault, {}))


def report(fault: Fault) -> None:
    """Hand a fault to who receives those of this context; without a receiver it is logged."""
    receive, place = _context.get()
    unknown = {name: value for name, value in place.items() if not getattr(fault, name)}
    receive(replace(fault, **unknown))  # type: ignore[arg-type]  # the fields of a FaultPlace


@contextmanager
def reporting_to(receive: Receiver, **place: Unpack[FaultPlace]) -> Iterator[None]:
    """Hand what is reported in this context to a receiver.

    Args:
        place: of faults that do not have one.
    """
    token = _context.set((receive, place))
    try:
        yield
    finally:
        _context.reset(token)


class Faults(Sequence[Fault]):
    """The faults of a world, each once, in the order of their first reports; any thread may report.

    Attributes:
        on_fault: called with each report, also with one that repeats; by default it is logged. It
            runs on the thread that reports.
        dropped: how many of the oldest were dropped, beyond `MOST_FAULTS`.
    """

    def __init__(self, clock: SimClock, on_fault: Receiver | None = None) -> None:
        self._clock = clock
        self._lock = threading.Lock()
        self._first: dict[Fault, Fault] = {}  # without its step -> as reported first
        self.on_fault = on_fault or log_fault
        self.dropped = 0

    def __len__(self) -> int:
        """Return the number of faults that are kept."""
        return len(self._first)

    @overload
    def __getitem__(self, index: int) -> Fault: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[Fault]: ...
    def __getitem__(self, index: int | slice) -> Fault | Sequence[Fault]:
        """Return a fault, or some."""
        with self._lock:
            return tuple(self._first.values())[index]

    def __repr__(self) -> str:
        """Return the messages."""
        return f'<{type(self).__name__} {list(map(str, self))}>'

    def report(
        self,
        what: str,
        severity: int = logging.WARNING,
        cure: str = '',
        **place: Unpack[FaultPlace],
    ) -> None:
        """Add a `Fault` with these fields."""
        self.add(Fault(what, severity, cure=cure, **place))

    def add(self, fault: Fault) -> None:
        """Keep a fault, unless it is known, and call `on_fault`; an exception of that is logged.

        What is less than a warning is no fault: it is logged only.
        """
        if fault.severity < logging.WARNING:
            log_fault(fault)
            return
        fault = replace(fault, step=self._clock.steps)
        with self._lock:
            self._first.setdefault(replace(fault, step=0), fault)
            if len(self._first) > MOST_FAULTS:
                del self._first[next(iter(self._first))]
                self.dropped += 1
        try:
            self.on_fault(fault)
        except Exception:
            logger.exception('on_fault failed; the simulation goes on')
