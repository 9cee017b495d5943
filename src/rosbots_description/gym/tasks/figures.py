"""What pictures of the tasks show besides the world: goals, and squares on the ground."""

from ...sim import Pose
from ...sim.description import Box, Cylinder, Material, Visual
from ...sim.rendering import Figure

_GOAL, _VISITED = (0.1, 0.75, 0.2), (0.1, 0.45, 0.9)  # red, green, blue
_THIN = 0.006  # [m]
_POLE = 0.02, 0.8  # [m] radius and height


def goal(x: float, y: float, radius: float) -> tuple[Figure, ...]:
    """Return a disc on the ground at x, y [m] with a pole in its middle."""
    pole_radius, height = _POLE
    disc = Visual('goal', Cylinder(radius, _THIN), material=Material.plain((*_GOAL, 0.5)))
    pole = Visual('pole', Cylinder(pole_radius, height), material=Material.plain((*_GOAL, 1.0)))
    return Figure(disc, Pose((x, y, _THIN))), Figure(pole, Pose((x, y, height / 2.0)))


def square(x: float, y: float, edge: float) -> Figure:
    """Return a square on the ground with its middle at x, y [m]."""
    visual = Visual('square', Box((edge, edge, _THIN)), material=Material.plain((*_VISITED, 0.3)))
    return Figure(visual, Pose((x, y, _THIN)), in_view=False)
