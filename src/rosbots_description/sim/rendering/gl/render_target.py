"""Where a picture is drawn, and read back."""

from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray


class RenderTarget:
    """The framebuffers of a camera's picture."""

    def __init__(
        self, context: moderngl.Context, width: int, height: int, kind: str, samples: int
    ) -> None:
        size = width, height
        self._context, self._samples = context, samples
        self._form = ('f4', 1) if kind == 'depth' else ('f1', 4)
        dtype, channels = self._form
        self._plain = context.framebuffer(
            [context.renderbuffer(size, channels, dtype=dtype)],
            None if samples else context.depth_renderbuffer(size),
        )
        self._drawn = (
            context.framebuffer(
                [context.renderbuffer(size, channels, samples=samples)],
                context.depth_renderbuffer(size, samples=samples),
            )
            if samples
            else self._plain
        )
        self._pixels = np.empty(
            (height, width) if channels == 1 else (height, width, channels),
            'f4' if dtype == 'f4' else 'u1',
        )

    def use(self) -> None:
        """Bind it for drawing."""
        self._drawn.use()

    def read(self) -> NDArray[Any]:
        """Return what was drawn; it is overwritten by the next picture."""
        dtype, channels = self._form
        if self._samples:
            self._context.copy_framebuffer(self._plain, self._drawn)
        self._plain.read_into(self._pixels, components=channels, dtype=dtype)
        return self._pixels
