"""A thread for calls to the ROS master, so that simulation steps do not wait for it."""

import logging
import threading
from collections.abc import Callable
from queue import SimpleQueue

import rospy

logger = logging.getLogger(__name__)


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

    def _work(self) -> None:
        while True:
            job = self._jobs.get()
            try:
                job()
            except rospy.ROSInterruptException:  # the node is shutting down
                return
            except Exception:
                logger.exception('a registration with the ROS master failed')
