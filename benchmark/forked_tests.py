"""Runs tests of the product in forks, with one of its files changed, or to record their calls.

No file is written: the import of the file gives the changed one. Programs that a test starts have
the unchanged one.
"""

from __future__ import annotations

import ast
import contextlib
import faulthandler
import importlib
import math
import mmap
import os
import pickle
import resource
import signal
import sys
import tempfile
import time
from collections.abc import Callable
from importlib.machinery import SourceFileLoader
from pathlib import Path
from typing import TypeVar

import pytest
from calls import Function, Record, Recorder

sys.path.append(str(Path(__file__).resolve().parents[1] / 'tools'))
from results import ROOT

# A test that takes as long hangs, which counts as noticed. The slowest takes 20 s of the processor.
HOPELESS_CPU, HOPELESS_WALL = 120, 1800  # [s]
LONGEST_NAME = 4096  # [bytes] of a test
# What tests import besides the product; all forks share it.
OTHERS = (
    '_pytest.assertion.rewrite',
    'hypothesis',
    'numpy',
    'pybullet',
    'lxml.etree',
    'yaml',
    'msgspec',
    'gymnasium',
    'rospy',
    'collada',
    'PIL.Image',
    'rosgraph',
    'sensor_msgs.msg',
    'gazebo_msgs.srv',
    'tf2_msgs.msg',
    'pyarrow',
    'viser',
    'scipy.spatial',
)
T = TypeVar('T')


def import_others() -> None:
    """Import what tests import besides the product."""
    for name in OTHERS:
        with contextlib.suppress(ImportError):
            importlib.import_module(name)


class Selection:
    """Runs some tests in their order, as a plugin of pytest.

    Attributes:
        failed: names of tests that failed, or of files that cannot be imported.
    """

    def __init__(self, tests: list[str]) -> None:
        self.failed: list[str] = []
        self._running = mmap.mmap(-1, LONGEST_NAME)  # shared with forks
        self._order = {name: place for place, name in enumerate(tests)}

    @pytest.hookimpl(trylast=True)  # type: ignore[untyped-decorator]
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        """Leave out all other tests, and undo the order of test/conftest.py."""
        items[:] = [item for item in items if item.nodeid in self._order]
        items.sort(key=lambda item: self._order[item.nodeid])

    @property
    def running(self) -> str:
        """Return the name of the test that runs, or ran last, in this process or in a fork."""
        return self._running[:].rstrip(b'\0').decode()

    def pytest_runtest_setup(self, item: pytest.Item) -> None:
        """Limit the time of each test."""
        self._running[:] = item.nodeid.encode().ljust(LONGEST_NAME, b'\0')
        _limit_time()

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Note a test that failed."""
        if report.failed:
            self.failed.append(report.nodeid)

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        """Note a file that cannot be imported."""
        if report.failed:
            self.failed.append(report.nodeid)


def run_tests(
    tests: list[str], path: Path | None = None, changed: ast.Module | None = None
) -> tuple[str, str]:
    """Run tests up to the first that fails, with another content of a file if given.

    Returns:
        'failed', 'hung', 'crashed', or '' if all tests passed; and which test, '' if none ran.
    """
    selection = Selection(tests)

    def run() -> list[str]:
        _limit_time()
        if path and changed:
            _replace(path, changed)
        files = dict.fromkeys(name.partition('::')[0] for name in tests)
        _run_pytest(selection, '-x', *files)
        return selection.failed

    failed, status = in_fork(run)
    if failed is None:
        verdict = 'hung' if -status in (signal.SIGALRM, signal.SIGXCPU) else 'crashed'
        return verdict, selection.running
    return ('failed', failed[0]) if failed else ('', '')


def record(tests: list[str]) -> tuple[dict[str, Record], frozenset[Function]]:
    """Run files of tests without any change.

    Returns:
        what each test calls, by its name; and the functions that imports call.
    """

    def run() -> tuple[dict[str, Record], frozenset[Function]]:
        recorder = Recorder(ROOT / 'src')
        recorder.start()
        _run_pytest(recorder, *tests)
        return recorder.records(), recorder.imported()

    recorded, status = in_fork(run)
    if recorded is None:
        raise SystemExit(f'without any change, the tests end with {status}: {" ".join(tests)}')
    return recorded


def in_fork(run: Callable[[], T]) -> tuple[T | None, int]:
    """Return what a function returns in a fork, which prints nothing; or None, and its status."""
    with tempfile.TemporaryFile() as output:
        child = os.fork()
        if child == 0:
            with contextlib.suppress(BaseException):
                os.setsid()
                with open(os.devnull, 'wb') as nowhere:
                    os.dup2(nowhere.fileno(), 1)
                    os.dup2(nowhere.fileno(), 2)
                resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
                faulthandler.disable()  # a crash is a result, of which nobody needs a trace
                output.write(pickle.dumps(run()))
                output.flush()
            os._exit(0)
        status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        with contextlib.suppress(ProcessLookupError):
            os.killpg(child, signal.SIGKILL)  # what its tests have left behind
        output.seek(0)
        text = output.read()
    return (pickle.loads(text) if text else None), status


def _limit_time() -> None:
    """End this process if it takes much longer from now on."""
    used = math.ceil(time.process_time())
    resource.setrlimit(resource.RLIMIT_CPU, (used + HOPELESS_CPU, resource.RLIM_INFINITY))
    signal.alarm(HOPELESS_WALL)


def _replace(path: Path, changed: ast.Module) -> None:
    """Let imports of a file in this process give the changed content."""
    get_code = SourceFileLoader.get_code

    def get_changed(loader: SourceFileLoader, name: str) -> object:
        if Path(loader.path).resolve() == path:  # the product has two names
            return compile(changed, str(path), 'exec')
        return get_code(loader, name)

    SourceFileLoader.get_code = get_changed  # type: ignore[method-assign, assignment]


def _run_pytest(plugin: object, *arguments: str) -> None:
    """Run pytest; raise SystemExit if it ended before all tests were run, other than by -x."""
    sys.dont_write_bytecode = True
    code = pytest.main(
        ['-q', f'--rootdir={ROOT}', '-p', 'no:cacheprovider', '-p', 'no:xdist', *arguments],
        plugins=[plugin],
    )
    if code not in (
        pytest.ExitCode.OK,
        pytest.ExitCode.TESTS_FAILED,
        pytest.ExitCode.NO_TESTS_COLLECTED,
    ):
        raise SystemExit(code)
