"""What a window shows, to ROS messages and back: JSON for the scene, numbers for the motion.

A window is of the same version as its simulator, so nothing is checked.
"""

import json
from dataclasses import asdict
from typing import Any

from std_msgs.msg import Float64MultiArray, String

from ...sim.core import Pose
from ...sim.description import (
    Box,
    Cylinder,
    Geometry,
    LightSpec,
    Material,
    Mesh,
    Plane,
    Reflection,
    SceneChange,
    SceneSpec,
    ShownLink,
    ShownModel,
    ShownMotion,
    Sphere,
    Visual,
)

_SHAPES = {kind.__name__: kind for kind in (Box, Cylinder, Mesh, Plane, Sphere)}
_CLOCK, _LINK = 4, 8  # numbers of the clock, and of each link


def scene_message(change: SceneChange) -> String:
    """Return a change of the scene as JSON."""
    return String(json.dumps(asdict(change) | {'models': [_model(m) for m in change.models]}))


def scene_change(message: String) -> SceneChange:
    """Return the change that `scene_message` was made of."""
    values = json.loads(message.data)
    return SceneChange(**values | {
        'models': tuple(map(_read_model, values['models'])),
        'removed': tuple(values['removed']),
        'lights': {name: LightSpec(**_tuples(light) | {'pose': _read_pose(light['pose'])})
                   for name, light in values['lights'].items()},
        'scene': SceneSpec(**_tuples(values['scene']))})


def motion_message(motion: ShownMotion) -> Float64MultiArray:
    """Return a motion as numbers: the clock, then number, position, quaternion of each link."""
    data = [motion.time, motion.real_time, float(motion.iterations), float(motion.paused)]
    for number, pose in motion.poses.items():
        data += (number, *pose.position, *pose.orientation)
    return Float64MultiArray(data=data)


def read_motion(message: Float64MultiArray) -> ShownMotion:
    """Return the motion that `motion_message` was made of."""
    time, real_time, iterations, paused = message.data[:_CLOCK]
    poses = {}
    for start in range(_CLOCK, len(message.data), _LINK):
        number, x, y, z, qx, qy, qz, qw = message.data[start:start + _LINK]
        poses[int(number)] = Pose((x, y, z), (qx, qy, qz, qw))
    return ShownMotion(time, real_time, int(iterations), bool(paused), poses)


def _model(model: ShownModel) -> dict[str, Any]:
    values = asdict(model)
    for link, shown in zip(values['links'], model.links, strict=True):
        for visual, spec in zip(link['visuals'], shown.visuals, strict=True):
            visual['geometry']['type'] = type(spec.geometry).__name__
    return values


def _read_model(values: dict[str, Any]) -> ShownModel:
    links = tuple(
        ShownLink(link['number'], link['name'], _read_pose(link['pose']),
                  tuple(map(_read_visual, link['visuals'])))
        for link in values['links'])
    return ShownModel(values['name'], links, tuple(values['joints']), values['static'],
                      _read_pose(values['canonical_pose']))


def _read_visual(values: dict[str, Any]) -> Visual:
    material = values['material'] and Material(
        **_tuples(values['material'])
        | {'reflection': Reflection(**_tuples(values['material']['reflection']))})
    return Visual(values['name'], _read_geometry(values['geometry']), _read_pose(values['pose']),
                  material)


def _read_geometry(values: dict[str, Any]) -> Geometry:
    return _SHAPES[values.pop('type')](**_tuples(values))


def _read_pose(values: list[list[float]]) -> Pose:
    (x, y, z), (qx, qy, qz, qw) = values
    return Pose((x, y, z), (qx, qy, qz, qw))


def _tuples(values: dict[str, Any]) -> dict[str, Any]:
    return {name: tuple(value) if isinstance(value, list) else value
            for name, value in values.items()}
