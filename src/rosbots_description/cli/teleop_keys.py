"""Key bindings of the keyboard teleoperation, independent of terminal and ROS."""

from __future__ import annotations

from dataclasses import dataclass, field

Direction = tuple[int, int, int, int]  # forward, left, up, counter-clockwise; each -1, 0 or 1

STANDSTILL: Direction = (0, 0, 0, 0)
QUIT = '\x03'  # Ctrl-C in a terminal in raw mode
BANNER_EVERY = 15  # speed keys between two banners

MOVES: dict[str, Direction] = {
    'i': (1, 0, 0, 0),
    'o': (1, 0, 0, -1),
    'u': (1, 0, 0, 1),
    'j': (0, 0, 0, 1),
    'l': (0, 0, 0, -1),
    ',': (-1, 0, 0, 0),
    '.': (-1, 0, 0, 1),
    'm': (-1, 0, 0, -1),
    'I': (1, 0, 0, 0),
    'O': (1, -1, 0, 0),
    'U': (1, 1, 0, 0),
    'J': (0, 1, 0, 0),
    'L': (0, -1, 0, 0),
    '<': (-1, 0, 0, 0),
    '>': (-1, -1, 0, 0),
    'M': (-1, 1, 0, 0),
    't': (0, 0, 1, 0),
    'b': (0, 0, -1, 0),
}

# Factors for the linear and the angular speed.
SPEED_STEPS: dict[str, tuple[float, float]] = {
    'q': (1.1, 1.1),
    'z': (0.9, 0.9),
    'w': (1.1, 1.0),
    'x': (0.9, 1.0),
    'e': (1.0, 1.1),
    'c': (1.0, 0.9),
}

BANNER = """
Drive a robot with the keys of this terminal
---------------------------
To move, hold a key down; the robot stops when you let go:
   u    i    o
   j    k    l
   m    ,    .

To move sideways (omnidirectional robots), hold shift:
---------------------------
   U    I    O
   J    K    L
   M    <    >

t : up (+z)
b : down (-z)

any other key : stop

q/z : both speeds up/down by 10%
w/x : only the linear speed up/down by 10%
e/c : only the angular speed up/down by 10%

Ctrl-C to leave
"""


@dataclass
class Speeds:
    """Linear [m/s] and angular [rad/s] speed, with limits for the speed keys."""

    linear: float = 0.5
    angular: float = 1.0
    linear_limit: float = 1000.0
    angular_limit: float = 1000.0

    def scale(self, linear_factor: float, angular_factor: float) -> list[str]:
        """Scale the speeds up to their limits; return a line for each limit reached."""
        self.linear = min(self.linear_limit, self.linear * linear_factor)
        self.angular = min(self.angular_limit, self.angular * angular_factor)
        lines = []
        if self.linear == self.linear_limit:
            lines.append('Linear speed limit reached!')
        if self.angular == self.angular_limit:
            lines.append('Angular speed limit reached!')
        return lines

    def line(self) -> str:
        """Return the line that shows the speeds."""
        return f'currently:\tspeed {self.linear}\tturn {self.angular} '


@dataclass(frozen=True)
class Velocity:
    """A command: linear [m/s] along x, y, z and angular [rad/s] about z of the robot."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    yaw: float = 0.0


@dataclass
class Driver:
    """Converts keys to commands; keeps direction and speeds."""

    speeds: Speeds = field(default_factory=Speeds)
    direction: Direction = STANDSTILL
    _speed_keys: int = 0

    def press(self, key: str) -> list[str]:
        """Handle a key; return the lines to show. An unassigned key stops the robot."""
        if key in MOVES:
            self.direction = MOVES[key]
            return []
        if key in SPEED_STEPS:
            lines = [*self.speeds.scale(*SPEED_STEPS[key]), self.speeds.line()]
            self._speed_keys += 1
            if self._speed_keys % BANNER_EVERY == 0:
                lines.append(BANNER)
            return lines
        self.direction = STANDSTILL
        return []

    def fall_silent(self) -> bool:
        """Handle the key timeout: stop; return whether the robot was moving."""
        was_moving = self.direction != STANDSTILL
        self.direction = STANDSTILL
        return was_moving

    def velocity(self) -> Velocity:
        """Return the command for the current direction and speeds."""
        x, y, z, yaw = self.direction
        linear = self.speeds.linear
        return Velocity(x * linear, y * linear, z * linear, yaw * self.speeds.angular)
