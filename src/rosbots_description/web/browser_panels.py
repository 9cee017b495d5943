"""The panels of one browser: its selection, and all that depends on it."""

import threading
from dataclasses import dataclass

import viser

from ..sim.description import SceneChange, ShownMotion
from .controls import CameraKeys, Notices, Panel
from .editing import ChangePanel, Drags, EditorPanel, Gizmo, History, InsertPanel, Inspector
from .panels import DrivePanel, JointPanel, Joystick, ModelTree, OverlayPanel, VelocityCommands
from .polled import Polled
from .scene import FollowPanel, GroundClicks, Models, Outline, Selection, StartView, ViewPanel
from .simulator import Simulator
from .site import Site

Tab = viser.GuiTabHandle | viser.GuiFolderHandle


@dataclass(frozen=True)
class Tabs:
    """Where on the page the panels of a browser are; None: the simulator has nothing for them."""

    drive: Tab | None
    models: Tab
    edit: Tab | None
    show: Tab
    views: float  # place of the buttons that turn the camera, in the order of the page


@dataclass(frozen=True)
class Shared:
    """What the panels of all browsers share."""

    site: Site
    simulator: Simulator
    lock: threading.RLock  # of the page
    models: Models
    start: StartView
    history: History
    polled: Polled
    clicks: GroundClicks
    velocities: VelocityCommands | None
    drags: Drags


class BrowserPanels(Panel):
    """Shows and controls what is a browser's own, until it leaves."""

    def __init__(self, client: viser.ClientHandle, shared: Shared, tabs: Tabs) -> None:
        self._client, self._shared = client, shared
        self.selection = Selection(shared.models, shared.lock)
        notices = Notices(lambda: (client,))
        self._notify = notices.tell
        self._panels: list[Panel] = [self.selection, notices]
        with client.atomic():
            self._add_views(tabs.views)
            if tabs.drive is not None:
                self._add_driving(tabs.drive)
            self._add_models(tabs.models)
            if tabs.edit is not None:
                self._add_editing(tabs.edit)
            with tabs.show:
                self._overlays = OverlayPanel(client, self.selection, shared.site.allow_viewers)
        self._panels.append(self._overlays)
        detach(client)
        self.refresh()

    def click(self, model: str, link: str) -> None:
        """Take in a click on a link."""
        self._views.click(model, link)

    def redraw(self) -> None:
        """Draw again what the browser has of its own in the scene."""
        self._outline.draw()
        self._overlays.draw()

    def apply(self, change: SceneChange) -> None:
        """Take in a change of the scene."""
        for panel in self._panels:
            panel.apply(change)

    def move(self, motion: ShownMotion) -> None:
        """Take in the clock and new poses."""
        for panel in self._panels:
            panel.move(motion)

    def refresh(self) -> None:
        """Show what was polled."""
        for panel in self._panels:
            panel.refresh()

    def close(self) -> None:
        """Close its panels: the browser has disconnected."""
        for panel in self._panels:
            panel.close()

    def _add_views(self, order: float) -> None:
        client, shared = self._client, self._shared
        allow = shared.site.allow_viewers
        nothing = client.gui.add_command('Select nothing', hotkey='escape')
        nothing.on_trigger(lambda _: self.selection.choose(None))
        allow(nothing)
        self._views = ViewPanel(client, self.selection, shared.start, order, allow)
        self._outline = Outline(client, self.selection)
        self._panels += [self._outline, FollowPanel(client, self.selection, order, allow)]

    def _add_driving(self, tab: Tab) -> None:
        client, shared, polled = self._client, self._shared, self._shared.polled
        assert shared.velocities is not None
        keys = CameraKeys(client.gui)
        with tab:
            drive = DrivePanel(
                client.gui,
                shared.velocities,
                lambda: polled.drive_topics,
                keys,
                shared.site.allow_viewers,
            )
            self._panels += [drive, Joystick(client, drive.steer)]
            if shared.simulator.joints is not None:
                self._panels.append(
                    JointPanel(
                        client,
                        shared.simulator.joints,
                        lambda: polled.command_topics,
                        shared.models,
                        self._notify,
                    )
                )

    def _add_models(self, tab: Tab) -> None:
        client, shared = self._client, self._shared
        inspection = shared.simulator.inspection
        with tab:
            if inspection is not None:
                self._panels += [
                    Inspector(client.gui, shared.polled, self.selection),
                    ChangePanel(
                        client.gui, inspection, self.selection, shared.history, self._notify
                    ),
                ]
            self._panels.append(ModelTree(client, self.selection, shared.site.allow_viewers))

    def _add_editing(self, tab: Tab) -> None:
        client, shared = self._client, self._shared
        editor, library = shared.simulator.editor, shared.simulator.library
        assert editor is not None
        with tab:
            EditorPanel(client.gui, self.selection, editor, shared.history, self._notify)
            if library is not None:
                self._panels.append(
                    InsertPanel(
                        client,
                        shared.site,
                        library,
                        lambda: shared.polled.insertable,
                        editor,
                        shared.polled,
                        self.selection,
                        shared.history,
                        shared.clicks,
                        self._notify,
                    )
                )
        if shared.site.may_control(client):
            self._panels.append(
                Gizmo(client, self.selection, editor, shared.drags, shared.history, self._notify)
            )


def detach(client: viser.ClientHandle) -> None:
    """Take the controls of a browser out of viser's lists of what is in the tabs of all.

    When a browser leaves, viser marks what is in these lists as removed, after which a command that
    is still being carried out could show nothing: each control raises RuntimeError. What is made
    while viser does so may stay in the lists.
    """
    for container in tuple(client._viser_server.gui._container_handle_from_uuid.values()):
        children = container._children
        for number, handle in tuple(children.items()):
            if handle._impl.gui_api is client.gui:  # type: ignore[attr-defined]
                children.pop(number, None)
    client.gui._handles_in_foreign_containers.clear()
