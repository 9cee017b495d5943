"""Trees of TF frames."""

from collections.abc import Iterator, Mapping

from tf2_msgs.msg import TFMessage

from ...sim.core import IDENTITY, Pose, compose
from .conversions import read_transform

Parents = Mapping[str, tuple[str, Pose]]  # by frame: its parent, and its pose in the parent


def read_transforms(message: TFMessage) -> dict[str, tuple[str, Pose]]:
    """Return the transforms of a message by child; invalid ones are left out, as in TF."""
    found = {}
    for edge in message.transforms:
        try:
            pose = read_transform(edge.transform)
        except ValueError:
            continue
        found[edge.child_frame_id.lstrip('/')] = edge.header.frame_id.lstrip('/'), pose
    return found


def frames_above(frame: str, parents: Parents) -> Iterator[tuple[str, Pose]]:
    """Yield a frame and those above it, the nearest first, with its pose in each."""
    above, pose, seen = frame, IDENTITY, set[str]()
    while above not in seen:
        yield above, pose
        seen.add(above)
        if above in parents:
            above, edge = parents[above]
            pose = compose(edge, pose)
