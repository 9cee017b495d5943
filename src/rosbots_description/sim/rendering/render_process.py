"""Client side of the rendering process, which is started on demand and restarted if it dies.

Pixels are returned in shared memory.
"""

import logging
import mmap
import os
import socket
import struct
import subprocess
import sys
import time
from collections import deque
from collections.abc import Callable
from itertools import count
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core import POLL_PERIOD, Fault, ProcessWatch, report
from .gl import Lens, Scene, Wants

logger = logging.getLogger(__name__)

MAX_PENDING = 3  # pending pictures of one camera
MAX_CRASHES = 3  # in a row without a picture; then it is not restarted
_FOLDER = str(Path(__file__).parent)
# It imports one package by its bare name, so that nothing of the simulator is loaded.
_PROGRAM = """
import sys
sys.path[:] = sys.argv[1], *sys.argv[3:]
from gl.process import main
main(int(sys.argv[2]))
"""
# Longest time in which the process takes nothing of a message; a picture may take long on shared
# processors, and nothing is read meanwhile.
SEND_TIMEOUT = 60  # [s, wall]

# Pixels, depths and a JPEG file; None for what was not wanted.
Content = tuple[NDArray[Any] | None, NDArray[Any] | None, bytes | None]


class RenderError(Exception):
    """A picture cannot be drawn; the message says why."""


class NoRendererError(RenderError):
    """No camera can draw pictures any more; the log says why."""


class RenderProcess:
    """Draws one scene for any number of cameras. Not thread-safe."""

    def __init__(self, meshes: Callable[[str], NDArray[Any]]) -> None:
        """Prepare; the process starts with the first request.

        Args:
            meshes: returns the triangles for a mesh key of a scene.
        """
        self._meshes = meshes
        self._process: subprocess.Popen[bytes] | None = None
        self._connection: Connection[Any, Any] | None = None
        self._ready = False  # the process has reported its renderer, and has scene and cameras
        self._scene = Scene(())
        self._sent: set[str] = set()
        self._cameras: dict[int, RenderedCamera] = {}
        self._numbers = count()  # of cameras, never reused: answers to closed ones may still arrive
        self._crashes = 0
        self.fault = ''  # why drawing was given up
        self._is_hung = False
        self._next_poll = 0.0  # of the watch [s, monotonic]

    def close(self) -> None:
        """End the process."""
        if self._connection is not None and self._process is not None:
            self._connection.close()
            self._process.kill()  # a stopped process does not end otherwise
            self._process.wait()
        self._connection = self._process = None
        self._ready = False

    @property
    def process_id(self) -> int | None:
        """Return the process's id, or None while there is none."""
        return None if self._process is None else self._process.pid

    def set_scene(self, scene: Scene) -> None:
        """Set the scene to draw."""
        self._scene = scene
        if self._ready:
            self._send_scene()

    def camera(self, lens: Lens) -> 'RenderedCamera':
        """Return a camera, which the caller closes."""
        number = next(self._numbers)
        camera = self._cameras[number] = RenderedCamera(self, number, lens)
        if self._ready:
            self._send_camera(camera)
        return camera

    # For cameras.

    def forget(self, camera: 'RenderedCamera') -> None:
        """Remove a camera."""
        del self._cameras[camera.number]
        if self._ready:
            self._send(('forget', camera.number))

    def request(self, message: tuple[Any, ...]) -> None:
        """Request a picture; until the process is ready, the request waits."""
        if self._connection is None:
            self._start()
        elif self._ready:
            self._send(message)

    def receive(self, wait: bool) -> bool:
        """Handle one answer, waiting for it if `wait`; return whether there was one."""
        if self._connection is None or self._process is None:
            return False
        try:
            while not self._connection.poll(POLL_PERIOD if wait else 0.0):
                if self._check_hung():
                    break
                if not wait:
                    return False
            number, fault, *rest = self._connection.recv()
        except (EOFError, OSError):
            self._handle_exit()
            return False
        self._watch_anew()
        if not self._ready:
            self._begin(number, fault, *rest)
            return True
        self._crashes = 0
        camera = self._cameras.get(number)
        if camera is not None:
            camera.complete(fault)
        return True

    def _check_hung(self) -> bool:
        """Kill a process that has been stopped, or makes no progress; tell whether it was."""
        if self._process is None or time.monotonic() < self._next_poll:
            return False
        self._next_poll = time.monotonic() + POLL_PERIOD
        self._is_hung = self._watch.is_hung()
        if self._is_hung:
            self._process.kill()
        return self._is_hung

    def _watch_anew(self) -> None:
        """Begin to watch a process that has just made progress."""
        if self._process is not None:
            self._watch = ProcessWatch(self._process.pid)
            self._next_poll = time.monotonic() + POLL_PERIOD
            self._is_hung = False

    def _start(self) -> None:
        ours, theirs = socket.socketpair()
        for end in (ours, theirs):
            end.setblocking(True)  # overrides socket.setdefaulttimeout
        ours.setsockopt(socket.SOL_SOCKET, socket.SO_SNDTIMEO, struct.pack('ll', SEND_TIMEOUT, 0))
        with theirs:
            threads = max(0, min(4, len(os.sched_getaffinity(0)) - 2))
            self._process = subprocess.Popen(
                [sys.executable, '-P', '-c', _PROGRAM, _FOLDER, str(theirs.fileno()), *sys.path],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                pass_fds=[theirs.fileno()],
                env={'LP_NUM_THREADS': str(threads), 'OPENBLAS_NUM_THREADS': '1', **os.environ},
            )
        self._connection = Connection(ours.detach())
        self._watch_anew()

    def _begin(self, state: str, text: str, is_software: bool = False) -> None:
        """Handle the first answer; `text` is the renderer's name, or why there is none."""
        if state == 'failed':
            self.close()
            self._fail(f'cameras cannot render images: {text}')
            return
        logger.info(
            'images are rendered by %s%s',
            text,
            ', in software: no GPU is available' if is_software else '',
        )
        self._ready = True
        self._sent = set()
        self._send_scene()
        for camera in self._cameras.values():
            self._send_camera(camera)
            camera.resend()

    def _send_scene(self) -> None:
        scene = self._scene
        used = {part.mesh for part in scene.parts}
        for key in sorted(used - self._sent):
            self._send(('mesh', key, self._meshes(key).astype('f4').tobytes()))
        images = {part.appearance.texture for part in scene.parts} - {''}
        for path in sorted(images - self._sent):
            self._send(('image', path))
        self._sent = used | images
        self._send(
            (
                'scene',
                [(*part[:3], tuple(part.appearance), *part[4:]) for part in scene.parts],
                [tuple(light) for light in scene.lights],
                *scene[2:],
            )
        )

    def _send_camera(self, camera: 'RenderedCamera') -> None:
        self._send(('camera', camera.number, tuple(camera.lens), len(camera.memory)))
        if self._connection is not None:
            stream = socket.socket(fileno=os.dup(self._connection.fileno()))
            stream.setblocking(True)  # as above: the handle is new, the socket is the same
            with stream:
                socket.send_fds(stream, [b'm'], [camera.file])

    def _send(self, message: tuple[Any, ...]) -> None:
        if self._connection is None:
            return  # it has died meanwhile
        try:
            self._connection.send(message)
        except OSError:
            self._handle_exit()

    def _handle_exit(self) -> None:
        """Handle the death of the process: restart it, or give up."""
        process = self._process
        self.close()
        self._crashes += 1
        code = process.returncode if process is not None else 0
        ended = f'killed by signal {-code}' if code < 0 else f'exit code {code}'
        if self._is_hung:
            ended = 'it was stopped, or hung, and was killed'
        if self._crashes < MAX_CRASHES:
            report(Fault(f'the render process has died ({ended}); restarting it', logging.ERROR))
            self._start()
        else:
            self._fail(
                f'cameras stop: the render process has died {self._crashes} times '
                f'in a row ({ended})'
            )

    def _fail(self, fault: str) -> None:
        report(Fault(fault, logging.ERROR))
        self.fault = fault
        for camera in self._cameras.values():
            camera.fail(fault)


class RenderedCamera:
    """One camera: request pictures, and take them in the same order."""

    def __init__(self, process: RenderProcess, number: int, lens: Lens) -> None:
        self.number = number
        self.lens = lens
        self._process = process
        self._size = lens.colour_bytes + lens.depth_bytes + lens.jpeg_bytes
        self.file = os.memfd_create('picture')
        os.truncate(self.file, MAX_PENDING * self._size)
        self.memory = mmap.mmap(self.file, MAX_PENDING * self._size)
        self._requested: deque[tuple[Any, ...]] = deque()  # requests without an answer
        # Answered requests, each with a fault or ''.
        self._done: deque[tuple[tuple[Any, ...], str]] = deque()
        self._next = 0

    def close(self) -> None:
        """Close the camera."""
        self._process.forget(self)
        self.memory.close()
        os.close(self.file)

    @property
    def pending(self) -> int:
        """Return the number of pictures requested and not yet taken; at most MAX_PENDING."""
        return len(self._requested) + len(self._done)

    def request(self, eye: NDArray[Any], poses: NDArray[Any], seed: int, wants: Wants) -> None:
        """Request a picture of the current scene.

        Args:
            eye: the camera's pose (7,), position [m] and quaternion x, y, z, w.
            poses: of the bodies of the scene (n, 7).
            seed: of the noise.
            wants: what is to be returned by `take`.
        Raises:
            RenderError: drawing was given up.
        """
        message = (
            'picture',
            self.number,
            self._next * self._size,
            tuple(wants),
            seed,
            eye.tobytes(),
            poses.tobytes(),
        )
        if self._process.fault:
            raise NoRendererError(self._process.fault)
        self._next = (self._next + 1) % MAX_PENDING
        self._requested.append(message)
        self._process.request(message)

    def receive_image(self, wait: bool) -> Content | None:
        """Return what was wanted of the oldest requested picture, or None if it is pending.

        Pixels are (height, width, channels), depths (height, width) float32 [m], inf for the
        background. They are copies.

        Args:
            wait: until the picture is finished; None then means that none was requested.
        Raises:
            RenderError: the picture could not be drawn, or the process died.
        """
        if not self.has_image(wait):
            return None
        message, fault = self._done.popleft()
        if fault:
            raise (NoRendererError if self._process.fault else RenderError)(fault)
        return self._content(message[2], Wants(*message[3]))

    def has_image(self, wait: bool) -> bool:
        """Tell whether a picture is finished; with `wait`, wait for a pending one."""
        while not self._done and self._requested:
            if not self._process.receive(wait) and not wait:
                return False
        return bool(self._done)

    def complete(self, fault: str) -> None:
        """Record that the oldest picture is finished, or its fault."""
        self._done.append((self._requested.popleft(), fault))

    def resend(self) -> None:
        """Repeat pending requests to a new process."""
        for message in tuple(self._requested):
            self._process.request(message)

    def fail(self, fault: str) -> None:
        """Fail all pending requests."""
        while self._requested:
            self.complete(fault)

    def _content(self, place: int, wanted: Wants) -> Content:
        lens = self.lens
        shape = lens.height, lens.width
        pixels = depths = jpeg = None
        if wanted.pixels:
            content = self.memory[place : place + lens.colour_bytes]
            wide = lens.encoding.endswith('16')
            pixels = np.frombuffer(content, '<u2' if wide else 'u1').reshape(*shape, -1)
        place += lens.colour_bytes
        if wanted.depths:
            depths = np.frombuffer(self.memory[place : place + lens.depth_bytes], 'f4').reshape(
                shape
            )
        place += lens.depth_bytes
        if wanted.jpeg:
            (size,) = struct.unpack_from('<I', self.memory, place)
            jpeg = self.memory[place + 4 : place + 4 + size]
        return pixels, depths, jpeg
