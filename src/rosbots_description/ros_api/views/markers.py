"""Visuals as RViz markers: one marker per visual, in the frame `world`."""

from pathlib import Path

from geometry_msgs.msg import Point, Vector3
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker

from ...sim.core import Pose, compose
from ...sim.description import Box, Cylinder, Geometry, Material, Mesh, Plane, Sphere, Visual
from ..messages import fill_pose

FRAME = 'world'
# Two triangles, counter-clockwise seen from above.
_UNIT_SQUARE = ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))
NOTICE_HEIGHT, NOTICE_SIZE = 1.5, 0.4  # [m] of a notice: its centre, and a capital letter
# Ground is shown in a darker grey than its material, for contrast with models.
GROUND, GROUND_COLOUR = 'Gazebo/Grey', (0.5, 0.5, 0.5, 1.0)
PLANE_DEPTH = 0.001  # [m] a plane is drawn lower by this, so that a grid stays visible


def visual_marker(namespace: str, number: int, visual: Visual) -> Marker:
    """Return the marker of a visual; its pose is set by `place`."""
    marker = Marker(ns=namespace, id=number, action=Marker.ADD)
    marker.header.frame_id = FRAME
    _shape(marker, visual.geometry)
    if isinstance(visual.geometry, Mesh) and visual.material is None:
        marker.mesh_use_embedded_materials = True  # a zero colour means no tint
    else:
        material = visual.material or Material()
        is_ground = isinstance(visual.geometry, Plane) and material.script == GROUND
        marker.color = ColorRGBA(*(GROUND_COLOUR if is_ground else material.rgba))
    # RViz's light is at the camera, which leaves wide ground dark; points with colours of their own
    # are drawn without lighting.
    marker.colors = [marker.color] * len(marker.points)
    return marker


def use_sunlit(marker: Marker, file: str) -> None:
    """Let a marker show a file of `SunlitMeshes`, which includes the colours."""
    marker.type, marker.mesh_resource = Marker.MESH_RESOURCE, Path(file).as_uri()
    marker.mesh_use_embedded_materials, marker.color = True, ColorRGBA()  # zero: no tint


def place_marker(marker: Marker, link_pose: Pose, visual: Visual) -> None:
    """Set the pose of a marker for its link's pose in the world."""
    pose = compose(link_pose, visual.pose)
    if isinstance(visual.geometry, Plane):
        pose = compose(pose, Pose((0.0, 0.0, -PLANE_DEPTH)))
    fill_pose(marker.pose, pose)


def removal(marker: Marker) -> Marker:
    """Return the marker that deletes `marker`."""
    return Marker(header=marker.header, ns=marker.ns, id=marker.id, action=Marker.DELETE)


def clearance() -> Marker:
    """Return the marker that deletes all markers."""
    marker = Marker(action=Marker.DELETEALL)
    marker.header.frame_id = FRAME
    return marker


def notice(text: str) -> Marker:
    """Return a text above the origin that faces the camera."""
    marker = Marker(ns='notice', type=Marker.TEXT_VIEW_FACING, action=Marker.ADD, text=text)
    marker.header.frame_id = FRAME
    marker.pose.position.z, marker.pose.orientation.w = NOTICE_HEIGHT, 1.0
    marker.scale.z, marker.color = NOTICE_SIZE, ColorRGBA(0.8, 0.1, 0.1, 1.0)
    return marker


def _shape(marker: Marker, geometry: Geometry) -> None:
    match geometry:
        case Box(size):
            marker.type, marker.scale = Marker.CUBE, Vector3(*size)
        case Sphere(radius):
            marker.type, marker.scale = Marker.SPHERE, Vector3(*[2.0 * radius] * 3)
        case Cylinder(radius, length):
            marker.type = Marker.CYLINDER
            marker.scale = Vector3(2.0 * radius, 2.0 * radius, length)
        case Plane(_, (width, depth)):
            marker.type, marker.scale = Marker.TRIANGLE_LIST, Vector3(width, depth, 1.0)
            marker.points = [Point(x, y, 0.0) for x, y in _UNIT_SQUARE]
        case Mesh(path, scale):
            marker.type, marker.scale = Marker.MESH_RESOURCE, Vector3(*scale)
            marker.mesh_resource = Path(path).as_uri()
