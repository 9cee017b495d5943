"""Compressed images: JPEG files."""

import io
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from .values import BGR

JPEG_QUALITY = 80  # as image_transport's default


def jpeg_file(picture: NDArray[Any], encoding: str) -> bytes:
    """Return a picture in its encoding as a JPEG file, grey or in colours, of 8 bits."""
    if picture.dtype != np.uint8:
        picture = (picture >> 8).astype('u1')
    if encoding == BGR:
        picture = picture[:, :, ::-1]
    file = io.BytesIO()
    Image.fromarray(picture).save(file, 'JPEG', quality=JPEG_QUALITY)
    return file.getvalue()
