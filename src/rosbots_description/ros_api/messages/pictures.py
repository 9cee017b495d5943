"""Messages with pictures to RGB pixels."""

import io

import numpy as np
from numpy.typing import NDArray
from PIL import Image as Decoder
from sensor_msgs.msg import CompressedImage, Image

from ...sim.core import SimError
from ...sim.sensors import ENCODINGS, picture_stride, shown_picture


def pixels(message: Image) -> NDArray[np.uint8]:
    """Return a picture (height, width, 3), RGB; numbers other than bytes from black to white.

    Raises:
        SimError: its encoding is not known, or it has fewer bytes than its size says.
    """
    if message.encoding not in ENCODINGS:
        raise SimError(
            f"its encoding '{message.encoding}' is not shown; "
            f'those that are: {", ".join(ENCODINGS)}'
        )
    name, channels, _ = ENCODINGS[message.encoding]
    kind = np.dtype(('>' if message.is_bigendian else '<') + name)
    height, width = message.height, message.width
    row = width * channels * kind.itemsize
    if not height * width or message.step < row or len(message.data) < height * message.step:
        raise SimError(
            f'its {len(message.data)} bytes are no picture of {width} x {height} pixels '
            f'of {row // width if width else 0} bytes, {message.step} in each row'
        )
    rows = np.frombuffer(message.data, np.uint8, height * message.step).reshape(height, -1)
    values = np.ascontiguousarray(rows[:, :row]).view(kind).reshape(height, width, channels)
    return shown_picture(values, message.encoding)


def decompressed(message: CompressedImage) -> NDArray[np.uint8]:
    """Return a picture (height, width, 3), RGB.

    Raises:
        SimError: it cannot be decoded.
    """
    try:
        with Decoder.open(io.BytesIO(message.data), formats=('JPEG', 'PNG')) as picture:
            found = np.asarray(picture.convert('RGB'))
    except (OSError, ValueError, SyntaxError, Decoder.DecompressionBombError) as error:
        raise SimError(
            f"its format '{message.format}' cannot be decoded; JPEG and PNG can"
        ) from error
    stride = picture_stride(*found.shape[:2])
    return found[::stride, ::stride]
