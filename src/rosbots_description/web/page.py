"""The page: its scene and its controls, while a browser is connected."""

import gc
import logging
import threading
import time
from weakref import WeakSet

import viser

from ..sim.description import SceneChange, ShownMotion
from .browser_panels import BrowserPanels, Shared, Tabs, detach
from .controls import Notices, Panel, WorldName, lay_out
from .editing import Drags, History
from .interpolation import Interpolation
from .keys import KeyHelp
from .panels import (
    Clock,
    ContactsPanel,
    DownloadsPanel,
    FaultList,
    GoalPanel,
    MapPanel,
    PlotPanel,
    TimePanel,
    TopicPanel,
    VelocityCommands,
    add_look,
)
from .polled import Polled
from .scene import Ground, GroundClicks, Models, SceneView, StartView
from .simulator import Simulator
from .site import Site

logger = logging.getLogger(__name__)

SILENCE = 2.0  # [s, wall] without a motion after which the simulator counts as ended
GONE = 'The simulator does not answer. This page shows its last state.'
BACK = 'The simulator is running again.'


class Page:
    """Shows a world to all browsers that are connected; without one it does not look at it."""

    def __init__(self, site: Site, simulator: Simulator) -> None:
        self._site, self._view = site, simulator.view
        self._lock = threading.RLock()
        self._changed = threading.Condition(self._lock)  # somebody has entered or left
        self._motions = Interpolation(self._lock, self._move)
        self._new: list[viser.ClientHandle] = []  # those that have not seen the scene yet
        self._entered: set[int] = set()  # numbers of browsers
        self._gone: WeakSet[viser.ClientHandle] = WeakSet()
        self.browsers: dict[int, BrowserPanels] = {}  # by their numbers
        self._is_open = self._is_complete = False  # the view, and what it has shown
        self._heard = 0.0  # when the last motion came [s, monotonic]
        self._lost = False
        notices = Notices(lambda: site.get_clients().values())
        self._notify = notices.tell
        lay_out(site.gui)
        models = Models()
        self._start = StartView(models)
        name = WorldName(site.gui)
        self._time = TimePanel(site.gui, simulator.time, self._notify)
        history = History(site.gui, self._notify)
        clock = Clock(site.gui)
        scene = SceneView(site, self._click)
        self._ground = Ground(models)
        polled = Polled(simulator)
        self._panels: list[Panel] = [
            models,
            self._start,
            scene,
            self._time,
            clock,
            name,
            history,
            notices,
            self._ground,
            polled,
        ]
        if simulator.faults is not None:
            self._panels.append(FaultList(site.gui, simulator.faults, self._notify))
        KeyHelp(site)
        clicks = GroundClicks(site)
        self._shared = Shared(
            site,
            simulator,
            self._lock,
            models,
            self._start,
            history,
            polled,
            clicks,
            None if simulator.robots is None else VelocityCommands(simulator.robots),
            Drags(),
        )
        self._tabs = self._add_tabs(simulator, models, scene, clicks)
        site.on_client_connect(self._enter)
        site.on_client_disconnect(self._leave)

    def _add_tabs(
        self, simulator: Simulator, models: Models, scene: SceneView, clicks: GroundClicks
    ) -> Tabs:
        """Add the tabs, with what is in them for all browsers; return where the rest is."""
        site = self._site
        tabs = site.gui.add_tab_group()
        drive = edit = None
        if simulator.robots is not None:
            drive = tabs.add_tab('Drive', viser.Icon.STEERING_WHEEL)
        inspect = tabs.add_tab('Models', viser.Icon.LIST_TREE)
        if simulator.editor is not None:
            edit = tabs.add_tab('Edit', viser.Icon.TOOL)
        with tabs.add_tab('Show', viser.Icon.EYE):
            add_look(site.gui, scene, self._lock)
            show = site.gui.add_folder(None)
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
            self._panels.insert(
                0, DownloadsPanel(site, simulator.worlds, self._redraw, self._notify)
            )
        return Tabs(drive, inspect, edit, show, tabs.order - 0.5)

    def poll(self) -> None:
        """Refresh the panels, and report a silent simulator; to be called about twice a second."""
        now = time.monotonic()  # while the page is busy, which this may wait for, it hears nobody
        if self._is_open:
            for panel in (*self._panels, *self.browsers.values()):
                panel.refresh()
        elif self._gone:
            gc.collect()  # what viser had for each is a cycle, with megabytes for compression
        with self._lock:
            if self._is_open and not self._lost and now - self._heard > SILENCE:
                self._lost = True
                self._time.warn(GONE)

    def _enter(self, client: viser.ClientHandle) -> None:
        with self._lock:
            if client.client_id not in self._site.get_clients():
                return  # it has disconnected, and `_leave` may have come first
            self._entered.add(client.client_id)
            self._changed.notify_all()  # who waits goes on when the lock is free again
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
            try:
                self.browsers[client.client_id] = BrowserPanels(client, self._shared, self._tabs)
            except (KeyError, RuntimeError):
                if client.client_id in self._site.get_clients():
                    raise  # else viser has removed what was made so far; `_leave` does the rest

    def _leave(self, client: viser.ClientHandle) -> None:
        with self._lock:
            if client in self._new:
                self._new.remove(client)
            self._gone.add(client)
            self._entered.discard(client.client_id)
            self._changed.notify_all()
            browser = self.browsers.pop(client.client_id, None)
            if browser is not None:
                browser.close()
            # When its panels are complete, not while they are made:
            detach(client)
            self._site.forget(client)
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
            for panel in (*self._panels, *self.browsers.values()):
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
            self._ground.begin(client, *self._start.choose(client.camera.aspect))
        self._new.clear()

    def _hear(self, motion: ShownMotion) -> None:
        with self._lock:
            self._heard = time.monotonic()
            if self._lost:
                self._lost = False
                self._time.warn('')
                self._notify(BACK)
            self._motions.take(motion)

    def _move(self, motion: ShownMotion) -> None:
        for panel in (*self._panels, *self.browsers.values()):
            panel.move(motion)

    def _redraw(self, client: viser.ClientHandle) -> None:
        browser = self._panels_of(client)
        if browser is not None:
            with self._lock:
                browser.redraw()

    def _click(self, model: str, link: str, client: viser.ClientHandle) -> None:
        browser = self._panels_of(client)
        if browser is not None:
            browser.click(model, link)

    def _panels_of(self, client: viser.ClientHandle) -> BrowserPanels | None:
        """Return the panels of a browser; None: it has left.

        It shows the scene before they are made, so a click may come too early, and waits.
        """
        with self._changed:
            self._changed.wait_for(
                lambda: (
                    client.client_id in self._entered
                    or client.client_id not in self._site.get_clients()
                )
            )
            return self.browsers.get(client.client_id)
