"""A program on a pseudo-terminal: keys in, screen out."""

import os
import pty
import select
import subprocess
import termios


class Terminal:
    """A pseudo-terminal with a program; collects the output."""

    def __init__(self, *command, **options):
        self._keyboard, self._screen = pty.openpty()
        self.saved_mode = termios.tcgetattr(self._screen)
        self.process = subprocess.Popen(
            command, stdin=self._screen, stdout=self._screen, stderr=self._screen,
            start_new_session=True, **options)
        self._shown = b''

    def type(self, key):
        os.write(self._keyboard, key.encode())

    def shown(self):
        """Return the output so far."""
        while select.select([self._keyboard], [], [], 0.0)[0]:
            self._shown += os.read(self._keyboard, 4096)
        return self._shown.decode()

    def mode(self):
        """Return the terminal's settings."""
        return termios.tcgetattr(self._screen)

    def close(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        os.close(self._keyboard)
        os.close(self._screen)


def open_display():
    """Ensure that there is a display, a virtual one if needed; return a function that closes it."""
    if 'DISPLAY' in os.environ:
        return lambda: None
    read, write = os.pipe()
    display = Terminal('Xvfb', '-displayfd', str(write), '-screen', '0', '1400x900x24',
                       pass_fds=(write,))
    os.close(write)
    with os.fdopen(read) as numbers:
        os.environ['DISPLAY'] = f':{numbers.readline().strip()}'

    def close():
        del os.environ['DISPLAY']
        display.close()

    return close
