"""The visuals of the world as markers for RViz; no cost without subscribers.

Publishes:
    ~visual_markers (visualization_msgs/MarkerArray, latched): all visuals for a new subscriber,
        then those that moved, were added or removed.
    ~view/markers (visualization_msgs/MarkerArray, latched): the same for gzclient, as mesh files
        on this machine, with baked sunlight.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from typing import Protocol

import rospy
from genpy import Message
from visualization_msgs.msg import Marker, MarkerArray

from ...sim.core import Pose
from ...sim.rendering import SunlitMeshes
from ...sim.runtime import Link, Model, World
from ..server import Server
from .markers import clearance, place_marker, removal, use_sunlit, visual_marker

PERIOD = 0.04  # time between two updates [s, wall]
# Updates between refreshes of all markers: RViz drops its markers when time jumps back.
REFRESH = 25


class LinkView:
    """The markers of one link, and its pose as last published."""

    def __init__(self, link: Link, files: Sequence[str | None] = ()) -> None:
        """Make the markers of a link, from the mesh files of its visuals where given."""
        self._link = link
        self._files = files  # references keep the files
        self._shown: Pose | None = None
        self.markers = [
            visual_marker(link.scoped_name, number, visual)
            for number, visual in enumerate(link.spec.visuals)
        ]
        for marker, file in zip(self.markers, files, strict=False):
            if file is not None:
                use_sunlit(marker, file)

    def moved(self, refresh: bool) -> list[Marker]:
        """Return the markers with their new poses; none if it has not moved, without `refresh`."""
        pose = self._link.pose
        if pose == self._shown and not refresh:
            return []
        self._shown = pose
        for marker, visual in zip(self.markers, self._link.spec.visuals, strict=True):
            place_marker(marker, pose, visual)
        return self.markers


class ShownMarkers:
    """The published markers of a world, to find what has changed."""

    def __init__(self, world: World) -> None:
        self._world = world
        self._models: dict[str, tuple[Model, list[LinkView]]] = {}
        self._updates = 0

    def reset(self) -> None:
        """Publish all at the next update, for a subscriber that may show another world."""
        self._models.clear()
        self._updates = 0

    def changes(self) -> list[Marker]:
        """Return the markers that changed since the last update."""
        markers = [] if self._updates else [clearance()]
        refresh = self._updates % REFRESH == 0
        self._updates += 1
        models = self._world.models
        for name, (model, links) in list(self._models.items()):
            if models.get(name) is not model:
                markers += [removal(marker) for link in links for marker in link.markers]
                del self._models[name]
        for name, model in models.items():
            if name not in self._models:
                views = self._views(name, model)
                if views is None:
                    continue
                self._models[name] = model, views
            for link in self._models[name][1]:
                markers += link.moved(refresh)
        return markers

    def _views(self, _name: str, model: Model) -> list[LinkView] | None:
        """Return the link views of a new model; None if they are not ready yet."""
        return [LinkView(link) for link in _shown_links(model)]


class SunlitMarkers(ShownMarkers):
    """Markers of each model once its mesh files are written, on another thread."""

    def __init__(self, world: World, meshes: SunlitMeshes, thread: Executor) -> None:
        super().__init__(world)
        self._meshes, self._thread = meshes, thread
        self._pending: dict[str, tuple[Model, Future[list[LinkView]]]] = {}

    def reset(self) -> None:
        """Publish all models as soon as their files are written."""
        super().reset()
        self._pending.clear()

    def changes(self) -> list[Marker]:
        """Return the changed markers of the models whose files are written."""
        markers, models = super().changes(), self._world.models
        self._pending = {name: pending for name, pending in self._pending.items() if name in models}
        return markers

    def _views(self, name: str, model: Model) -> list[LinkView] | None:
        if self._pending.get(name, (None,))[0] is not model:
            self._pending[name] = model, self._thread.submit(self._make_views, model)
        future = self._pending[name][1]
        if not future.done():
            return None
        del self._pending[name]
        return future.result()

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
