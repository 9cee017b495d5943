"""What is recorded while it is seen: a scene that plays in any browser, and a video."""

import io
import logging
import threading
import time
from typing import Any, Protocol

import numpy as np
import viser
from viser.infra import Message, StateSerializer

from ...sim.description import ShownMotion
from ..controls import OPAQUE
from .nodes import MODELS

logger = logging.getLogger(__name__)

LONGEST = 120.0  # [s, wall] of a recording or video
MOST_POSES = 200_000  # of a recording, some 20 MB
MOST_BYTES = 100_000_000  # of the meshes and points in it
WIDEST = 1280  # [pixels] of a video
RATE = 20.0  # frames per second of a video, if the browser is that fast
PATIENCE = 60.0  # [s, wall] for a frame; the first one in a browser without a graphics card is slow
_MILLISECONDS = 1000


class BrowserRecording(Protocol):
    """Something that is being recorded."""

    @property
    def is_full(self) -> bool:
        """Whether there will be no more of it."""

    def move(self, motion: ShownMotion) -> None:
        """Take in a motion, before it is shown."""

    def finish(self) -> bytes:
        """End, and return the file; b'' if there is nothing in it."""


class SceneRecording:
    """The scene and its motion, as a page that needs no server."""

    def __init__(self, site: viser.ViserServer, client: viser.ClientHandle | None = None) -> None:
        """Begin with the scene as it is shown to all; what a browser has of its own may follow."""
        self._serializer = site.get_scene_serializer()
        self._own = _OwnNodes(self._serializer)
        self._lock = site._websock_server._record_lock
        # Viser's, of messages to the browser.
        self._recorders: list[Any] = (
            [] if client is None else client._websock_connection._record_handles
        )
        with self._lock:
            self._recorders.append(self._own)  # type: ignore[arg-type]  # it is called alike
        self._begin: float | None = None  # real time [s]
        self._now = 0.0
        self._poses = 0
        self._counted = self._bytes = 0  # buffers, and what they have

    @property
    def is_full(self) -> bool:
        """Whether it has reached its greatest length."""
        return self._length >= LONGEST or self._poses >= MOST_POSES or self._bytes >= MOST_BYTES

    @property
    def _length(self) -> float:
        return 0.0 if self._begin is None else self._now - self._begin

    def move(self, motion: ShownMotion) -> None:
        """Let time go on to that of the motion."""
        if self._begin is None or motion.real_time < self._now:  # it is another simulator
            self._begin = motion.real_time - self._length
        else:
            self._serializer.insert_sleep(motion.real_time - self._now)
        self._now = motion.real_time
        self._poses += len(motion.poses)
        buffers = self._serializer._binary_buffers  # viser's, which only grow
        while self._counted < len(buffers):
            self._bytes += buffers[self._counted].nbytes
            self._counted += 1

    def finish(self) -> bytes:
        """Return the page, in HTML."""
        with self._lock:
            self._recorders.remove(self._own)
        page = self._serializer.as_html()
        return page.replace('</head>', f'<style>{OPAQUE}</style></head>', 1).encode()


class _OwnNodes:
    """Adds to a recording what one browser sees at models: boxes and overlays, and no controls."""

    def __init__(self, serializer: StateSerializer) -> None:
        self._serializer = serializer

    def _insert_message(self, message: Message) -> None:  # viser calls it for each
        if getattr(message, 'name', '').startswith(f'{MODELS}/'):
            self._serializer._insert_message(message)


class VideoRecording:
    """What a browser shows, as H.264 in MP4."""

    def __init__(self, client: viser.ClientHandle) -> None:
        """Begin to ask a browser for its pictures, on a thread."""
        import av  # loads FFmpeg, for those who make videos only

        self._client = client
        camera = client.camera
        scale = min(1.0, WIDEST / max(camera.image_width, camera.image_height, 1))
        self._width, self._height = (  # even, as H.264 needs them
            max(2, 2 * round(scale * pixels / 2.0))
            for pixels in (camera.image_width, camera.image_height)
        )
        self._file = io.BytesIO()
        self._container = av.open(self._file, 'w', format='mp4')
        self._stream = self._container.add_stream('libx264', rate=_MILLISECONDS)
        self._stream.width, self._stream.height = self._width, self._height
        self._stream.pix_fmt = 'yuv420p'
        self._stream.options = {'preset': 'veryfast', 'crf': '23'}
        self._frames = 0
        self._end = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    @property
    def is_full(self) -> bool:
        """Whether it has reached its greatest length, or the browser has disconnected."""
        return not self._thread.is_alive()

    def move(self, motion: ShownMotion) -> None:
        """Show it: the browser does."""

    def finish(self) -> bytes:
        """Return the video."""
        self._end.set()
        self._thread.join()
        if not self._frames:
            return b''  # the container is not begun
        self._container.mux(self._stream.encode(None))
        self._container.close()
        return self._file.getvalue()

    def _run(self) -> None:
        begin = time.monotonic()
        passed = 0.0
        while passed < LONGEST and not self._end.is_set():
            try:
                picture = self._client.get_render(self._height, self._width, timeout=PATIENCE)
            except (TimeoutError, RuntimeError) as error:
                logger.debug('the video ends: %s', error)
                return
            self._add(picture, round(passed * _MILLISECONDS))
            self._end.wait(max(0.0, passed + 1.0 / RATE - (time.monotonic() - begin)))
            passed = time.monotonic() - begin

    def _add(self, picture: np.ndarray[Any, Any], stamp: int) -> None:
        """Add a picture, (height, width, 3) bytes, at `stamp` [ms]."""
        import av

        frame = av.VideoFrame.from_ndarray(picture, format='rgb24')
        frame.pts = stamp
        self._frames += 1
        self._container.mux(self._stream.encode(frame))
