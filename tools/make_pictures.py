#!/usr/bin/env python3
"""Regenerate the README's pictures: `./rosbots exec tools/make_pictures.py [folder [picture …]]`.

The windows are opened on a virtual display (Xvfb), which stores its pixels in a file; the
demo draws its own two; `web*.png` and `arm.png` are what Chromium shows. The
default is all of them, into doc/images; `speed.png` is drawn by `./rosbots bench`, and `map.png`
is RViz after a minute of map_while_driving.launch.
"""

import os
import re
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from chromium import chromium, clock, picture
from numpy.typing import NDArray
from PIL import Image
from selenium.webdriver import Chrome
from selenium.webdriver.common.by import By

from rosbots_description.cli import demo
from rosbots_description.cli.launched import Launched

ROOT = Path(__file__).resolve().parents[1]
SCREEN = (1400, 960)  # [pixels], larger than any window
WIDTH = 900  # of the pictures [pixels]
COLOURS = 256  # of a picture, few for small files
REFINED = 2  # iterations of the choice of colours
START = 60.0  # [s, wall] timeout of the start of a window
POLL_PERIOD = 0.5  # [s, wall] between two screenshots
STILL = 0.5  # mean difference of two screenshots of a steady window with a clock [0-255]
LOOKS = 5  # equal screenshots of a steady window; the first image takes a while
LEAST = 1000  # width of a window [pixels]; RViz's splash screen is narrower
FEWEST = 300  # colours of a window that shows the robot
# Launch files to start in order, each with the output to wait for before the next.
Steps = Sequence[tuple[list[str], str | None]]
WINDOWS: dict[str, Steps] = {
    'rviz.png': [(['rosbots_description', 'rviz.launch'], None)],
    'gzclient.png': [
        (
            ['gazebo_ros', 'empty_world.launch', 'world_name:=worlds/room.world'],
            'Physics dynamic reconfigure ready',
        ),
        (
            ['rosbots_description', 'spawn.launch', 'x:=-0.8', 'y:=-0.9'],
            'Successfully spawned entity',
        ),
    ],
    'see.png': [(['rosbots_description', 'see.launch'], 'pictures are drawn by')],
}
SHEET = '[style*="position: fixed"] [style*="cursor: pointer"]'  # its handle, on a phone
NOTICE = '.mantine-Notification-closeButton'  # that the page is drawn in software
ROOM: Steps = [
    (
        [
            'gazebo_ros',
            'empty_world.launch',
            'gui:=false',
            'web:=true',
            'web_port:=0',
            'world_name:=worlds/room.world',
        ],
        'the world is at',
    ),
    (['rosbots_description', 'spawn.launch', 'x:=-0.8', 'y:=-0.9'], 'Successfully spawned entity'),
]
ARM: Steps = [(['rosbots_description', 'arm.launch', 'gui:=false', 'web:=true'], 'The box is at')]
DESKTOP, LARGE, PHONE, WIDE_PHONE = (1280, 800), (1920, 1080), (390, 844), (844, 390)  # [pixels]
BROWSER = {  # what is started, what the address ends with, the size of the page, what is clicked on
    'web.png': (ROOM, '', DESKTOP, ''),
    'web_dark.png': (ROOM, '&darkMode', DESKTOP, ''),
    'web_large.png': (ROOM, '', LARGE, ''),
    'web_phone.png': (ROOM, '', PHONE, ''),
    'web_phone_sheet.png': (ROOM, '&darkMode', PHONE, SHEET),
    'web_phone_wide.png': (ROOM, '', WIDE_PHONE, ''),
    'arm.png': (ARM, '', DESKTOP, ''),
}
LOADING = 30.0  # [s, wall] for all meshes, drawn in software
OPENING = 5.0  # [s, wall] for what slides in
DEMO = {'demo_path.png': demo.PATH_PICTURE, 'demo_robot.png': demo.ROBOT_PICTURE}


class PictureError(RuntimeError):
    """A picture could not be made; the text is one sentence."""


@contextmanager
def display(folder: Path) -> Iterator[tuple[str, Path]]:
    """Open a display; yield its name and the file of its pixels."""
    read, write = os.pipe()
    server = subprocess.Popen(
        [
            'Xvfb',
            '-noreset',
            '-displayfd',
            str(write),
            '-nocursor',
            '-fbdir',
            folder,
            '-screen',
            '0',
            '{}x{}x24'.format(*SCREEN),
        ],
        pass_fds=(write,),
        stderr=subprocess.DEVNULL,
    )
    os.close(write)
    try:
        with os.fdopen(read) as numbers:
            yield f':{numbers.readline().strip()}', folder / 'Xvfb_screen0'
    finally:
        server.terminate()
        server.wait()


def screen(file: Path) -> NDArray[np.uint8]:
    """Return the pixels of an XWD file, rows by columns by (red, green, blue)."""
    content = file.read_bytes()
    header = struct.unpack_from('>25I', content)
    size, width, height, line, colours = header[0], header[4], header[5], header[12], header[19]
    begin = size + 12 * colours  # after the colour table
    rows = np.frombuffer(content, np.uint8, line * height, begin).reshape(height, line)
    return rows[:, : 4 * width].reshape(height, width, 4)[:, :, 2::-1]


def window(pixels: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Return the part of the screen that is not black."""
    rows, columns = (np.flatnonzero(pixels.any(axis=axes)) for axes in ((1, 2), (0, 2)))
    if not len(rows):
        return pixels[:0, :0]
    return pixels[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]


def steady(file: Path) -> NDArray[np.uint8]:
    """Return the window when it is complete and steady."""
    deadline, before, alike = time.monotonic() + START, None, 1
    while time.monotonic() < deadline:
        now = window(screen(file))
        same = (
            before is not None
            and now.shape == before.shape
            and np.abs(now.astype(float) - before).mean() < STILL
        )
        alike = alike + 1 if same else 1
        if (
            alike >= LOOKS
            and now.shape[1] > LEAST
            and len(np.unique(now.reshape(-1, 3), axis=0)) >= FEWEST
        ):
            return now
        before = now
        time.sleep(POLL_PERIOD)
    raise PictureError(f'no steady window within {START:g} s')


def picture_of(steps: Steps, folder: Path) -> NDArray[np.uint8]:
    """Open windows by launch files; return the pixels."""
    with display(folder) as (name, pixels), started(steps, folder, DISPLAY=name):
        return steady(pixels)


def picture_in_browser(
    steps: Steps, query: str, size: tuple[int, int], button: str, folder: Path
) -> Image.Image:
    """Open the window of a world in a browser; return what it shows.

    Args:
        steps: launch files; the first opens the window.
        query: what the address ends with.
        size: of the page [pixels].
        button: selector of what is clicked on before; '': nothing.
    """
    with started(steps, folder), opened(address_in(folder) + query, size) as browser:
        if button:
            browser.find_element(By.CSS_SELECTOR, button).click()
            time.sleep(OPENING)
        return picture(browser)


def address_in(folder: Path) -> str:
    """Return the address that the first launch file has printed."""
    printed = (folder / '0.log').read_text(errors='replace')
    return str(re.findall(r'the world is at (\S+)', printed)[-1])


@contextmanager
def opened(address: str, size: tuple[int, int]) -> Iterator[Chrome]:
    """Open the window in a browser of this size [pixels]; yield it when all meshes are there."""
    with chromium(size) as browser:
        browser.get(address)
        end = time.monotonic() + START
        while not clock(browser):
            if time.monotonic() > end:
                raise PictureError(f'no page at {address} within {START:g} s')
            time.sleep(POLL_PERIOD)
        for button in browser.find_elements(By.CSS_SELECTOR, NOTICE):
            button.click()
        time.sleep(LOADING)
        yield browser


@contextmanager
def started(steps: Steps, folder: Path, **environment: str) -> Iterator[Mapping[str, str]]:
    """Run launch files in order, with a master of their own; yield their environment."""
    opened = []
    variables = ros_environment(folder, **environment)
    try:
        for number, (arguments, text) in enumerate(steps):
            log = folder / f'{number}.log'
            opened.append(Launched(arguments, log, variables))
            if text:
                wait_for(text, log)
        yield variables
    finally:
        for launched in reversed(opened):
            launched.stop()


def wait_for(text: str, log: Path) -> None:
    """Wait until a launch file has printed a text."""
    deadline = time.monotonic() + START
    while text not in log.read_text(errors='replace'):
        if time.monotonic() > deadline:
            raise PictureError(f"'{text}' was not printed within {START:g} s (see {log})")
        time.sleep(POLL_PERIOD)


def ros_environment(folder: Path, **more: str) -> Mapping[str, str]:
    """Return environment variables with a separate ROS master."""
    with socket.socket() as probe:
        probe.bind(('localhost', 0))
        port = probe.getsockname()[1]
    return {
        **os.environ,
        'ROS_MASTER_URI': f'http://localhost:{port}',
        'ROS_HOSTNAME': 'localhost',
        'ROS_LOG_DIR': str(folder),
        'XDG_CONFIG_HOME': str(folder),
        **more,
    }


def save(image: Image.Image, path: Path) -> None:
    """Write a picture as a small file."""
    width = min(WIDTH, image.width)
    image = image.convert('RGB').resize(
        (width, round(image.height * width / image.width)), Image.Resampling.LANCZOS
    )
    # Refined: without, large faces are up to 17 of 255 off their colour.
    image.quantize(COLOURS, Image.Quantize.MAXCOVERAGE, kmeans=REFINED).save(path, optimize=True)
    print(f'{path}: {path.stat().st_size / 1000:.0f} kB', flush=True)


def make_demo(images: Path, names: Iterable[str]) -> None:
    """Run the demo and write these pictures of it."""
    with tempfile.TemporaryDirectory() as folder:
        if demo.main(['--output', folder]):
            raise PictureError('the demo failed')
        for name in names:
            save(Image.open(Path(folder, DEMO[name])), images / name)


def main() -> int:
    """Make the pictures; return an exit code."""
    images = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / 'doc' / 'images'
    names = sys.argv[2:] or [*WINDOWS, *BROWSER, *DEMO]
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        for name in WINDOWS.keys() & names:
            with tempfile.TemporaryDirectory() as folder:
                save(Image.fromarray(picture_of(WINDOWS[name], Path(folder))), images / name)
        for name in BROWSER.keys() & names:
            with tempfile.TemporaryDirectory() as folder:
                save(picture_in_browser(*BROWSER[name], Path(folder)), images / name)
        if DEMO.keys() & names:
            make_demo(images, DEMO.keys() & names)
    except (PictureError, OSError) as error:
        sys.stderr.write(f'make_pictures: {error}\n')
        return 1
    return 0


if __name__ == '__main__':
    sys.exit(main())
