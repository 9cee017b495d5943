"""Downloads from the page: a picture, a video, a recording, the world."""

import io
import threading
from collections.abc import Callable
from functools import partial
from typing import Protocol

import viser
from PIL import Image
from viser._messages import FileTransferPart

from ...sim.core import SimError
from ...sim.description import ShownMotion
from ..controls import Panel, plain
from ..scene import PATIENCE, BrowserRecording, SceneRecording, VideoRecording
from ..site import Site

BACKLOG = 50  # parts of files for a browser that wait, at most, when another file is sent
Click = viser.GuiEvent[viser.GuiButtonHandle]
Complain = Callable[[str], None]


class Worlds(Protocol):
    """What a simulator knows of world files."""

    def save(self) -> tuple[str, str]:
        """Return the world as it stands as a world file, and a sentence about it.

        Raises:
            SimError: the simulator refused or did not answer.
        """


class DownloadsPanel(Panel):
    """Downloads for the browser that asks."""

    def __init__(
        self,
        site: Site,
        worlds: Worlds | None,
        redraw: Callable[[viser.ClientHandle], None],
        complain: Complain,
    ) -> None:
        """Add the buttons; `redraw` draws again what a browser has of its own in the scene."""
        self._complain = complain
        self._lock = threading.Lock()
        self._served: set[int] = set()  # browsers that are being given a file
        gui = site.gui
        if worlds is not None:
            self._button(
                'World',
                viser.Icon.WORLD_DOWNLOAD,
                partial(_give_world, worlds),
                gui,
                'a world file: everything as it is now',
            )
        site.allow_viewers(
            self._button(
                'Picture', viser.Icon.CAMERA, _give_picture, gui, 'what this browser shows, as PNG'
            )
        )
        self._recordings = (
            RecordButton(
                gui,
                'video',
                'video.mp4',
                'what this browser shows, as MP4',
                VideoRecording,
                complain,
            ),
            RecordButton(
                gui,
                'recording',
                'recording.html',
                'the scene as it moves, as a page that needs no simulator',
                lambda client: SceneRecording(site, client),
                complain,
                redraw,
            ),
        )
        site.on_client_disconnect(self._leave)

    def move(self, motion: ShownMotion) -> None:
        """Let recordings go on."""
        for one in self._recordings:
            one.move(motion)

    def refresh(self) -> None:
        """Hand over what has reached its greatest length."""
        for one in self._recordings:
            one.hand_over_if_full()

    def _leave(self, client: viser.ClientHandle) -> None:
        for one in self._recordings:
            one.drop(client)

    def _button(
        self,
        label: str,
        icon: viser.IconName,
        act: Callable[[viser.ClientHandle], None],
        gui: viser.GuiApi,
        hint: str,
    ) -> viser.GuiButtonHandle:
        def click(event: Click) -> None:
            client = event.client
            if client is None:
                return
            with self._lock:
                if client.client_id in self._served:
                    return  # one file after the other
                self._served.add(client.client_id)
            try:
                act(client)
            except SimError as error:
                self._complain(str(error))
            finally:
                self._served.discard(client.client_id)

        button = gui.add_button(label, icon=icon, hint=hint)
        button.on_click(click)
        return button


def _give_world(worlds: Worlds, client: viser.ClientHandle) -> None:
    waiting = tuple(client._websock_connection.get_message_buffer().message_from_id.values())
    if sum(isinstance(message, FileTransferPart) for message in waiting) > BACKLOG:
        raise SimError('this browser does not take what it is sent, so it gets no world')
    text, sentence = worlds.save()
    client.send_file_download('saved.world', text.encode(), save_immediately=True)
    client.add_notification('World', plain(sentence), auto_close_seconds=8.0)


def _give_picture(client: viser.ClientHandle) -> None:
    camera = client.camera
    try:
        shown = client.get_render(
            camera.image_height, camera.image_width, transport_format='png', timeout=PATIENCE
        )
    except (TimeoutError, RuntimeError) as error:
        raise SimError(f'the browser gave no picture: {error}') from error
    made = io.BytesIO()
    Image.fromarray(shown).save(made, 'PNG')
    client.send_file_download('picture.png', made.getvalue(), save_immediately=True)


class RecordButton:
    """Starts and stops a recording for one browser at a time."""

    def __init__(
        self,
        gui: viser.GuiApi,
        called: str,
        file: str,
        hint: str,
        make: Callable[[viser.ClientHandle], BrowserRecording],
        complain: Complain,
        begun: Callable[[viser.ClientHandle], None] = lambda _: None,
    ) -> None:
        """Add the button; `begun` is called with a browser when its recording has begun."""
        self._called, self._file, self._make, self._complain = called, file, make, complain
        self._begun = begun
        self._lock = threading.Lock()
        self._running: tuple[BrowserRecording, viser.ClientHandle] | None = None
        self._button = gui.add_button('', icon=viser.Icon.PLAYER_RECORD, hint=hint)
        self._button.on_click(self._click)
        self._label()

    def move(self, motion: ShownMotion) -> None:
        """Take in a motion."""
        with self._lock:
            if self._running is not None:
                self._running[0].move(motion)

    def hand_over_if_full(self) -> None:
        """End a recording that has reached its greatest length."""
        running = self._running
        if running is not None and running[0].is_full:
            self._complain(f'The {self._called} is as long as it can be, and ends.')
            threading.Thread(target=self._hand_over, daemon=True).start()

    def drop(self, client: viser.ClientHandle) -> None:
        """End the recording of a browser that has disconnected."""
        with self._lock:
            is_its = self._running is not None and self._running[1] is client
        running = self._stop() if is_its else None
        if running is not None:
            threading.Thread(target=running[0].finish, daemon=True).start()

    def _click(self, event: Click) -> None:
        if event.client is None:
            return
        with self._lock:  # a second click waits, and ends what the first one began
            begins = self._running is None
            if begins:
                self._begin(event.client)
        if begins:
            self._begun(event.client)
            self._label()
        else:
            self._hand_over()

    def _begin(self, client: viser.ClientHandle) -> None:
        try:
            self._running = (self._make(client), client)
        except ImportError as error:
            self._complain(
                f"No {self._called}: the Python package '{error.name}' is not "
                'installed; ./rosbots setup does that.'
            )

    def _stop(self) -> tuple[BrowserRecording, viser.ClientHandle] | None:
        with self._lock:
            running, self._running = self._running, None
        self._label()
        return running

    def _hand_over(self) -> None:
        running = self._stop()
        if running is None:  # somebody else stopped it, too
            return
        recording, client = running
        content = recording.finish()
        if content:
            client.send_file_download(self._file, content, save_immediately=True)
        else:
            self._complain(f'The browser gave no pictures, so there is no {self._called}.')

    def _label(self) -> None:
        is_running = self._running is not None
        self._button.label = f'{"Stop the" if is_running else "Record a"} {self._called}'
        self._button.color = 'red' if is_running else None
