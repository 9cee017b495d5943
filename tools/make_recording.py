#!/usr/bin/env python3
"""Record the article's robot as it drives: `./rosbots exec tools/make_recording.py [FILE]`.

The animation, doc/images/drive.webp by default, is what Chromium shows of the window in the
browser. It takes much longer to be made than to be played, as it is drawn in software: time is
paused, and a picture is taken after each few steps.
"""

import os
import signal
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import rospy
from chromium import clock, picture
from geometry_msgs.msg import Twist
from make_pictures import ROOT, PictureError, Steps, address_in, opened, started
from PIL import Image
from rosbots_msgs.srv import Step
from selenium.webdriver import Chrome

WORLD = ROOT / 'src' / 'rosbots_description' / 'worlds' / 'room.world'
VIEW = '<gui><camera><pose>2.4 -1.8 2.2 0 0.5 2.5</pose></camera></gui>'
PAGE = (960, 600)  # [pixels]
SIZE = (640, 400)  # of the animation [pixels]
QUERY = '&fixedDpr=1'  # not fewer pixels where the processor is slow
QUALITY = 70  # of 100
STEP = 0.001  # [s]
FRAME = 0.08  # [s] between two pictures
SETTLED = 1500  # steps until the robot stands
# Speed [m/s], turn rate [rad/s], and for how long [s].
DRIVE = (
    (0.0, 0.0, 0.3),
    (0.5, 0.0, 1.2),
    (0.5, 0.9, 2.4),
    (0.5, -0.9, 1.6),
    (0.0, 1.5, 2.0),
    (0.0, 0.0, 0.5),
)
SLOW = 60.0  # [s, wall] for one picture
MOST = 2_000_000  # bytes


def steps(world: Path) -> Steps:
    """Return what is launched, with time paused."""
    return [
        (
            [
                'gazebo_ros',
                'empty_world.launch',
                'gui:=false',
                'web:=true',
                'web_port:=0',
                'paused:=true',
                f'world_name:={world}',
            ],
            'the world is at',
        ),
        (
            ['rosbots_description', 'spawn.launch', 'x:=-1.5', 'y:=-0.9', 'z:=0.1'],
            'Successfully spawned entity',
        ),
    ]


def frames(browser: Chrome) -> Iterator[Image.Image]:
    """Drive the robot, and yield a picture after each few steps."""
    rospy.init_node('make_recording', disable_signals=True, disable_rostime=True)
    step = rospy.ServiceProxy('/gazebo/step', Step)
    command = Twist()
    # Latched: it arrives however late the robot subscribes.
    publisher = rospy.Publisher('/part2_cmr/cmd_vel', Twist, queue_size=1, latch=True)
    step(SETTLED)
    for command.linear.x, command.angular.z, seconds in DRIVE:
        publisher.publish(command)
        for _ in range(round(seconds / FRAME)):
            yield shown_at(step(round(FRAME / STEP)).sim_time, browser)


def shown_at(moment: float, browser: Chrome) -> Image.Image:
    """Return what the page shows when its clock is there [s]."""
    end = time.monotonic() + SLOW
    while clock(browser) != f'00:00:{moment:06.3f}':
        if time.monotonic() > end:
            raise PictureError(f'the page does not show {moment:.3f} s within {SLOW:g} s')
    return picture(browser).convert('RGB').resize(SIZE, Image.Resampling.LANCZOS)


def record(folder: Path) -> list[Image.Image]:
    """Launch the world, and return the pictures of a drive."""
    world = folder / 'room.world'
    text = WORLD.read_text(encoding='utf-8')
    world.write_text(text.replace('</world>', f'{VIEW}</world>'), encoding='utf-8')
    with started(steps(world), folder) as environment:
        os.environ.update(environment)
        with opened(address_in(folder) + QUERY, PAGE) as browser:
            return list(frames(browser))


def main() -> int:
    """Make the recording; return an exit code."""
    file = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / 'doc' / 'images' / 'drive.webp'
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        with tempfile.TemporaryDirectory() as folder:
            first, *others = record(Path(folder))
        first.save(
            file,
            save_all=True,
            append_images=others,
            duration=round(1000 * FRAME),
            loop=0,
            quality=QUALITY,
            method=6,
        )
        if file.stat().st_size > MOST:
            raise PictureError(f'{file} is larger than the {MOST} bytes permitted')
    except (PictureError, OSError, rospy.ROSException) as error:
        sys.stderr.write(f'make_recording: {error}\n')
        return 1
    print(f'{file}: {len(others) + 1} pictures, {file.stat().st_size / 1000:.0f} kB')
    return 0


if __name__ == '__main__':
    sys.exit(main())
