"""Which functions each test calls, recorded while pytest runs."""

from __future__ import annotations

import contextlib
import sys
import threading
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from types import CodeType, FrameType

    from _pytest.fixtures import FixtureDef

Function = tuple[str, int]  # file, and line of its first decorator, or of its def


@dataclass(frozen=True)
class Record:
    """One test that ran without any change."""

    seconds: float = 0.0
    failed: bool = False
    calls: frozenset[Function] = frozenset()


class Recorder:
    """Records tests, as a plugin of pytest.

    What a shared fixture calls counts for each test that uses it. What a file calls while it is
    imported is nobody's.

    Args:
        folder: whose functions are recorded.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._records: dict[str, Record] = {}
        self._fixtures: dict[str, tuple[str, ...]] = {}  # names of those that a test uses
        self._calls: dict[str, set[CodeType]] = defaultdict(set)  # of tests
        self._shared: dict[tuple[str, str], set[CodeType]] = defaultdict(set)  # by place and name
        self._imported: set[CodeType] = set()
        self._noting = [self._imported]  # the last one counts

    def records(self) -> dict[str, Record]:
        """Return what was recorded, by the name of the test."""
        for (place, fixture), calls in self._shared.items():
            for name, fixtures in self._fixtures.items():
                if fixture in fixtures and name.startswith(place):
                    self._calls[name] |= calls
        return {
            name: replace(record, calls=self._functions(self._calls[name]))
            for name, record in self._records.items()
        }

    def imported(self) -> frozenset[Function]:
        """Return the functions that are called when files are imported."""
        return self._functions(self._imported)

    def _functions(self, codes: set[CodeType]) -> frozenset[Function]:
        return frozenset(
            (str(path), code.co_firstlineno)
            for code in codes
            if self._folder in (path := _without_links(code.co_filename)).parents
        )

    def note(self, frame: FrameType, event: str, _: object) -> None:
        """Note a call, as a trace function."""
        if event == 'call':
            self._noting[-1].add(frame.f_code)

    def start(self) -> None:
        """Note the calls of this process from now on, or until a test ends that."""
        sys.settrace(self.note)
        threading.settrace(self.note)

    @contextlib.contextmanager
    def _note_in(self, calls: set[CodeType]) -> Iterator[None]:
        self._noting.append(calls)
        self.start()  # anew: hypothesis, among others, ends the tracing of others with its own
        try:
            yield
        finally:
            self._noting.pop()

    @pytest.hookimpl(hookwrapper=True)  # type: ignore[untyped-decorator]
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        """Note the calls of one test, with its own fixtures."""
        self._fixtures[item.nodeid] = tuple(getattr(item, 'fixturenames', ()))
        with self._note_in(self._calls[item.nodeid]):
            yield

    @pytest.hookimpl(hookwrapper=True)  # type: ignore[untyped-decorator]
    def pytest_fixture_setup(self, fixturedef: FixtureDef[object]) -> Iterator[None]:
        """Note the calls of a shared fixture."""
        if fixturedef.scope == 'function':
            yield
        else:
            with self._note_in(self._shared[fixturedef.baseid, fixturedef.argname]):
                yield

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Note one phase of a test."""
        record = self._records.get(report.nodeid, Record())
        self._records[report.nodeid] = replace(
            record,
            seconds=record.seconds + report.duration,
            failed=record.failed or report.failed,
        )


@cache
def _without_links(name: str) -> Path:
    """Return the place of a file: the product has two names."""
    return Path(name).resolve()
