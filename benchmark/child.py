"""A process that answers each line on its standard input with one line."""

from __future__ import annotations

import subprocess
import sys
from typing import Self


class Child:
    """Runs a program of this folder in a child process, for the length of a `with` statement."""

    def __init__(self, program: str, *arguments: str) -> None:
        """Start the program."""
        self._process = subprocess.Popen(
            [sys.executable, program, *arguments],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_exception: object) -> None:
        self._process.communicate()

    def ask(self, line: str = '') -> str:
        """Send a line and return the answer."""
        self.send(line)
        return self.answer()

    def send(self, line: str) -> None:
        """Send a line; `answer` returns the answer."""
        assert self._process.stdin is not None
        self._process.stdin.write(f'{line}\n')
        self._process.stdin.flush()

    def answer(self) -> str:
        """Return the next line of its standard output."""
        assert self._process.stdout is not None
        return self._process.stdout.readline()
