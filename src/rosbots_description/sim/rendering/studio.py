"""The pictures of one world: its scene, the process that draws it, and cameras in it."""

import weakref
from collections import deque
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core import Pose
from ..runtime import World
from .gl import Lens
from .render_process import UNDER_WAY, RenderedCamera, RenderError, RenderProcess
from .scene import SceneMirror


class Picture(NamedTuple):
    """What one camera saw at `stamp_ns` [ns]; what was not asked for is None.

    Pixels are (height, width, channels) in the encoding of the lens, depths (height, width) float32
    along the optical axis [m], inf where nothing is.
    """

    stamp_ns: int
    pixels: NDArray[Any] | None
    depths: NDArray[Any] | None


class Studio:
    """Draws a world for its cameras; its process begins with the first picture."""

    def __init__(self, world: World) -> None:
        self._mirror = SceneMirror(world)
        self.process = RenderProcess(lambda key: self._mirror.meshes[key]())

    def look(self) -> NDArray[Any]:
        """Bring the scene up to date; return where its bodies are."""
        if self._mirror.update():
            self.process.set_scene(self._mirror.scene)
        return self._mirror.poses()


_STUDIOS: 'weakref.WeakKeyDictionary[World, Studio]' = weakref.WeakKeyDictionary()


def studio_of(world: World) -> Studio:
    """Return the studio of a world, which ends with it."""
    studio = _STUDIOS.get(world)
    if studio is None:
        studio = _STUDIOS[world] = Studio(world)
        world.resources.callback(studio.process.close)
        weakref.finalize(world, studio.process.close)  # of a world that nobody closes
    return studio


class Shutter:
    """Takes pictures with several lenses at once.

    A picture comes some time after it was asked for; meanwhile the world may go on.
    """

    def __init__(self, world: World) -> None:
        self._world = world
        self._cameras: list[RenderedCamera] = []
        self._stamps: deque[int] = deque()  # [ns] of pictures under way

    def close(self) -> None:
        """Take no more pictures."""
        for camera in self._cameras:
            camera.close()
        self._cameras.clear()

    @property
    def under_way(self) -> int:
        """Return how many pictures have not come yet."""
        return len(self._stamps)

    @property
    def is_free(self) -> bool:
        """Tell whether one more may be asked for."""
        return len(self._stamps) < UNDER_WAY

    def press(
        self, lenses: Sequence[tuple[Lens, Pose]], seed: int, wants: tuple[bool, bool]
    ) -> None:
        """Ask for a picture of the world as it is now.

        Args:
            lenses: the same each time, and where they are in the world.
            seed: of the noise.
            wants: pixels, depths.
        Raises:
            RenderError: nothing is drawn here.
        """
        studio = studio_of(self._world)
        bodies = studio.look()
        if not self._cameras:
            self._cameras = [studio.process.camera(lens) for lens, _ in lenses]
        for camera, (_, pose) in zip(self._cameras, lenses, strict=True):
            camera.request(np.array([*pose.position, *pose.orientation]), bodies, seed, wants)
        self._stamps.append(self._world.clock.now_ns)

    def take(self, wait: bool) -> tuple[Picture, ...] | None:
        """Return the oldest picture of each lens; None if they are not there, or none will come.

        Raises:
            RenderError: it could not be drawn.
        """
        if not self._stamps or not all(camera.has_picture(wait) for camera in self._cameras):
            return None
        stamp_ns = self._stamps.popleft()
        found, faults = [], []
        for camera in self._cameras:
            try:
                found.append(Picture(stamp_ns, *(camera.take(wait) or (None, None))))
            except RenderError as error:
                faults.append(error)
        if faults:
            raise faults[0]
        return tuple(found)
