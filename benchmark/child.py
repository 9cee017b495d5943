"""A process that answers each line on its standard input with one line."""

from __future__ import annotations

import subprocess
import sys
from typing import Self


class Child:
    """A program of this folder in a process of its own, while a `with` statement lasts."""

    def __init__(self, program: str, *arguments: str) -> None:
        """Start it."""
        self._process = subprocess.Popen(
            [sys.executable, program, *arguments],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_exception: object) -> None:
        self._process.communicate()

    def ask(self, line: str = '') -> str:
        """Return what it answers."""
        assert self._process.stdin is not None
        self._process.stdin.write(f'{line}\n')
        self._process.stdin.flush()
        return self.answer()

    def answer(self) -> str:
        """Return the next line that it writes."""
        assert self._process.stdout is not None
        return self._process.stdout.readline()
