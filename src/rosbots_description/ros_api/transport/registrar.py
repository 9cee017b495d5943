"""A thread for calls to the ROS master, so that simulation steps do not wait for it."""

import logging
import threading
import time
from collections.abc import Callable
from queue import SimpleQueue

import rospy

from .master import AddressError, is_master_running

logger = logging.getLogger(__name__)

PATIENCE = 5.0  # between two looks whether a master answers [s, wall]
LONGEST = 60.0  # time for registrations, on a busy machine [s, wall]


class Registrar:
    """Runs jobs in order on its own thread; errors are logged."""

    def __init__(self) -> None:
        self._jobs: SimpleQueue[Callable[[], None]] = SimpleQueue()
        threading.Thread(target=self._work, name='registrar', daemon=True).start()

    def post(self, job: Callable[[], None]) -> None:
        """Queue `job()`; may be called from any thread."""
        self._jobs.put(job)

    def wait(self, deadline: float) -> bool:
        """Wait until all queued jobs are done; tell whether they were within `deadline` [s]."""
        done = threading.Event()
        self.post(done.set)
        return done.wait(deadline)

    def await_registration(self, name: str) -> None:
        """Wait until all queued jobs are done; not where no master answers, which is logged.

        Args:
            name: of what waits.
        """
        end = time.monotonic() + LONGEST
        while not self.wait(PATIENCE):
            if time.monotonic() > end or not _has_master():
                logger.warning(
                    '%s: the ROS master has not registered all topics; it will be done later', name
                )
                return

    def _work(self) -> None:
        while True:
            job = self._jobs.get()
            try:
                job()
            except Exception:
                if rospy.core.is_shutdown_requested():  # topics are closed, or about to be
                    return
                logger.exception('a registration with the ROS master failed')


def _has_master() -> bool:
    try:
        return is_master_running(rospy.get_name())
    except AddressError:  # it stands still
        return False
