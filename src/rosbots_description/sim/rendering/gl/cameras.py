"""View and projection matrices of cameras and shadow maps. Vectors are columns."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .values import Lens

# From the sensor's frame (x forward, y left, z up) to OpenGL's (x right, y up, z backward), with y
# flipped: row 0 of OpenGL's buffer is then the top of the picture.
_TO_CAMERA = np.array(
    [[0.0, -1.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0], [-1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
)
SHADOWED = 10.0  # [m] from the camera; no shadows beyond
WIDEST = 2.4  # [rad] horizontal; no shadows beyond in wider cameras
_CASTERS = 30.0  # [m] from the visible region towards the light: range of shadow casters


def matrices(poses: NDArray[Any]) -> NDArray[Any]:
    """Return transforms (n, 4, 4) of poses (n, 7): position [m], quaternion x, y, z, w."""
    x, y, z, w = poses[:, 3:].T
    result = np.zeros((len(poses), 4, 4))
    result[:, 0, 0] = 1.0 - 2.0 * (y * y + z * z)
    result[:, 0, 1] = 2.0 * (x * y - z * w)
    result[:, 0, 2] = 2.0 * (x * z + y * w)
    result[:, 1, 0] = 2.0 * (x * y + z * w)
    result[:, 1, 1] = 1.0 - 2.0 * (x * x + z * z)
    result[:, 1, 2] = 2.0 * (y * z - x * w)
    result[:, 2, 0] = 2.0 * (x * z - y * w)
    result[:, 2, 1] = 2.0 * (y * z + x * w)
    result[:, 2, 2] = 1.0 - 2.0 * (x * x + y * y)
    result[:, :3, 3] = poses[:, :3]
    result[:, 3, 3] = 1.0
    return result


def projection(lens: Lens) -> NDArray[Any]:
    """Return the projection matrix (4, 4) of a pinhole camera."""
    near, far = lens.near, lens.far
    across = 2.0 * lens.focal_length / lens.width
    upward = 2.0 * lens.focal_length / lens.height
    return np.array(
        [
            [across, 0.0, 0.0, 0.0],
            [0.0, upward, 0.0, 0.0],
            [0.0, 0.0, -(far + near) / (far - near), -2.0 * far * near / (far - near)],
            [0.0, 0.0, -1.0, 0.0],
        ]
    )


def camera_view(eye: NDArray[Any]) -> NDArray[Any]:
    """Return the view matrix (4, 4) of a camera with the transform `eye` (4, 4)."""
    turned = eye[:3, :3].T
    inverse = np.eye(4)
    inverse[:3, :3], inverse[:3, 3] = turned, -turned @ eye[:3, 3]
    return _TO_CAMERA @ inverse


def light_axes(direction: NDArray[Any]) -> NDArray[Any]:
    """Return the axes (3, 3) of a light that shines along `direction`: right, up, backward."""
    backward = -direction
    right = np.cross((0.0, 1.0, 0.0) if abs(backward[1]) < 0.9 else (1.0, 0.0, 0.0), backward)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(backward, right), backward])


def frustum_sphere(eye: NDArray[Any], lens: Lens) -> tuple[NDArray[Any], float]:
    """Return centre and radius of the bounding sphere of a camera's view up to SHADOWED [m]."""
    reach = min(lens.far, SHADOWED)
    slope = np.hypot(1.0, lens.height / lens.width) * np.tan(min(lens.field_of_view, WIDEST) / 2.0)
    # The circumsphere of the view pyramid, or of its base for wide views.
    middle = reach * min(1.0, (1.0 + slope**2) / 2.0)
    return eye[:3, 3] + middle * eye[:3, 0], max(middle, reach * slope)


def view_corners(eye: NDArray[Any], lens: Lens) -> NDArray[Any]:
    """Return five points (5, 3) [m] in whose convex hull lies all that a camera sees."""
    across = np.tan(lens.field_of_view / 2.0)
    upward = across * lens.height / lens.width
    ways = np.array([(1.0, y * across, z * upward) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
    return np.vstack([eye[:3, 3], eye[:3, 3] + lens.far * ways @ eye[:3, :3].T])


def box_reaches(arms: NDArray[Any], directions: NDArray[Any]) -> NDArray[Any]:
    """Return how far boxes reach from their middles along unit vectors (n, d) [m].

    Args:
        arms: from the middle of each to three of its sides, as columns (n, 3, 3) [m].
        directions: the unit vectors (d, 3).
    """
    return np.asarray(np.abs(directions @ arms).sum(axis=2))


def shadow_view(
    axes: NDArray[Any], middle: NDArray[Any], radius: float, texel: float
) -> NDArray[Any]:
    """Return the matrix from the world to a shadow map that covers a bounding sphere.

    The map's position is a multiple of its texel size [m], so that shadow edges do not flicker.
    """
    matrix = np.eye(4)
    matrix[:3, :3] = axes
    matrix[:3, 3] = -np.round(axes @ middle / texel) * texel
    low, high = -radius, radius + _CASTERS
    scale = np.diag([1.0 / radius, 1.0 / radius, -2.0 / (high - low), 1.0])
    scale[2, 3] = (high + low) / (high - low)
    return scale @ matrix
