"""A program on a pseudo-terminal: keys in, screen out."""

import os
import pty
import select
import signal
import subprocess
import termios
import threading
from pathlib import Path

from programs import end, keep

LIMIT = 180.0  # [s, wall] of a program's end; only ends a hopeless wait


class Terminal:
    """A pseudo-terminal with a program; collects the output.

    A thread reads it, for a program that nobody reads stands still once some kilobytes wait.
    """

    def __init__(self, *command, **options):
        self._keyboard, self._screen = pty.openpty()
        self._open, self._closing = os.pipe()
        self._lock = threading.Lock()
        self.saved_mode = termios.tcgetattr(self._screen)
        self.process = subprocess.Popen(
            command,
            stdin=self._screen,
            stdout=self._screen,
            stderr=self._screen,
            start_new_session=True,
            **options,
        )
        self._shown = b''
        self._reader = threading.Thread(target=self._read_on, daemon=True)
        self._reader.start()

    def _read_on(self):
        while self._open not in select.select([self._keyboard, self._open], [], [])[0]:
            self._read()

    def _read(self):
        with self._lock:
            while select.select([self._keyboard], [], [], 0.0)[0]:
                self._shown += os.read(self._keyboard, 4096)

    def type(self, key):
        os.write(self._keyboard, key.encode())

    def shown(self):
        """Return the output so far."""
        self._read()
        return self._shown.decode(errors='replace')

    def mode(self):
        """Return the terminal's settings."""
        return termios.tcgetattr(self._screen)

    def end(self, number=signal.SIGINT, limit=LIMIT):
        """Press Ctrl-C, or send another signal; return the exit code."""
        if self.process.poll() is None:
            os.killpg(self.process.pid, number)
        return self.process.wait(limit)

    def close(self):
        end(self.process)
        os.close(self._closing)
        self._reader.join()
        keep(self.shown(), Path(self.process.args[0]).name, self.process)
        for handle in (self._open, self._keyboard, self._screen):
            os.close(handle)


def open_display():
    """Ensure that there is a display, a virtual one if needed; return a function that closes it."""
    if 'DISPLAY' in os.environ:
        return lambda: None
    read, write = os.pipe()
    # Without -noreset it refuses connections for a moment whenever the last window is closed.
    options = ('-noreset', '-displayfd', str(write), '-screen', '0', '1400x900x24')
    display = Terminal('Xvfb', *options, pass_fds=(write,))
    os.close(write)
    with os.fdopen(read) as numbers:
        os.environ['DISPLAY'] = f':{numbers.readline().strip()}'

    def close():
        del os.environ['DISPLAY']
        display.close()

    return close
