"""The page: its scene and its controls, while a browser is connected."""

import gc
import logging
import threading
import time
from collections.abc import Callable
from typing import Protocol
from weakref import WeakSet

import viser

from ..sim.description import SceneChange, ShownMotion
from .bar import Bar, TimeControl
from .camera_keys import CameraKeys
from .change import ChangePanel, Inspection
from .clock import Clock
from .contacts import Contacts, ContactsPanel
from .drive import DrivePanel, Robots
from .follow import FollowPanel
from .gizmo import Gizmo
from .goals import GoalPanel, Goals
from .ground import Ground
from .ground_clicks import GroundClicks
from .hands import Hands, HandsPanel
from .history import History
from .insert import InsertPanel, Library
from .inspector import Inspector
from .interpolation import Interpolation
from .joints import JointPanel, Joints
from .joystick import Joystick
from .keys import KeyHelp
from .layout import lay_out
from .maps import MapPanel, Maps
from .models import Models
from .notices import Notices
from .outline import Outline
from .panel import Panel
from .plot import PlotPanel, Signals
from .scene import SceneView
from .selection import Selection
from .show import ShowPanel
from .site import Site
from .start_view import StartView
from .take_away import TakeAwayPanel, Worlds
from .topics import ShownTopics, TopicPanel
from .tree import ModelTree
from .views import ViewPanel, look
from .world_name import WorldName

logger = logging.getLogger(__name__)

SILENCE = 2.0  # [s, wall] without a motion after which the simulator counts as ended
GONE = 'The simulator does not answer. This page shows its last state.'
BACK = 'The simulator is running again.'


class View(Protocol):
    """The scene of a simulator."""

    def open(
        self, change: Callable[[SceneChange], None], motion: Callable[[ShownMotion], None]
    ) -> None:
        """Begin to call back, from any thread."""

    def close(self) -> None:
        """End that."""


class Simulator(Protocol):
    """A simulator that can be seen and controlled, by parts."""

    @property
    def view(self) -> View:
        """Its scene."""

    @property
    def time(self) -> TimeControl:
        """Its clock."""

    @property
    def robots(self) -> Robots | None:
        """Its robots, if they can be driven."""

    @property
    def joints(self) -> Joints | None:
        """Its joints, if they can be moved."""

    @property
    def inspection(self) -> Inspection | None:
        """Its models and links, if they can be changed."""

    @property
    def contacts(self) -> Contacts | None:
        """What touches in it, if that can be seen."""

    @property
    def library(self) -> Library | None:
        """What can be inserted into it, if anything can."""

    @property
    def hands(self) -> Hands | None:
        """What can be done to its models, if anything can."""

    @property
    def worlds(self) -> Worlds | None:
        """Its world as a file, if it gives that away."""

    @property
    def sensors(self) -> ShownTopics | None:
        """What its robots sense with, if that can be seen."""

    @property
    def maps(self) -> Maps | None:
        """Maps of it, and what navigation makes of them, if that can be seen."""

    @property
    def goals(self) -> Goals | None:
        """What takes goals and initial poses, if anything does."""

    @property
    def signals(self) -> Signals | None:
        """Numbers that can be plotted, if any can."""


class Page:
    """Shows a world to all browsers that are connected; without one it does not look at it."""

    def __init__(self, site: Site, simulator: Simulator) -> None:
        self._site, self._view = site, simulator.view
        self._lock = threading.RLock()
        self._motions = Interpolation(self._lock, self._move)
        self._new: list[viser.ClientHandle] = []  # those that have not seen the scene yet
        self._gone: WeakSet[viser.ClientHandle] = WeakSet()
        self._is_open = self._is_complete = False  # the view, and what it has shown
        self._heard = 0.0  # when the last motion came [s, monotonic]
        self._lost = False
        notices = Notices(site)
        self._notify = notices.tell
        lay_out(site.gui)
        models = Models()
        self.selection = Selection(models, self._lock)
        site.gui.add_command('Select nothing', hotkey='escape').on_trigger(
            lambda _: self.selection.choose(None)
        )
        self._start = StartView(models)
        name = WorldName(site.gui)
        self._bar = Bar(site.gui, simulator.time, self._notify)
        history = History(site.gui, self._notify)
        clock = Clock(site.gui)
        views = ViewPanel(site, models, self.selection, self._start)
        scene = SceneView(site, views.click)
        self._ground = Ground(site, models)
        self._panels: list[Panel] = [
            models,
            self._start,
            scene,
            self.selection,
            Outline(site.scene, models, self.selection),
            self._bar,
            clock,
            name,
            history,
            notices,
            FollowPanel(site, models, self.selection),
            self._ground,
        ]
        KeyHelp(site)
        self._add_tabs(simulator, models, scene, history)
        site.on_client_connect(self._enter)
        site.on_client_disconnect(self._leave)

    def _add_tabs(
        self, simulator: Simulator, models: Models, scene: SceneView, history: History
    ) -> None:
        site = self._site
        keys, clicks = CameraKeys(site.gui), GroundClicks(site)
        tabs = site.gui.add_tab_group()
        if simulator.robots is not None:
            with tabs.add_tab('Drive', viser.Icon.STEERING_WHEEL):
                drive = DrivePanel(site.gui, simulator.robots, keys)
                self._panels += [drive, Joystick(site, drive.steer)]
                if simulator.joints is not None:
                    self._panels.append(JointPanel(site, simulator.joints, models, self._notify))
        with tabs.add_tab('Models', viser.Icon.LIST_TREE):
            if simulator.inspection is not None:
                self._panels += [
                    Inspector(site.gui, simulator.inspection, models, self.selection, self._lock),
                    ChangePanel(
                        site.gui,
                        simulator.inspection,
                        models,
                        self.selection,
                        history,
                        self._notify,
                    ),
                ]
            self._panels.append(ModelTree(site, models, self.selection, self._lock))
        if simulator.hands is not None:
            with tabs.add_tab('Edit', viser.Icon.TOOL):
                HandsPanel(site.gui, models, self.selection, simulator.hands, history, self._notify)
                if simulator.library is not None:
                    self._panels.append(
                        InsertPanel(
                            site,
                            simulator.library,
                            simulator.hands,
                            self.selection,
                            history,
                            clicks,
                            self._notify,
                        )
                    )
            self._panels.append(
                Gizmo(site, models, self.selection, simulator.hands, history, self._notify)
            )
        with tabs.add_tab('Show', viser.Icon.EYE):
            self._panels.append(ShowPanel(site, scene, models, self.selection, self._lock))
            if simulator.contacts is not None:
                self._panels.append(ContactsPanel(site, simulator.contacts, self._lock))
        if simulator.sensors is not None:
            with tabs.add_tab('Sensors', viser.Icon.CAMERA):
                self._panels.append(
                    TopicPanel(site, simulator.sensors, models, 'sensors', 'No sensor publishes.')
                )
        if simulator.maps is not None and simulator.goals is not None:
            with tabs.add_tab('Map', viser.Icon.MAP):
                self._panels += [
                    GoalPanel(site.gui, simulator.goals, models, clicks, self._notify),
                    MapPanel(site, simulator.maps, models),
                ]
        if simulator.signals is not None:
            with tabs.add_tab('Plot', viser.Icon.CHART_LINE):
                self._panels.append(PlotPanel(site, simulator.signals, self._notify))
        with tabs.add_tab('Take away', viser.Icon.DOWNLOAD):
            # First, as a recording stamps what moves after it.
            self._panels.insert(0, TakeAwayPanel(site, simulator.worlds, self._notify))

    def poll(self) -> None:
        """Refresh the panels, and report a silent simulator; to be called about twice a second."""
        if self._is_open:
            for panel in self._panels:
                panel.refresh()
        elif self._gone:
            gc.collect()  # what viser had for each is a cycle, with megabytes for compression
        with self._lock:
            if self._is_open and not self._lost and time.monotonic() - self._heard > SILENCE:
                self._lost = True
                self._bar.warn(GONE)

    def _enter(self, client: viser.ClientHandle) -> None:
        with self._lock:
            if client.client_id not in self._site.get_clients():
                return  # it has disconnected, and `_leave` may have come first
            self._new.append(client)
            if not self._is_open:
                self._is_open, self._is_complete = True, False
                self._heard = time.monotonic()
                self._motions.open()
                self._view.open(self._change, self._hear)
                for panel in self._panels:
                    panel.open()
            elif self._is_complete:
                self._look()

    def _leave(self, client: viser.ClientHandle) -> None:
        with self._lock:
            if client in self._new:
                self._new.remove(client)
            self._gone.add(client)
            if self._is_open and not self._site.get_clients():
                self._is_open = False
                self._view.close()
                self._motions.close()
                for panel in self._panels:
                    panel.close()

    def _change(self, change: SceneChange) -> None:
        with self._lock:
            if change.reset:
                self._motions.forget()
            for panel in self._panels:
                panel.apply(change)
            self._is_complete = True
            if self._new:
                self._look()

    def _look(self) -> None:
        """Let those who are new look at everything."""
        camera = self._site.initial_camera
        with self._site.atomic():
            camera.position, camera.look_at = self._start.choose()
        for client in self._new:
            eye, target = self._start.choose(client.camera.aspect)
            self._ground.expect(client, eye, target)
            with client.atomic():
                look(client.camera, eye, target)
        self._new.clear()

    def _hear(self, motion: ShownMotion) -> None:
        with self._lock:
            self._heard = time.monotonic()
            if self._lost:
                self._lost = False
                self._bar.warn('')
                self._notify(BACK)
            self._motions.take(motion)

    def _move(self, motion: ShownMotion) -> None:
        for panel in self._panels:
            panel.move(motion)
