"""Serializers of readings that are published often: `serializer` of `Publishes`."""

import logging
from typing import Any

from ...sim.runtime import FrameTransform, JointStates
from ..messages import JointStatesLayout, OdometryLayout, TransformLayout
from ..server import from_root
from .adapter import Adapter
from .declarations import Serializer

logger = logging.getLogger(__name__)


def odometry_serializer(adapter: Adapter) -> Serializer:
    """Return what lays the odometry of a drive out."""
    plugin: Any = adapter.plugin  # one that has variances, as those have that give odometry out
    parent, child = (
        adapter.frame(plugin.params.string(tag)) for tag in ('odometryFrame', 'robotBaseFrame')
    )
    return OdometryLayout(parent, child, plugin.pose_variances, plugin.twist_variances).pack


class TransformSerializer:
    """Lays transforms out; how each is laid out stays, once its frames are known."""

    def __init__(self, adapter: Adapter) -> None:
        self.adapter = adapter
        self._layouts: dict[tuple[str, str], TransformLayout] = {}  # by parent and child
        self._frames = adapter.server.static_frames
        adapter.tf_prefix  # noqa: B018  ask for it now: this thread may wait for the master

    def moved(self, edge: FrameTransform) -> FrameTransform:
        """Return the transform to publish in place of `edge`, while others hold frames still."""
        return edge

    def __call__(self, _number: int, now_ns: int, edge: FrameTransform) -> bytes:
        """Return a message with one transform."""
        parent, child, pose = self.moved(edge) if self._frames.parents else edge
        layout = self._layouts.get((parent, child))
        if layout is None:
            frames = self.adapter.frame(parent), self.adapter.frame(child)
            layout = self._layouts[parent, child] = TransformLayout(*frames)
        return layout.pack(now_ns, pose)


class RootedTransformSerializer(TransformSerializer):
    """Moves what another node holds together by its root, in place of the robot's frame."""

    _logged = ''  # said once, not with every message

    def moved(self, edge: FrameTransform) -> FrameTransform:
        """Return the transform of the root."""
        frame = self.adapter.frame
        named = FrameTransform(frame(edge.parent), frame(edge.child), edge.pose)
        moved = from_root(named, self._frames.parents)
        if moved is named:
            return edge
        self._warn_replaced(named, moved)
        return FrameTransform(f'/{moved.parent}', f'/{moved.child}', moved.pose)

    def _warn_replaced(self, edge: FrameTransform, moved: FrameTransform) -> None:
        if self._logged != moved.child:
            self._logged = moved.child
            logger.debug(
                '%sanother node publishes a static transform to %s from %s, so %s -> %s is '
                'published instead of %s -> %s: a TF frame has one parent',
                self.adapter.plugin.log_prefix,
                edge.child,
                moved.child,
                moved.parent,
                moved.child,
                edge.parent,
                edge.child,
            )


class JointStatesSerializer:
    """Lays joint states out; the names of the first ones stay."""

    def __init__(self, _adapter: Adapter) -> None:
        self._layout: JointStatesLayout | None = None

    def __call__(self, number: int, now_ns: int, reading: JointStates) -> bytes:
        """Return the message."""
        if self._layout is None:
            self._layout = JointStatesLayout(reading)
        return self._layout.pack(number, now_ns, reading)
