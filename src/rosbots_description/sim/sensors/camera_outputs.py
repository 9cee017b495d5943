"""What camera plugins send: pictures, calibration and point clouds, as the messages have them."""

from dataclasses import dataclass
from typing import Any

from numpy.typing import NDArray


@dataclass(frozen=True)
class CameraInfo:
    """Camera calibration, as in sensor_msgs/CameraInfo; matrices are row-major."""

    width: int
    height: int
    model: str
    distortion: tuple[float, ...]
    intrinsics: tuple[float, ...]  # (3, 3)
    rectification: tuple[float, ...]  # (3, 3)
    projection: tuple[float, ...]  # (3, 4)
    binning: tuple[int, int] = (0, 0)
    region: tuple[int, int, int, int, bool] = (0, 0, 0, 0, False)
    frame: str = ''


@dataclass(frozen=True)
class StampedInfo:
    """A `CameraInfo` and its time [ns]."""

    stamp_ns: int
    info: CameraInfo


@dataclass(frozen=True)
class Image:
    """Rows of pixels [bytes] at a time [ns]; encodings are those of sensor_msgs/Image."""

    stamp_ns: int
    frame: str
    width: int
    height: int
    encoding: str
    pixels: bytes


@dataclass(frozen=True)
class CompressedImage:
    """A JPEG file of an image at a time [ns]; formats are those of compressed_image_transport."""

    stamp_ns: int
    frame: str
    format: str
    data: bytes


@dataclass(frozen=True)
class Cloud:
    """Points in the optical frame, (height, width, 8) float32: x, y, z [m], 0, colour, 0, 0, 0.

    `is_dense`: none is NaN.
    """

    stamp_ns: int
    frame: str
    points: NDArray[Any]
    is_dense: bool
