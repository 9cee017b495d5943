"""Lets the simulator's log messages appear as a ROS node's: console, log file and /rosout."""

import logging
from collections.abc import Callable

import rospy
from rospy.impl.rosout import RosOutHandler
from rospy.rostime import _set_rostime

from ...sim.core import one_line

_ROOT = __name__.partition('.')[0]  # this library, under whichever name it was imported
_PLUGINS = f'{_ROOT}.sim.plugins.'  # their modules log only while a plugin is loaded
_REMEMBERED = 1000  # texts
_LEVELS = {
    'debug': logging.DEBUG,
    'info': logging.INFO,
    'warn': logging.WARNING,
    'error': logging.ERROR,
    'fatal': logging.CRITICAL,
}


def connect_logging(now_ns: Callable[[], int]) -> None:
    """Give this package's loggers the handlers that rospy made; call after `init_node`.

    rospy routes only its own logger `rosout` to the terminal, the log file and /rosout.

    Args:
        now_ns: the simulated time [ns] that messages are stamped with, besides wall time.

    """
    ours, rosout = logging.getLogger(_ROOT), logging.getLogger('rosout')
    for handler in (Preparation(now_ns), *_console_and_file(rosout)):
        ours.addHandler(handler)
    ours.setLevel(rosout.level)
    ours.propagate = False
    for name in tuple(logging.root.manager.loggerDict):
        if name.startswith(_PLUGINS):
            logging.getLogger(name).addFilter(Unrepeated())


def set_level(name: str) -> None:
    """Show messages from this level on: debug, info, warn, error or fatal, in any case.

    Another word changes nothing.
    """
    level = _LEVELS.get(name.lower())
    if level is not None:
        logging.getLogger(_ROOT).setLevel(level)


def leave_rosout() -> None:
    """Log to the terminal and the file only, once another node has this one's name.

    rospy looks a parameter up for each message to /rosout, by which it registers the node again:
    the master would shut the other one down.
    """
    for logger in (logging.getLogger(_ROOT), logging.getLogger('rosout')):
        for handler in tuple(logger.handlers):
            if isinstance(handler, RosOutHandler):
                logger.removeHandler(handler)


def _console_and_file(logger: logging.Logger | None) -> list[logging.Handler]:
    """Return the handlers that a message to `logger` would reach, its parents' included."""
    handlers: list[logging.Handler] = []
    while logger is not None:
        handlers += logger.handlers
        logger = logger.parent if logger.propagate else None
    return handlers


class Unrepeated(logging.Filter):
    """Lets each text through once: a robot that is spawned again has the same flaws as before."""

    def __init__(self) -> None:
        super().__init__()
        self._said: set[str] = set()

    def filter(self, record: logging.LogRecord) -> bool:
        """Tell whether the message is new, or was said too long ago to be known."""
        text = record.getMessage()
        if text in self._said:
            return False
        if len(self._said) >= _REMEMBERED:
            self._said.clear()
        self._said.add(text)
        return True


class Preparation(logging.Handler):
    """Makes each message ready for the handlers behind it: one printable line, at simulated time.

    The simulator does not listen to its own /clock: at 1000 messages per second that would cost
    more than the physics. rospy offers no public way to set the time.
    """

    def __init__(self, now_ns: Callable[[], int]) -> None:
        """Take the simulated time [ns] from `now_ns`."""
        super().__init__()
        self._now_ns = now_ns

    def emit(self, record: logging.LogRecord) -> None:
        """Escape what a user's names bring into the text, and take over the simulated time."""
        record.msg, record.args = one_line(record.getMessage()), ()
        _set_rostime(rospy.Time(nsecs=self._now_ns()))
