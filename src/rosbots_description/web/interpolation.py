"""Motions shown twice as often as a simulator sends them: first halfway, then where it says."""

import logging
import math
import threading
import time
from collections.abc import Callable

from ..sim.core import Pose, normalise
from ..sim.description import ShownMotion

logger = logging.getLogger(__name__)

PERIOD = 1.0 / 60.0  # [s, wall] between two motions that are shown: viser sends no more often
FASTEST = 10.0  # [m/s, simulated] of a body; faster is a jump
TURN = math.cos(math.pi / 4.0)  # of half the angle: beyond 90 degrees, nobody knows which way


class Interpolation:
    """Shows motions from a thread of its own, which rests while none come.

    Whoever brings one does not wait for that: while the page is slower than the simulator, poses
    that have not been shown give way to newer ones of the same links, and none is shown halfway.
    """

    def __init__(self, lock: threading.RLock, show: Callable[[ShownMotion], None]) -> None:
        """Begin closed; `show` is called with the lock held."""
        self._changed = threading.Condition(lock)
        self._show = show
        self._thread: threading.Thread | None = None
        self._last: ShownMotion | None = None
        self._next: ShownMotion | None = None  # not shown yet, or only halfway

    def open(self) -> None:
        """Show what is taken from now on."""
        with self._changed:
            self._thread = threading.Thread(target=self._run, name='interpolation', daemon=True)
            self._thread.start()

    def close(self) -> None:
        """Show nothing more."""
        with self._changed:
            self._thread = None
            self.forget()
            self._changed.notify_all()

    def take(self, motion: ShownMotion) -> None:
        """Take in a motion."""
        with self._changed:
            self._next = motion if self._next is None else motion.after(self._next)
            self._changed.notify_all()

    def forget(self) -> None:
        """Forget motions that have not been shown: links have other numbers from now on."""
        with self._changed:
            self._last = self._next = None

    def _run(self) -> None:
        me, is_half, cost = threading.current_thread(), False, 0.0
        with self._changed:
            while self._thread is me:
                if self._next is None:
                    self._changed.wait()
                    continue
                begin = time.monotonic()
                shown = self._next
                half = None if is_half or cost > PERIOD / 2.0 else halfway(self._last, shown)
                is_half = half is not None
                if half is None:
                    self._last, self._next = shown, None
                try:
                    self._show(half or shown)
                except Exception:
                    logger.exception('a motion could not be shown')
                cost = time.monotonic() - begin
                self._changed.wait_for(lambda: self._thread is not me, max(0.0, PERIOD - cost))


def halfway(last: ShownMotion | None, motion: ShownMotion) -> ShownMotion | None:
    """Return the motion between two, of the links that are in both and did not jump, if any."""
    passed = 0.0 if last is None else motion.time - last.time
    if last is None or passed <= 0.0:  # reset, or moved by hand while paused
        return None
    middles = {
        number: _middle(last.poses[number], pose, FASTEST * passed)
        for number, pose in motion.poses.items()
        if number in last.poses
    }
    poses = {number: pose for number, pose in middles.items() if pose is not None}
    if not poses:
        return None
    return ShownMotion(
        (last.time + motion.time) / 2.0,
        (last.real_time + motion.real_time) / 2.0,
        (last.iterations + motion.iterations) // 2,
        motion.paused,
        poses,
    )


def _middle(a: Pose, b: Pose, farthest: float) -> Pose | None:
    """Return the pose between two; None if they are farther apart [m], or turned by too much."""
    (ax, ay, az), (bx, by, bz) = a.position, b.position
    if math.dist(a.position, b.position) > farthest:
        return None
    one, other = a.orientation, b.orientation
    cosine = sum(x * y for x, y in zip(one, other, strict=True))
    if abs(cosine) < TURN:
        return None
    sign = math.copysign(1.0, cosine)  # q and -q are the same orientation
    i, j, k, w = (x + sign * y for x, y in zip(one, other, strict=True))
    return Pose(((ax + bx) / 2.0, (ay + by) / 2.0, (az + bz) / 2.0), normalise((i, j, k, w)))
