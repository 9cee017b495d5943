"""Nodes of viser's scene: their names, and their poses."""

import numpy as np
import viser

from ...sim.core import Pose

MODELS = '/models'  # the node of all models
STILL = 1e-6  # [m, and of a quaternion] what nobody sees


def model_node(model: str) -> str:
    """Return the name of the node of a model."""
    return f'{MODELS}/{node(model)}'


def link_node(model: str, link: str) -> str:
    """Return the name of the node of a link, which is the frame of all that moves with it."""
    return f'{model_node(model)}/{node(link)}'


def node(name: str) -> str:
    """Return a name as one level of viser's scene tree, in which / separates levels."""
    return name.replace('/', '\u2215') or ' '


def wxyz(pose: Pose) -> tuple[float, float, float, float]:
    """Return an orientation in viser's order."""
    x, y, z, w = pose.orientation
    return w, x, y, z


def place(frame: viser.SceneNodeHandle, pose: Pose) -> None:
    """Move a node, if anybody would see it."""
    orientation = wxyz(pose)
    if np.abs(np.subtract(frame.position, pose.position)).max() > STILL:
        frame.position = pose.position
    if np.abs(np.subtract(frame.wxyz, orientation)).max() > STILL:
        frame.wxyz = orientation


def pose_of(frame: viser.SceneNodeHandle) -> Pose:
    """Return the pose of a node."""
    w, x, y, z = frame.wxyz
    return Pose(tuple(frame.position), (x, y, z, w))
