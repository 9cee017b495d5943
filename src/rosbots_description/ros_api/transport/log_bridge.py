"""Routes the simulator's log messages as a ROS node's: to console, log file and /rosout."""

import logging
from collections.abc import Callable

import rospy
from rospy.rostime import _set_rostime

from ...sim.core import Fault, log_fault, one_line

_ROOT = __name__.partition('.')[0]  # the package, by the name it was imported as
_REMEMBERED = 1000  # distinct warnings
_LEVELS = {
    'debug': logging.DEBUG,
    'info': logging.INFO,
    'warn': logging.WARNING,
    'error': logging.ERROR,
    'fatal': logging.CRITICAL,
}


def connect_logging(now_ns: Callable[[], int]) -> None:
    """Attach rospy's handlers to this package's loggers; call after `init_node`.

    rospy routes only its own logger `rosout` to the terminal, the log file and /rosout.

    Args:
        now_ns: returns the simulated time [ns] that messages are stamped with.

    """
    ours, rosout = logging.getLogger(_ROOT), logging.getLogger('rosout')
    for handler in (RecordPreparation(now_ns), *_console_and_file(rosout)):
        ours.addHandler(handler)
    ours.setLevel(rosout.level)
    ours.propagate = False


def set_level(name: str) -> None:
    """Set the least level to show: debug, info, warn, error or fatal, in any case.

    Other names are ignored.
    """
    level = _LEVELS.get(name.lower())
    if level is not None:
        logging.getLogger(_ROOT).setLevel(level)


def _console_and_file(logger: logging.Logger | None) -> list[logging.Handler]:
    """Return the handlers of `logger` and of its parents, as far as it propagates."""
    handlers: list[logging.Handler] = []
    while logger is not None:
        handlers += logger.handlers
        logger = logger.parent if logger.propagate else None
    return handlers


class FaultLog:
    """Logs faults; a warning of a plugin once, as a robot that is spawned again gives the same."""

    def __init__(self) -> None:
        self._seen: set[str] = set()

    def __call__(self, fault: Fault) -> None:
        """Log a fault, unless it is such a warning that was logged and not forgotten since."""
        if fault.severity == logging.WARNING and fault.element.startswith('plugin '):
            if str(fault) in self._seen:
                return
            if len(self._seen) >= _REMEMBERED:
                self._seen.clear()
            self._seen.add(str(fault))
        log_fault(fault)


class RecordPreparation(logging.Handler):
    """Prepares each message for the handlers after it: one printable line, with simulated time.

    The simulator does not subscribe to its own /clock, which at 1000 messages per second would cost
    more than the physics. rospy has no public API to set the time.
    """

    def __init__(self, now_ns: Callable[[], int]) -> None:
        """Take the simulated time [ns] from `now_ns`."""
        super().__init__()
        self._now_ns = now_ns

    def emit(self, record: logging.LogRecord) -> None:
        """Escape control characters of users' names, and set rospy's time."""
        record.msg, record.args = one_line(record.getMessage()), ()
        _set_rostime(rospy.Time(nsecs=self._now_ns()))
