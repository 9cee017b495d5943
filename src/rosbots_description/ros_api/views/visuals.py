"""The visuals of the world as markers for RViz; no cost without subscribers.

Publishes:
    ~visual_markers (visualization_msgs/MarkerArray, latched): all visuals for a new subscriber,
        then those that moved, were added or removed.
    ~view/markers (visualization_msgs/MarkerArray, latched): the same for gzclient, as mesh files
        on this machine, with baked sunlight.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from itertools import chain
from typing import Protocol

import rospy
from genpy import Message
from visualization_msgs.msg import Marker, MarkerArray

from ...sim.core import Pose
from ...sim.rendering import SunlitMeshes
from ...sim.runtime import NOTHING, Link, Model, World
from ..server import Server
from .markers import clearance, place_marker, removal, use_sunlit, visual_marker

PERIOD = 0.04  # time between two updates [s, wall]
# Updates between refreshes of all markers: RViz drops its markers when time jumps back.
REFRESH = 25


class LinkView:
    """The markers of one link."""

    def __init__(self, link: Link, files: Sequence[str | None] = ()) -> None:
        """Make the markers of a link, from the mesh files of its visuals where given."""
        self.link = link
        self._files = files  # references keep the files
        self.markers = [
            visual_marker(link.scoped_name, number, visual)
            for number, visual in enumerate(link.spec.visuals)
        ]
        for marker, file in zip(self.markers, files, strict=False):
            if file is not None:
                use_sunlit(marker, file)

    def placed(self, pose: Pose) -> list[Marker]:
        """Return the markers where the link is now."""
        for marker, visual in zip(self.markers, self.link.spec.visuals, strict=True):
            place_marker(marker, pose, visual)
        return self.markers


class ShownMarkers:
    """A reader of a world's changes: the markers of what was added, removed or moved."""

    def __init__(self, world: World) -> None:
        self._world = world
        self._views: dict[str, list[LinkView]] = {}  # by models
        self._awaited: dict[str, Future[list[LinkView]]] = {}  # likewise
        self._seen, self._updates = NOTHING, 0

    def reset(self) -> None:
        """Publish all at the next update, for a subscriber that may show another world."""
        self._seen = NOTHING

    def changes(self) -> list[Marker]:
        """Return the markers that changed since the last update."""
        is_first = self._seen is NOTHING
        changes = self._world.revisions.since(self._seen)
        self._seen = changes.revision
        markers, poses = [], changes.revision.poses
        if is_first:
            markers.append(clearance())
            self._views.clear()
            self._awaited.clear()
            self._updates = 0
        for name in changes.removed:
            self._awaited.pop(name, None)
            gone = self._views.pop(name, [])
            markers += [removal(marker) for view in gone for marker in view.markers]
        refresh = self._updates % REFRESH == 0
        self._updates += 1
        for view in chain.from_iterable(self._views.values()):
            if refresh or view.link in changes.moved:
                markers += view.placed(poses[view.link])
        self._awaited |= {model.name: self._make(model) for model in changes.added}
        for name in [name for name, made in self._awaited.items() if made.done()]:
            self._views[name] = self._awaited.pop(name).result()
            for view in self._views[name]:
                markers += view.placed(poses[view.link])
        return markers

    def _make(self, model: Model) -> Future[list[LinkView]]:
        """Begin to make the link views of a model."""
        made: Future[list[LinkView]] = Future()
        made.set_result([LinkView(link) for link in _shown_links(model)])
        return made


class SunlitMarkers(ShownMarkers):
    """Markers of each model once its mesh files are written, on another thread."""

    def __init__(self, world: World, meshes: SunlitMeshes, thread: Executor) -> None:
        super().__init__(world)
        self._meshes, self._thread = meshes, thread

    def _make(self, model: Model) -> Future[list[LinkView]]:
        return self._thread.submit(self._make_views, model)

    def _make_views(self, model: Model) -> list[LinkView]:
        return [
            LinkView(link, [self._meshes.file(visual) for visual in link.spec.visuals])
            for link in _shown_links(model)
        ]


def _shown_links(model: Model) -> list[Link]:
    return [link for link in model.links.values() if link.spec.visuals]


class IncrementalView(Protocol):
    """A view that publishes changes only."""

    def changes(self) -> Sequence[Message]:
        """Return what has changed since the last update."""

    def reset(self) -> None:
        """Publish everything at the next update."""


class Viewers(rospy.SubscribeListener):  # type: ignore[misc]  # rospy has no types
    """Lets a view publish everything for a new subscriber."""

    def __init__(self, server: Server, reset: Callable[[], None]) -> None:
        self._server, self._reset = server, reset

    def peer_subscribe(self, _topic: str, _publish: object, _peer_publish: object) -> None:
        """Handle a new subscriber."""
        self._server.loop.post(self._reset)


def advertise_visuals(server: Server) -> None:
    """Advertise the markers and update them in wall time, also while paused."""
    thread = ThreadPoolExecutor(1, 'sunlit_meshes')
    sunlit = SunlitMarkers(server.world, SunlitMeshes(), thread)
    publish_changes(server, '~visual_markers', MarkerArray, ShownMarkers(server.world), latch=True)
    publish_changes(server, '~view/markers', MarkerArray, sunlit, latch=True)


def publish_changes(
    server: Server, topic: str, kind: type[Message], view: IncrementalView, latch: bool = False
) -> None:
    """Advertise a topic and publish what changes in a view, in wall time, also while paused."""
    resets = Viewers(server, view.reset)
    publisher = rospy.Publisher(topic, kind, resets, latch=latch, queue_size=10)

    def show() -> None:
        changes = view.changes() if publisher.get_num_connections() else ()
        if changes:
            publisher.publish(kind(changes))

    server.loop.every(PERIOD, show)
