"""A recording of a scene, without a browser."""

from ..sim.description import SceneChange, ShownMotion
from .scene import Models, SceneRecording, SceneView, StartView
from .site import Site


class Recorder:
    """Records changes and motions as a page that plays in any browser; not thread-safe."""

    def __init__(self) -> None:
        """Begin with an empty scene, on a site that nobody is told of."""
        self._site = Site('127.0.0.1', 0)
        models = Models()
        self._start = StartView(models)
        self._panels = models, self._start, SceneView(self._site, lambda _model, _link, _: None)
        self._take: SceneRecording | None = None

    @property
    def is_full(self) -> bool:
        """Whether it has reached its greatest length or size."""
        return self._take is not None and self._take.is_full

    def change(self, change: SceneChange) -> None:
        """Take in a change; the first one is the whole scene."""
        for panel in self._panels:
            panel.apply(change)
        if self._take is None:
            camera = self._site.initial_camera
            camera.position, camera.look_at = self._start.choose()
            self._take = SceneRecording(self._site)

    def move(self, motion: ShownMotion) -> None:
        """Take in a motion; its real time is that at which it is played."""
        if self._take is not None:
            self._take.move(motion)
        for panel in self._panels:
            panel.move(motion)

    def finish(self) -> bytes:
        """End, and return the page."""
        try:
            return self._take.finish() if self._take is not None else b''
        finally:
            self._site.stop()
