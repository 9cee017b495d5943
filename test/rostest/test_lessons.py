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

import rosgraph
import rostest
from simulator import free_port, wait_until
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
        self._port = free_port()
        self._environment = variables | {'ROS_MASTER_URI': f'http://localhost:{self._port}'}
        self._master = None
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

    def _start_master(self):
        """Start a ROS master, for roslaunch waits only 10 s for one of its own."""
        self._master = subprocess.Popen(
            ['rosmaster', '--core', '-p', str(self._port)],
            env=self._environment,
            stdout=subprocess.DEVNULL,
        )
        address = self._environment['ROS_MASTER_URI']
        wait_until(lambda: rosgraph.is_master_online(address), 'the ROS master', LIMIT)

    def _open(self, step):
        if self._master is None:
            self._start_master()
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
        for step, terminal in reversed(self._terminals):
            if terminal.process.poll() is None:
                os.killpg(terminal.process.pid, signal.SIGINT)
            wait_until(
                lambda terminal=terminal: terminal.process.poll() is not None,
                f'exit of {step.text}',
                LIMIT,
            )
            shown.append(terminal.shown())
        return shown

    def leave(self):
        """Kill what still runs, and remove the folder."""
        for _, terminal in self._terminals:
            if terminal.process.poll() is None:
                os.killpg(terminal.process.pid, signal.SIGTERM)
                terminal.process.wait(LIMIT)
            terminal.close()
        if self._master is not None:
            self._master.terminate()
            self._master.wait(LIMIT)
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
