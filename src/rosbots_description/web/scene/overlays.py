"""Overlays of a link: its frame, joint axes, collision shapes, centre of mass and inertia."""

import math
from collections.abc import Callable, Mapping

import numpy as np
import viser

from ...sim.core import ModelError, Pose, Vector, add, as_vector
from ...sim.description import Inertial, Material, Plane, ShownLink, ShownModel, Visual
from ...sim.description.inertia import principal_axes
from ...sim.rendering import visual_gltf
from .nodes import wxyz

COLLISION = Material.plain((1.0, 0.55, 0.0, 0.5))
CENTRE, INERTIA, AXIS = (255, 210, 0), (190, 60, 220), (0, 150, 160)
FRAME_LENGTH = 0.15  # of the axes of a frame [m]
AXIS_LENGTH = 0.25  # of the arrow along the axis of a joint [m]
LEAD = 11340.0  # density [kg/m^3] of a ball as heavy as the link, which marks its centre of mass

# Adds nodes to the scene below a path, which is that of the link's node.
Overlay = Callable[[viser.SceneApi, str, ShownModel, ShownLink], None]


def frame(scene: viser.SceneApi, path: str, _model: ShownModel, _link: ShownLink) -> None:
    """Show the axes of a link's frame: x red, y green, z blue."""
    scene.add_frame(path, axes_length=FRAME_LENGTH, axes_radius=FRAME_LENGTH / 30.0)


def collisions(scene: viser.SceneApi, path: str, _model: ShownModel, link: ShownLink) -> None:
    """Show the collision shapes, but for infinite planes."""
    if link.collisions:
        scene.add_frame(path, show_axes=False)
    for number, one in enumerate(link.collisions):
        if isinstance(one.geometry, Plane):
            continue
        try:
            content = visual_gltf(Visual(one.name, one.geometry, material=COLLISION))
        except ModelError:  # its mesh was removed meanwhile
            continue
        scene.add_glb(
            f'{path}/{number}',
            content,
            cast_shadow=False,
            receive_shadow=False,
            position=one.pose.position,
            wxyz=wxyz(one.pose),
        )


def centre_of_mass(scene: viser.SceneApi, path: str, model: ShownModel, link: ShownLink) -> None:
    """Show the centre of mass as a ball of lead of the link's mass."""
    if link.inertial is not None and not model.static:
        radius = (3.0 * link.inertial.mass / (4.0 * math.pi * LEAD)) ** (1.0 / 3.0)
        scene.add_icosphere(
            path, radius, CENTRE, position=link.inertial.pose.position, cast_shadow=False
        )


def inertia(scene: viser.SceneApi, path: str, model: ShownModel, link: ShownLink) -> None:
    """Show a box of uniform density with the mass and the inertia of the link."""
    if link.inertial is not None and not model.static:
        size, orientation = equal_box(link.inertial)
        pose = Pose(link.inertial.pose.position, orientation)
        scene.add_box(
            path,
            INERTIA,
            size,
            opacity=0.5,
            position=pose.position,
            wxyz=wxyz(pose),
            cast_shadow=False,
            receive_shadow=False,
        )


def joint_axes(scene: viser.SceneApi, path: str, model: ShownModel, link: ShownLink) -> None:
    """Show the axes of the joints whose child is the link."""
    arrows = []
    for joint in model.joints:
        if joint.child == link.name:
            start = joint.pose.position
            along = as_vector(AXIS_LENGTH * part for part in joint.axis_in_child)
            arrows.append((start, add(start, along)))
    if arrows:
        scene.add_arrows(
            path,
            np.array(arrows),
            AXIS,
            shaft_radius=AXIS_LENGTH / 40.0,
            head_radius=AXIS_LENGTH / 16.0,
            head_length=AXIS_LENGTH / 6.0,
        )


def equal_box(inertial: Inertial) -> tuple[Vector, tuple[float, float, float, float]]:
    """Return size [m] and orientation, in the link, of the box of equal mass and inertia.

    Its moments are m / 12 (y^2 + z^2), and so on.
    """
    (a, b, c), orientation = principal_axes(inertial)
    x, y, z = (
        math.sqrt(max(6.0 * twice / inertial.mass, 0.0))
        for twice in (b + c - a, a + c - b, a + b - c)
    )
    return (x, y, z), orientation


OVERLAYS: Mapping[str, Overlay] = {
    'Frames': frame,
    'Joint axes': joint_axes,
    'Collision shapes': collisions,
    'Centres of mass': centre_of_mass,
    'Inertias': inertia,
}
