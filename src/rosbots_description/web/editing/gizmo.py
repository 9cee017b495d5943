"""Handles in the scene by which the selected model is moved and turned."""

import threading
from collections.abc import Callable
from functools import partial

import numpy as np
import viser

from ...sim.core import Pose
from ...sim.description import SceneChange, ShownMotion
from ..controls import Panel, attempt
from ..scene import Selection, place, pose_of, wxyz
from .editor import Editor
from .history import History

NODE = '/gizmo'
PERIOD = 0.05  # [s, wall] between two commands while dragging
HOLD = 1.0  # [s, wall] after which the simulator lets go by itself


class Drag:
    """Holds a model at a pose, which may be changed by any thread, until it is released.

    The newest pose is sent, at most every `PERIOD`, by a thread of its own: a simulator that
    answers slowly skips poses. It holds the model at rest in each.
    """

    def __init__(
        self,
        model: str,
        pose: Pose,
        editor: Editor,
        history: History,
        complain: Callable[[str], None],
        ended: Callable[['Drag'], None],
    ) -> None:
        """Begin; `ended` is called at the end."""
        self.model, self.pose, self._start = model, pose, pose
        self._editor, self._history = editor, history
        self._complain, self._ended = complain, ended
        self._released = threading.Event()
        self._is_taken_over = False
        threading.Thread(target=self._run, daemon=True).start()

    @property
    def is_released(self) -> bool:
        """Tell whether the last pose is being sent."""
        return self._released.is_set()

    def release(self) -> None:
        """Send the last pose, and end."""
        self._released.set()

    def give_way(self) -> None:
        """End without a further command: the model is another browser's, or nothing is selected."""
        self._is_taken_over = True
        self._released.set()

    def _run(self) -> None:
        attempt(self._follow, self._complain)
        self._ended(self)

    def _follow(self) -> None:
        turn = self._history.turn
        while not (self._released.wait(PERIOD) and turn.acquire(timeout=PERIOD)):
            if self._is_taken_over:
                return
            self._editor.hold(self.model, self.pose, HOLD)
        try:
            if not self._is_taken_over:
                self._move(self.pose)
        finally:
            turn.release()

    def _move(self, pose: Pose) -> None:
        """Let the model go at its last pose, and remember the move if it is one."""
        self._editor.hold(self.model, pose, 0.0)
        before = self._start
        if not np.allclose(
            [*pose.position, *pose.orientation], [*before.position, *before.orientation]
        ):
            self._history.add(
                f"move '{self.model}'", partial(self._editor.move, self.model, before)
            )


class Drags:
    """The drags of all browsers. The one that has grabbed a model last moves it."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._newest: dict[str, Drag] = {}  # by models

    def add(self, drag: Drag) -> None:
        """Let a drag take over its model."""
        with self._lock:
            before = self._newest.get(drag.model)
            self._newest[drag.model] = drag
        if before is not None:
            before.give_way()

    def remove(self, drag: Drag) -> None:
        """Forget a drag that has ended."""
        with self._lock:
            if self._newest.get(drag.model) is drag:
                del self._newest[drag.model]


class Gizmo(Panel):
    """The handles in one browser."""

    def __init__(
        self,
        client: viser.ClientHandle,
        selection: Selection,
        editor: Editor,
        drags: Drags,
        history: History,
        complain: Callable[[str], None],
    ) -> None:
        self._drags = drags
        self._client, self._models, self._selection = client, selection.models, selection
        self._editor, self._history, self._complain = editor, history, complain
        self._lock = threading.Lock()  # of the drag
        self._drag: Drag | None = None
        self._handle: viser.TransformControlsHandle | None = None
        self._model: str | None = None  # at which it is
        selection.on_change(self._reach)

    def close(self) -> None:
        """Let go."""
        self._release()

    def apply(self, _change: SceneChange) -> None:
        """Follow a model that was spawned anew under its name."""
        self._follow()

    def move(self, _motion: ShownMotion) -> None:
        """Follow the model, unless it follows."""
        self._follow()

    def _follow(self) -> None:
        model = self._model
        if (
            self._handle is not None
            and self._drag is None
            and (model is not None and model in self._models.all)
        ):
            place(self._handle, self._models.pose(model))

    def _reach(self) -> None:
        """Be at the model that is selected now."""
        if self._selection.model == self._model:
            return  # only its link is another
        self._model = self._selection.model
        with self._lock:
            if self._drag is not None:
                # Without a selection the model is deleted next, perhaps; else it goes after `HOLD`.
                end = self._drag.give_way if self._model is None else self._drag.release
                end()
        if self._handle is not None:
            self._handle.remove()
            self._handle = None
        if self._model is not None:
            pose = self._models.pose(self._model)
            with self._client.atomic():  # not grabbed before it is listened to
                self._handle = self._client.scene.add_transform_controls(
                    NODE,
                    1.0,
                    fixed=False,
                    depth_test=False,
                    opacity=0.8,
                    position=pose.position,
                    wxyz=wxyz(pose),
                )
                self._handle.on_update(self._dragged)

    async def _dragged(self, event: viser.TransformControlsEvent) -> None:
        """Take in what the browser does; on viser's own thread, so it must not wait."""
        if event.phase == 'start':
            self._grab(event)
        elif event.phase == 'update':
            with self._lock:
                if self._drag is not None:
                    self._drag.pose = pose_of(event.target)
        else:
            self._release()

    def _grab(self, event: viser.TransformControlsEvent) -> None:
        with self._lock:
            is_free = self._drag is None or self._drag.is_released
            if is_free and self._model is not None and event.target is self._handle:
                self._drag = Drag(
                    self._model,
                    pose_of(event.target),
                    self._editor,
                    self._history,
                    self._complain,
                    self._end,
                )
                self._drags.add(self._drag)

    def _release(self) -> None:
        with self._lock:
            if self._drag is not None:
                self._drag.release()

    def _end(self, drag: Drag) -> None:
        self._drags.remove(drag)
        with self._lock:
            if self._drag is drag:
                self._drag = None
