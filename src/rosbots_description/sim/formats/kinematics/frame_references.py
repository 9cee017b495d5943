"""Transform what was posed in a reduced link's frame into the frame of its parent."""

from collections.abc import Mapping
from dataclasses import replace

from ...core import IDENTITY, Pose, as_vector, compose, from_rpy, parse_numbers, relative, to_rpy
from ...description import Element, SensorSpec


def move_part(element: Element, frame: Pose) -> Element:
    """Return a light or projector of a reduced link with its <pose> in the parent's frame.

    A pose with `relative_to` is unchanged.

    Args:
        frame: pose of the reduced link in its parent.
    """
    old = element.child('pose')
    if frame == IDENTITY or (old is not None and 'relative_to' in old.attributes):
        return element
    numbers = parse_numbers(old.text, 6) if old is not None else None
    own = Pose(as_vector(numbers[:3]), from_rpy(*numbers[3:])) if numbers else IDENTITY
    pose = compose(frame, own)
    text = _text((*pose.position, *to_rpy(pose.orientation)))
    moved = replace(old or Element('pose', line=element.line), text=text)
    others = tuple(child for child in element.children if child is not old)
    return replace(element, children=(moved, *others))


def move_sensor(
    sensor: SensorSpec, frame: Pose, parent: Pose, poses: Mapping[str, Pose]
) -> SensorSpec:
    """Return a sensor of a reduced link, posed in the parent's frame.

    Args:
        frame: where the reduced link stands in its parent.
        parent: where that stands in the model.
        poses: where links stand in the model, for a <pose> with `relative_to`; what is none of them
            is the model's own frame.
    """
    pose = sensor.element.child('pose')
    if pose is not None and 'relative_to' in pose.attributes:
        frame = relative(poses.get(pose.attributes['relative_to'], IDENTITY), parent)
    return replace(sensor, pose=compose(frame, sensor.pose))


def _text(values: tuple[float, ...]) -> str:
    # 0.0 + turns -0.0 into 0.0
    return ' '.join(f'{0.0 + value:.12g}' for value in values)
