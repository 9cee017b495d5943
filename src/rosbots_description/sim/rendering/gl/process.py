"""The rendering process: it keeps a scene and answers requests until its connection is closed."""

import contextlib
import mmap
import os
import signal
import socket
import struct
from itertools import starmap
from multiprocessing.connection import Connection
from typing import Any

import numpy as np
from PIL import Image

from .context import NoContextError, open_context
from .image_pipeline import ImagePipeline
from .jpeg import jpeg_file
from .renderer import Renderer
from .values import Appearance, Lens, Light, Scene, ScenePart, Wants

MAX_IMAGE_SIZE = 2048  # [pixels] along an edge; larger ones are scaled down
NICENESS = 2  # the simulation has priority


def main(handle: int) -> None:
    """Serve the socket `handle` until its other end is closed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent handles it and closes the socket
    os.nice(NICENESS)
    connection: Connection[Any, Any] = Connection(handle)
    try:
        context, name, is_software = open_context()
    except NoContextError as error:
        connection.send(('failed', str(error)))
        return
    connection.send(('ready', name, is_software))
    with contextlib.suppress(EOFError, ConnectionError):
        _Service(connection, Renderer(context)).run()


class _Service:
    """Executes messages, each a tuple of a verb and its arguments."""

    def __init__(self, connection: 'Connection[Any, Any]', renderer: Renderer) -> None:
        self._connection = connection
        self._renderer = renderer
        self._cameras: dict[int, _Camera] = {}

    def run(self) -> None:
        """Serve until the connection ends."""
        while True:
            verb, *arguments = self._connection.recv()
            getattr(self, f'_{verb}')(*arguments)

    def _mesh(self, key: str, triangles: bytes) -> None:
        self._renderer.add_mesh(key, np.frombuffer(triangles, 'f4').reshape(-1, 8))

    def _image(self, path: str) -> None:
        """Load an image file; white if it cannot be read."""
        pixels = np.full((1, 1, 3), 255, 'u1')
        with contextlib.suppress(Exception), Image.open(path) as image:  # any error of the decoder
            image.thumbnail((MAX_IMAGE_SIZE, MAX_IMAGE_SIZE))
            pixels = np.asarray(image.convert('RGBA' if 'A' in image.getbands() else 'RGB'))
        self._renderer.add_image(path, pixels)

    def _scene(self, parts: list[Any], lights: list[Any], *others: Any) -> None:
        """Set the scene; `others` are the further fields of a `Scene`."""
        made = (
            ScenePart(key, body, matrix, Appearance(*appearance), *flags)
            for key, body, matrix, appearance, *flags in parts
        )
        self._renderer.set_scene(Scene(tuple(made), tuple(starmap(Light, lights)), *others))

    def _camera(self, number: int, lens: tuple[Any, ...], size: int) -> None:
        """Add a camera with the shared memory sent along."""
        stream = socket.socket(fileno=os.dup(self._connection.fileno()))
        with stream:
            _, (file, *_), _, _ = socket.recv_fds(stream, 1, 1)
        self._cameras[number] = _Camera(Lens(*lens), mmap.mmap(file, size))
        os.close(file)

    def _forget(self, number: int) -> None:
        self._cameras.pop(number).memory.close()

    def _picture(
        self,
        number: int,
        place: int,
        wants: tuple[bool, ...],
        seed: int,
        eye: bytes,
        poses: bytes,
    ) -> None:
        """Write a picture to the camera's memory at offset `place`, and answer."""
        camera, wanted = self._cameras[number], Wants(*wants)
        lens = camera.lens
        where, bodies = np.frombuffer(eye), np.frombuffer(poses).reshape(-1, 7)
        fault = ''
        try:
            if wanted.pixels or wanted.jpeg:
                pixels = self._renderer.colours(lens, where, bodies)
                content = camera.pipeline.finish(pixels, seed)
                if wanted.pixels:
                    camera.write(place, content.reshape(-1).view('u1').data)
                if wanted.jpeg:
                    file = jpeg_file(content, lens.encoding)
                    camera.write(
                        place + lens.colour_bytes + lens.depth_bytes,
                        struct.pack('<I', len(file)) + file,
                    )
            if wanted.depths:
                depths = self._renderer.depths(lens, where, bodies)
                camera.write(place + lens.colour_bytes, depths.reshape(-1).view('u1').data)
        except Exception as error:  # such as a picture too large for the driver
            fault = f'{type(error).__name__}: {error}'
        self._connection.send((number, fault))


class _Camera:
    """A lens, and the shared memory for its pictures."""

    def __init__(self, lens: Lens, memory: mmap.mmap) -> None:
        self.lens = lens
        self.memory = memory
        self.pipeline = ImagePipeline(lens)

    def write(self, place: int, content: 'bytes | memoryview') -> None:
        """Write to the shared memory at offset `place`."""
        self.memory[place : place + len(content)] = content
