"""Front end of teleop_twist_keyboard.py: drives a robot by keys of a terminal."""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from .key_terminal import read_key, single_keys
from .program import fail
from .teleop_keys import BANNER, QUIT, Driver, Speeds

if TYPE_CHECKING:
    from ..ros_api.clients.velocity_publisher import VelocityPublisher

_POLL = 0.1  # [s] between polls for a subscriber
_FIRST_NOTE, _NEXT_NOTE = 2.0, 2.5  # [s] of waiting before the first and between further notes


@dataclass
class Settings:
    """Private parameters of the node, with the original's defaults."""

    speed: float = 0.5  # [m/s]
    turn: float = 1.0  # [rad/s]
    speed_limit: float = 1000.0  # [m/s]
    turn_limit: float = 1000.0  # [rad/s]
    repeat_rate: float = 0.0  # [Hz]; 0: one message per key
    key_timeout: float = 0.5  # [s] without a key until the robot is stopped; 0: never
    stamped: bool = False
    frame_id: str = ''

    def __post_init__(self) -> None:
        for name in ('speed', 'turn', 'speed_limit', 'turn_limit', 'repeat_rate', 'key_timeout'):
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, (int, float)):
                raise ValueError(f'parameter ~{name} must be a number, not {value!r}')
            if math.isnan(value) or (math.isinf(value) and not name.endswith('_limit')):
                raise ValueError(f'parameter ~{name} must be finite, not {value!r}')
            if value < 0.0 and name in ('repeat_rate', 'key_timeout'):
                raise ValueError(f'parameter ~{name} must be 0 or more, not {value!r}')
            setattr(self, name, float(value))


def main(arguments: Sequence[str] | None = None) -> int:
    """Read keys and publish velocity commands until Ctrl-C.

    Returns:
        Exit code: 0 at the end, 1 without a terminal or for an invalid parameter.
    """
    arguments = sys.argv[1:] if arguments is None else arguments
    if not sys.stdin.isatty():
        print(
            'teleop_twist_keyboard reads keys, but its standard input is not a terminal. Start '
            'it with rosrun in a terminal of its own; in a launch file give the node '
            'launch-prefix="xterm -e".',
            file=sys.stderr,
        )
        return 1
    # Imported late, so that the message above needs no ROS.
    from ..ros_api.clients.velocity_publisher import VelocityPublisher
    from ..ros_api.transport import is_running, own_parameters, start_node

    try:
        start_node('teleop_twist_keyboard', arguments)
        settings = Settings(**own_parameters(vars(Settings())))
    except KeyboardInterrupt:
        return 0
    except ValueError as error:
        return fail('teleop_twist_keyboard', str(error))
    publisher = VelocityPublisher(settings.stamped, settings.frame_id, settings.repeat_rate)
    try:
        if _wait_for_subscriber(publisher, is_running):
            _drive(settings, publisher, sys.stdin.fileno(), is_running)
        else:
            print('Ended before anybody listened to the commands.')
    finally:
        publisher.end()
    return 0


def _wait_for_subscriber(publisher: VelocityPublisher, go_on: Callable[[], bool]) -> bool:
    """Wait for a subscriber; return False if the node is shut down first.

    In wall time: with use_sim_time and no /clock yet, ROS time is stopped.
    """
    next_note = time.monotonic() + _FIRST_NOTE
    while not publisher.has_subscribers():
        if not go_on():
            return False
        if time.monotonic() >= next_note:
            print(f'Waiting for subscriber to connect to {publisher.topic}', flush=True)
            next_note += _NEXT_NOTE
        time.sleep(_POLL)
    return True


def _drive(
    settings: Settings, publisher: VelocityPublisher, fd: int, go_on: Callable[[], bool]
) -> None:
    """Convert keys to commands until Ctrl-C, shutdown of the node or end of the terminal."""
    driver = Driver(
        Speeds(settings.speed, settings.turn, settings.speed_limit, settings.turn_limit)
    )

    def send() -> None:
        velocity = driver.velocity()
        publisher.send((velocity.x, velocity.y, velocity.z), velocity.yaw)

    with single_keys(fd):
        send()
        print(BANNER)
        print(driver.speeds.line(), flush=True)
        while go_on():
            try:
                key = read_key(fd, settings.key_timeout or math.inf, go_on)
            except EOFError:
                break
            if key == QUIT:
                break
            if key is None:
                if driver.fall_silent():
                    send()
                continue
            for line in driver.press(key):
                print(line, flush=True)
            send()
