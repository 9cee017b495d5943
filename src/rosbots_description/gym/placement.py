"""Models are moved on level ground, to places where they overlap nothing."""

import math
from collections.abc import Collection

import numpy as np

from ..sim import Model, Pose, SimError, World, from_rpy, to_rpy

Place = tuple[float, float, float]  # x, y [m] and yaw [rad]
Range = tuple[float, float]
_TRIES = 1000  # places that are drawn until one is free


def move(model: Model, place: Place) -> None:
    """Move a model; height, roll and pitch stay."""
    (_, _, z), orientation = model.pose
    roll, pitch, _ = to_rpy(orientation)
    x, y, yaw = place
    model.set_pose(Pose((x, y, z), from_rpy(roll, pitch, yaw)))


def move_freely(
    world: World,
    model: Model,
    floor: Collection[str],
    random: np.random.Generator,
    xs: Range,
    ys: Range,
    yaws: Range = (-math.pi, math.pi),
) -> Place:
    """Move a model to a place, drawn uniformly, where it overlaps nothing; return the place.

    Args:
        floor: names of the models that it stands on.
        xs, ys: least and greatest x and y [m].
        yaws: least and greatest yaw [rad].
    Raises:
        SimError: no free place was found.
    """
    for _ in range(_TRIES):
        x, y, yaw = (float(random.uniform(*ends)) for ends in (xs, ys, yaws))
        move(model, (x, y, yaw))
        if world.overlaps(model).keys() <= set(floor):
            return x, y, yaw
    raise SimError(
        f"no place is free for model '{model.name}' between x {xs[0]:g} and {xs[1]:g} "
        f'and y {ys[0]:g} and {ys[1]:g} m; give it more room'
    )
