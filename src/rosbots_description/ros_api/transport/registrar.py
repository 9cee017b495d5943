"""A thread that registers and unregisters with the ROS master, so that no step waits for it."""

import logging
import threading
from collections.abc import Callable
from queue import SimpleQueue

import rospy

logger = logging.getLogger(__name__)


class Registrar:
    """Does jobs one after the other on a thread of its own; faults are logged."""

    def __init__(self) -> None:
        self._jobs: SimpleQueue[Callable[[], None]] = SimpleQueue()
        threading.Thread(target=self._work, name='registrar', daemon=True).start()

    def post(self, job: Callable[[], None]) -> None:
        """Do `job()` after those posted before it; any thread may post."""
        self._jobs.put(job)

    def wait(self, deadline: float) -> bool:
        """Wait until all jobs posted so far are done; tell whether they were, by `deadline` [s]."""
        done = threading.Event()
        self.post(done.set)
        return done.wait(deadline)

    def _work(self) -> None:
        while True:
            job = self._jobs.get()
            try:
                job()
            except rospy.ROSInterruptException:  # the node is shutting down
                return
            except Exception:
                logger.exception('a registration with the ROS master failed')
