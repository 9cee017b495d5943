#!/usr/bin/env python3
"""The lessons in doc/lessons, as their readers follow them: each in an empty folder."""

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import rostest
from server_process import MasterProcess
from simulator import wait_until
from terminal import Terminal

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / 'test'))
from support.lessons import LESSONS, File, Shown, missing, read_lesson  # noqa: E402

LIMIT = 180.0  # [s, wall] only ends a hopeless wait: a step takes some seconds on an idle machine
# What a reader's shell has before `./rosbots shell`; there is no display, so no window is opened.
OF_A_READER = ('HOME', 'LANG', 'ROS_LOG_DIR', 'XDG_CACHE_HOME')


def environment():
    """Return the environment of a reader who has typed `./rosbots shell`."""
    outside = {name: os.environ[name] for name in OF_A_READER if name in os.environ}
    outside |= {'PATH': '/usr/local/bin:/usr/bin:/bin', 'TERM': 'dumb'}
    shown = subprocess.run(
        [ROOT / 'rosbots', 'shell', '-c', 'env -0'],
        env=outside,
        text=True,
        stdout=subprocess.PIPE,
        stdin=subprocess.DEVNULL,
        timeout=LIMIT,
        check=True,
    ).stdout
    variables = shown[shown.rindex('==> ') if '==> ' in shown else 0 :]
    return dict(variable.split('=', 1) for variable in variables.split('\0') if variable)


class Reader:
    """Follows one lesson in an empty folder, with a ROS master of its own."""

    def __init__(self, variables):
        self.folder = Path(tempfile.mkdtemp(prefix='lesson_'))
        self._master = MasterProcess()  # roslaunch waits only 10 s for one of its own
        self._environment = variables | {'ROS_MASTER_URI': self._master.address}
        self._terminals = []  # each with its step

    def follow(self, step):
        """Save a file, or type commands and compare what they print with the page."""
        if isinstance(step, File):
            step.write(self.folder)
        elif isinstance(step, Shown):
            _, terminal = self._terminals[0 if step.in_first else -1]
            for key in step.keys:
                terminal.type(key)
            self._see(step, terminal)
        elif step.goes_on:
            self._open(step)
        else:
            self._type(step)

    def _open(self, step):
        if not self._terminals:
            self._master.start()
        terminal = Terminal(
            'bash', '-c', f'exec {step.text}', cwd=self.folder, env=self._environment
        )
        self._terminals.append((step, terminal))
        self._see(step, terminal)

    def _see(self, step, terminal):
        """Wait until a terminal has shown what the page says."""
        wait_until(
            lambda: not missing(step.expected, terminal.shown()) or self._ended(),
            f'line {step.line}: {step.expected}',
            LIMIT,
        )
        self._compare(step, terminal.shown())

    def _ended(self):
        """Return the steps in terminals of their own whose programs have failed."""
        return [
            (step, terminal.shown())
            for step, terminal in self._terminals
            if terminal.process.poll()
        ]

    def _type(self, step):
        with (
            tempfile.TemporaryFile('w+') as output,
            subprocess.Popen(
                ['bash', '-ec', step.text],
                cwd=self.folder,
                env=self._environment,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                start_new_session=True,
            ) as process,
        ):
            try:
                wait_until(
                    lambda: process.poll() is not None or self._ended(),
                    f'the end of {step.text}',
                    LIMIT,
                )
                if self._ended():
                    raise AssertionError(f'before the end of {step.text}: {self._ended()}')
            finally:
                if process.poll() is None:
                    os.killpg(process.pid, signal.SIGTERM)
            output.seek(0)
            shown = output.read()
        if (process.returncode != 0) != step.fails:
            raise AssertionError(
                f'line {step.line}: exit code {process.returncode} of {step.text}{shown}'
            )
        self._compare(step, shown)

    @staticmethod
    def _compare(step, output):
        if lacks := missing(step.expected, output):
            raise AssertionError(f'line {step.line}: {lacks} is not in this output:\n{output}')

    def end(self):
        """Press Ctrl-C in each terminal, the last one first; return what they have shown."""
        shown = []
        for _, terminal in reversed(self._terminals):
            terminal.end()
            shown.append(terminal.shown())
        return shown

    def leave(self):
        """Kill what still runs, and remove the folder."""
        for _, terminal in self._terminals:
            terminal.end(signal.SIGTERM)
            terminal.close()
        self._master.__exit__()
        shutil.rmtree(self.folder)


class LessonsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.variables = environment()

    def follow(self, lesson):
        reader = Reader(self.variables)
        self.addCleanup(reader.leave)
        for step in read_lesson(lesson):
            reader.follow(step)
        for shown in reader.end():
            self.assertNotIn('Traceback', shown)


def add_test(lesson):
    """Give LessonsTest a test of a lesson."""

    def test(self):
        self.follow(lesson)

    setattr(LessonsTest, f'test_{lesson.stem}', test)


for page in LESSONS:
    add_test(page)

if __name__ == '__main__':
    rostest.rosrun('rosbots_description', 'lessons', LessonsTest, sys.argv)
