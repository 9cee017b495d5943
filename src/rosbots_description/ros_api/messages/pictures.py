"""Messages with pictures to RGB pixels."""

import io

import numpy as np
from numpy.typing import NDArray
from PIL import Image as Decoder
from sensor_msgs.msg import CompressedImage, Image

from ...sim.core import SimError

GREATEST = 640  # pixels of a shown picture's longer side; others are left out evenly
# Bytes or numbers of a pixel, and which of them are red, green and blue.
_RGB, _BGR, _GREY = (0, 1, 2), (2, 1, 0), (0, 0, 0)
_ENCODINGS = {
    'rgb8': ('u1', 3, _RGB), 'rgba8': ('u1', 4, _RGB), '8UC3': ('u1', 3, _BGR),
    'bgr8': ('u1', 3, _BGR), 'bgra8': ('u1', 4, _BGR), '8UC4': ('u1', 4, _BGR),
    'mono8': ('u1', 1, _GREY), '8UC1': ('u1', 1, _GREY),
    'mono16': ('u2', 1, _GREY), '16UC1': ('u2', 1, _GREY), '32FC1': ('f4', 1, _GREY),
}


def pixels(message: Image) -> NDArray[np.uint8]:
    """Return a picture (height, width, 3), RGB; numbers other than bytes from black to white.

    Raises:
        SimError: its encoding is not known, or it has fewer bytes than its size says.
    """
    if message.encoding not in _ENCODINGS:
        raise SimError(f"its encoding '{message.encoding}' is not shown; "
                       f'those that are: {", ".join(_ENCODINGS)}')
    name, channels, order = _ENCODINGS[message.encoding]
    kind = np.dtype(('>' if message.is_bigendian else '<') + name)
    height, width = message.height, message.width
    row = width * channels * kind.itemsize
    if not height * width or message.step < row or len(message.data) < height * message.step:
        raise SimError(f'its {len(message.data)} bytes are no picture of {width} x {height} pixels '
                       f'of {row // width if width else 0} bytes, {message.step} in each row')
    rows = np.frombuffer(message.data, np.uint8, height * message.step).reshape(height, -1)
    stride = _stride(height, width)
    values = np.ascontiguousarray(rows[::stride, :row]).view(kind)
    values = values.reshape(len(values), width, channels)[:, ::stride]
    return (values if name == 'u1' else _bytes(values))[:, :, order]


def decompressed(message: CompressedImage) -> NDArray[np.uint8]:
    """Return a picture (height, width, 3), RGB.

    Raises:
        SimError: it cannot be decoded.
    """
    try:
        with Decoder.open(io.BytesIO(message.data), formats=('JPEG', 'PNG')) as picture:
            found = np.asarray(picture.convert('RGB'))
    except (OSError, ValueError, SyntaxError, Decoder.DecompressionBombError) as error:
        raise SimError(f"its format '{message.format}' cannot be decoded; JPEG and PNG can"
                       ) from error
    stride = _stride(*found.shape[:2])
    return found[::stride, ::stride]


def _stride(height: int, width: int) -> int:
    return -(-max(height, width) // GREATEST)


def _bytes(values: NDArray[np.generic]) -> NDArray[np.uint8]:
    """Return numbers from 0, black, to the greatest, white; those that are not finite black."""
    numbers = np.nan_to_num(values.astype(np.float32), nan=0.0, posinf=0.0, neginf=0.0)
    return (255.0 * numbers.clip(0.0) / max(float(numbers.max()), 1e-6)).astype(np.uint8)
