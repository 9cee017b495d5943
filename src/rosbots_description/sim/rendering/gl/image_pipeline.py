"""Camera effects: distortion, noise and pixel encoding."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from .values import BAYER, BGR, GREY8, GREY16, RGB16, Lens


class ImagePipeline:
    """Converts drawn pixels to the picture of one camera."""

    def __init__(self, lens: Lens) -> None:
        self._lens = lens
        self._distortion = _Distortion(lens) if any(lens.distortion) else None

    def finish(self, pixels: NDArray[Any], seed: int) -> NDArray[Any]:
        """Return the picture in the camera's encoding.

        Args:
            pixels: (height, width, 4) uint8.
            seed: of the noise.
        """
        lens = self._lens
        if self._distortion is not None:
            pixels = self._distortion.apply(pixels)
        if lens.noise_stddev or lens.noise_mean:
            pixels = _with_noise(pixels, lens, seed)
        if lens.encoding == BGR:
            return _packed(pixels, 'BGR')
        if lens.encoding == GREY8:  # as Gazebo: the red channel
            return np.ascontiguousarray(pixels[:, :, 0])
        if lens.encoding == GREY16:
            return np.asarray(np.multiply(pixels[:, :, 0], 257, dtype='<u2'))
        if lens.encoding == RGB16:
            return np.asarray(np.multiply(pixels[:, :, :3], 257, dtype='<u2'))
        if lens.encoding in BAYER:
            return _mosaic(pixels, BAYER[lens.encoding])
        return _packed(pixels, 'RGB')


def _packed(pixels: NDArray[Any], order: str) -> NDArray[Any]:
    """Return pixels without their fourth channel, which Pillow does ten times as fast as numpy."""
    height, width, channels = pixels.shape
    if channels == 4:
        image = Image.frombuffer('RGBX', (width, height), pixels, 'raw', 'RGBX', 0, 1)
        return np.frombuffer(image.tobytes('raw', order), 'u1').reshape(height, width, 3)
    return pixels if order == 'RGB' else np.ascontiguousarray(pixels[:, :, ::-1])


def _mosaic(pixels: NDArray[Any], channels: tuple[int, int, int, int]) -> NDArray[Any]:
    result = np.empty(pixels.shape[:2], 'u1')
    for number, channel in enumerate(channels):
        row, column = divmod(number, 2)
        result[row::2, column::2] = pixels[row::2, column::2, channel]
    return result


def _with_noise(pixels: NDArray[Any], lens: Lens, seed: int) -> NDArray[Any]:
    """Add the same noise to all channels of a pixel, as in Gazebo."""
    generator = np.random.Generator(np.random.Philox(seed))
    shape = pixels.shape[:2]
    added = generator.standard_normal(shape, 'f4') * np.float32(255.0 * lens.noise_stddev)
    noisy = pixels[:, :, :3] + (added + np.float32(255.0 * lens.noise_mean))[:, :, None]
    return np.asarray(np.clip(np.rint(noisy), 0.0, 255.0), 'u1')


class _Distortion:
    """Lookup from distorted pixels to the pinhole picture, by the inverse of Brown's model.

    As in Gazebo, coordinates are normalised by the picture's width and height.
    """

    def __init__(self, lens: Lens) -> None:
        self._coefficients = lens.distortion
        centre = np.array(lens.centre)[:, None, None]
        seen = np.stack(
            np.meshgrid(
                (np.arange(lens.width) + 0.5) / lens.width,
                (np.arange(lens.height) + 0.5) / lens.height,
            )
        )
        if lens.crop:
            low, high = (
                self._shown(corner - centre)[:, 0, 0]
                for corner in (np.zeros((2, 1, 1)), np.ones((2, 1, 1)))
            )
            seen = 0.5 + (seen - 0.5) * (high - low)[:, None, None]
        sources = centre + self._inverse(seen - centre)
        self._outside = ((sources < 0.0) | (sources >= 1.0) | ~np.isfinite(sources)).any(axis=0)
        size = np.array([lens.width, lens.height])[:, None, None]
        places = np.where(self._outside, 0.0, np.clip(sources * size - 0.5, 0.0, size - 1.0))
        first = np.minimum(places.astype(int), np.maximum(size - 2, 0))
        self._corners = [
            tuple(np.minimum(first + step, size - 1)[::-1])
            for step in (
                np.array(corner)[:, None, None] for corner in ((0, 0), (1, 0), (0, 1), (1, 1))
            )
        ]
        right, down = (places - first).astype('f4')
        self._shares = [
            share[:, :, None]
            for share in (
                (1 - right) * (1 - down),
                right * (1 - down),
                (1 - right) * down,
                right * down,
            )
        ]

    def apply(self, pixels: NDArray[Any]) -> NDArray[Any]:
        """Return the distorted picture (height, width, 4) of a pinhole picture."""
        read = sum(
            share * pixels[corner]
            for share, corner in zip(self._shares, self._corners, strict=True)
        )
        result: NDArray[Any] = np.rint(read).astype('u1')
        result[self._outside] = pixels[0, 0] // 4  # as Gazebo: its sample there is 3/4 black border
        return result

    def _inverse(self, shown: NDArray[Any]) -> NDArray[Any]:
        """Return the undistorted points, by fixed-point iteration."""
        points: NDArray[Any] = shown.copy()
        with np.errstate(all='ignore'):  # points far outside may have no solution
            for _ in range(50):
                radial, tangential = self._terms(points)
                points = (shown - tangential) / radial
        return points

    def _shown(self, points: NDArray[Any]) -> NDArray[Any]:
        radial, tangential = self._terms(points)
        return np.asarray(points * radial + tangential)

    def _terms(self, points: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
        k1, k2, k3, p1, p2 = self._coefficients
        x, y = points
        square = x * x + y * y
        radial = 1.0 + square * (k1 + square * (k2 + square * k3))
        return radial, np.stack(
            [
                p2 * (square + 2.0 * x * x) + 2.0 * p1 * x * y,
                p1 * (square + 2.0 * y * y) + 2.0 * p2 * x * y,
            ]
        )
