#!/usr/bin/env python3
"""Record the article's robot as it drives: `./rosbots exec tools/make_recording.py [FILE]`.

The file, doc/recording.html by default, is a page that plays in any browser without a server; it
begins with the licence of its player. What is pressed in the window is pressed over its connection;
no browser is needed.
"""

import importlib.metadata
import re
import signal
import sys
import tempfile
import time
from pathlib import Path

from make_pictures import ROOT, PictureError, Steps, started

sys.path.append(str(ROOT / 'test'))
from support.browser import Browser

STEPS: Steps = [
    (['gazebo_ros', 'empty_world.launch', 'gui:=false', 'web:=true', 'web_port:=0',
      'world_name:=worlds/room.world'], 'the world is at'),
    (['rosbots_description', 'spawn.launch', 'x:=-1.5', 'y:=-0.9'],
     'Successfully spawned entity'),
]
ROBOT = '/models/rosbots'
DRIVE = (('Forward', 2.5), ('Left', 1.2), ('Forward', 2.0), ('Right', 2.0), ('Forward', 1.5))  # [s]
HOLD = 0.1  # [s] between two messages of a held button
REST = 1.0  # [s] before and after
LOADING = 60.0  # [s, wall] for all meshes
MOST = 2_000_000  # bytes


def record(address: str) -> bytes:
    """Drive the robot by the page's buttons, and return the recording."""
    with Browser(address) as browser:
        browser.wait_until(lambda: browser.control('Forward') and ROBOT in browser.nodes, LOADING)
        browser.read(REST)
        browser.click('Record a recording')
        browser.read(REST)
        for button, seconds in DRIVE:
            end = time.monotonic() + seconds
            while time.monotonic() < end:
                browser.hold(button)
                browser.read(HOLD)
        browser.read(REST)
        browser.click('Stop the recording')
        browser.wait_until(browser.download, LOADING)
        content: bytes = browser.download()[1]
        return content


def with_licence(page: bytes) -> bytes:
    """Return a page with the licence of the player that is in it, which is viser's."""
    found = importlib.metadata.distribution('viser').read_text('licenses/LICENSE')
    if found is None or '--' in found:
        raise PictureError("viser's licence is not where it was, or does not fit into a comment")
    first, _, rest = page.partition(b'\n')
    return b'\n'.join((first, f'<!-- The player is viser:\n\n{found}-->'.encode(), rest))


def main() -> int:
    """Make the recording; return an exit code."""
    file = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / 'doc' / 'recording.html'
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        with tempfile.TemporaryDirectory() as folder, started(STEPS, Path(folder)):
            log = Path(folder, '0.log').read_text(errors='replace')
            content = record(re.findall(r'the world is at (\S+)', log)[-1])
        content = with_licence(content)
        if len(content) > MOST:
            raise PictureError(f'{len(content)} bytes are more than the {MOST} permitted')
        file.write_bytes(content)
    except (PictureError, OSError, AssertionError) as error:
        sys.stderr.write(f'make_recording: {error}\n')
        return 1
    print(f'{file}: {len(content) / 1000:.0f} kB')
    return 0


if __name__ == '__main__':
    sys.exit(main())
