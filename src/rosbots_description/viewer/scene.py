"""The scene of a world for its page; written by the thread that owns the world."""

import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import replace

from ..sim import World
from ..sim.description import SceneChange, ShownMotion
from ..sim.runtime import ShownWorld
from .pace import Pace

Change = Callable[[SceneChange], None]
Motion = Callable[[ShownMotion], None]
SILENCE = 1.0  # [s, wall]


class WorldView:
    """Calls back what has changed, while a browser is connected."""

    def __init__(self, world: World, pace: Pace) -> None:
        self._world, self._pace = world, pace
        self._shown = ShownWorld(world)
        self._lock = threading.Lock()
        self._change: Change | None = None
        self._motion: Motion | None = None
        self._is_new = False
        self._begun = time.monotonic()
        self._last: ShownMotion | None = None

    @property
    def is_open(self) -> bool:
        """Return whether a browser is connected."""
        return self._change is not None

    def open(self, change: Change, motion: Motion) -> None:
        """Begin to call back, whenever the world is shown."""
        with self._lock:
            self._change, self._motion, self._is_new = change, motion, True

    def close(self) -> None:
        """End that."""
        with self._lock:
            self._change = self._motion = None

    def follow(self, world: World) -> None:
        """Show another world from now on."""
        self._world, self._shown = world, ShownWorld(world)

    def show(self) -> None:
        """Call back what has changed."""
        with self._lock:
            change, motion, is_new, self._is_new = self._change, self._motion, self._is_new, False
        if change is None or motion is None:
            return
        if is_new:
            self._shown.reset()
        changed = self._shown.change()
        if changed is not None:
            change(changed)
        self._world.paused = self._pace.paused
        self._last = self._shown.motion(time.monotonic() - self._begun)
        motion(self._last)

    def repeat(self) -> None:
        """Call back, from any thread, with the clock as it was shown last, if that is long ago.

        The page takes a longer silence for the end of the program, which may compute something
        else, or wait for its next cell.
        """
        motion, last, now = self._motion, self._last, time.monotonic() - self._begun
        if motion is not None and last is not None and now - last.real_time > SILENCE:
            motion(replace(last, real_time=now, poses={}))


class ReleasingView(WorldView):
    """Lets a program go on that was paused when the last browser disconnects."""

    def close(self) -> None:
        """End to call back."""
        super().close()
        self._pace.unpause()


class RelayedView(WorldView):
    """Calls back on a thread of its own: the page may wait for a command while it is called."""

    def open(self, change: Change, motion: Motion) -> None:
        """Begin to call back."""
        self._relay = Relay(change, motion)
        super().open(self._relay.change, self._relay.motion)

    def close(self) -> None:
        """End that."""
        super().close()
        self._relay.end()


class Relay:
    """Passes changes and motions on, in order; of motions that wait it makes one."""

    def __init__(self, change: Change, motion: Motion) -> None:
        self._show_change, self._show_motion = change, motion
        self._changed = threading.Condition()
        self._waiting: deque[SceneChange | ShownMotion] = deque()
        self._is_ended = False
        threading.Thread(target=self._run, name='page scene', daemon=True).start()

    def change(self, change: SceneChange) -> None:
        """Pass on a change."""
        self._add(change)

    def motion(self, motion: ShownMotion) -> None:
        """Pass on a motion, with those of one that waits."""
        with self._changed:
            last = self._waiting[-1] if self._waiting else None
            if isinstance(last, ShownMotion):
                self._waiting.pop()
                motion = motion.after(last)
        self._add(motion)

    def end(self) -> None:
        """Pass on nothing more."""
        with self._changed:
            self._is_ended = True
            self._changed.notify_all()

    def _add(self, one: SceneChange | ShownMotion) -> None:
        with self._changed:
            self._waiting.append(one)
            self._changed.notify_all()

    def _run(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._waiting or self._is_ended)
                if self._is_ended:
                    return
                one = self._waiting.popleft()
            if isinstance(one, ShownMotion):
                self._show_motion(one)
            else:
                self._show_change(one)
