"""Pictures of a world: its scene, its rendering process and its cameras."""

import weakref
from collections import deque
from collections.abc import Sequence
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from ..core import Pose
from ..runtime import World
from .gl import Lens, Scene, Wants
from .render_process import MAX_PENDING, RenderedCamera, RenderError, RenderProcess
from .scene import SceneMirror, Triangles


class Picture(NamedTuple):
    """A picture of one camera at `stamp_ns` [ns]; None for what was not requested.

    Pixels are (height, width, channels) in the encoding of the lens, depths (height, width) float32
    along the optical axis [m], inf for the background. `jpeg` is a file of the pixels.
    """

    stamp_ns: int
    pixels: NDArray[Any] | None
    depths: NDArray[Any] | None
    jpeg: bytes | None = None


class Mirror(Protocol):
    """A world as a scene; see `SceneMirror`."""

    scene: Scene
    meshes: dict[str, Triangles]

    def update(self) -> bool:
        """Update `scene`; return whether it has changed."""

    def poses(self) -> NDArray[Any]:
        """Return the poses of its bodies (n, 7)."""


class SceneRenderer:
    """Draws a world; the process starts with the first picture and is closed with the world."""

    def __init__(self, world: World, mirror: Mirror) -> None:
        self._mirror = mirror
        self.process = RenderProcess(lambda key: self._mirror.meshes[key]())
        world.resources.callback(self.process.close)
        weakref.finalize(world, self.process.close)  # if the world is never closed

    def update(self) -> NDArray[Any]:
        """Update the scene; return the poses of its bodies (n, 7)."""
        if self._mirror.update():
            self.process.set_scene(self._mirror.scene)
        return self._mirror.poses()


_RENDERERS: 'weakref.WeakKeyDictionary[World, SceneRenderer]' = weakref.WeakKeyDictionary()


def renderer_of(world: World) -> SceneRenderer:
    """Return the renderer of a world, which all its cameras share."""
    renderer = _RENDERERS.get(world)
    if renderer is None:
        renderer = _RENDERERS[world] = SceneRenderer(world, SceneMirror(world))
    return renderer


class ImageCapture:
    """Takes pictures with several lenses at the same time.

    Pictures are drawn asynchronously: the world may continue after a request.
    """

    def __init__(self, world: World, renderer: SceneRenderer | None = None) -> None:
        """Take pictures of a world by a renderer; None for that of its cameras."""
        self._world, self._renderer = world, renderer
        self._cameras: list[RenderedCamera] = []
        self._stamps: deque[int] = deque()  # [ns] of pending pictures

    def close(self) -> None:
        """Close the cameras."""
        for camera in self._cameras:
            camera.close()
        self._cameras.clear()

    @property
    def pending(self) -> int:
        """Return the number of pending pictures."""
        return len(self._stamps)

    @property
    def is_free(self) -> bool:
        """Tell whether another picture may be requested."""
        return len(self._stamps) < MAX_PENDING

    def request(self, lenses: Sequence[tuple[Lens, Pose]], seed: int, wants: Wants) -> None:
        """Request a picture of the world in its current state.

        Args:
            lenses: always the same lenses, with their poses in the world.
            seed: of the noise.
            wants: what the pictures are to contain.
        Raises:
            RenderError: drawing was given up.
        """
        renderer = self._renderer or renderer_of(self._world)
        bodies = renderer.update()
        if not self._cameras:
            self._cameras = [renderer.process.camera(lens) for lens, _ in lenses]
        for camera, (_, pose) in zip(self._cameras, lenses, strict=True):
            camera.request(np.array([*pose.position, *pose.orientation]), bodies, seed, wants)
        self._stamps.append(self._world.clock.now_ns)

    def receive_image(self, wait: bool) -> tuple[Picture, ...] | None:
        """Return the oldest picture of each lens; None if they are pending or none was requested.

        Raises:
            RenderError: a picture could not be drawn.
        """
        if not self._stamps or not all(camera.has_image(wait) for camera in self._cameras):
            return None
        stamp_ns = self._stamps.popleft()
        found, faults = [], []
        for camera in self._cameras:
            try:
                found.append(Picture(stamp_ns, *(camera.receive_image(wait) or ())))
            except RenderError as error:
                faults.append(error)
        if faults:
            raise faults[0]
        return tuple(found)
