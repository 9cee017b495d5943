"""What everything else is built on: transforms, simulated time, errors, limits."""

from .clock import END, NANOSECONDS, SimClock
from .errors import (
    AbsentError,
    ModelError,
    NotFoundError,
    PluginError,
    ShapeError,
    SimError,
    one_line,
)
from .limits import LARGEST
from .transforms import (
    ALONG,
    IDENTITY,
    NO_ROTATION,
    UP,
    Pose,
    Quaternion,
    Twist,
    Vector,
    add,
    compose,
    conjugate,
    cross,
    dot,
    from_rpy,
    inverse,
    normalise,
    relative,
    rotate,
    subtract,
    to_rpy,
    yaw_of,
)
from .xml_text import is_expanded_xacro, plain_text

__all__ = [
    'ALONG', 'END', 'IDENTITY', 'LARGEST', 'NANOSECONDS', 'NO_ROTATION', 'UP', 'AbsentError',
    'ModelError', 'NotFoundError', 'PluginError', 'Pose', 'Quaternion', 'ShapeError', 'SimClock',
    'SimError', 'Twist', 'Vector', 'add', 'compose', 'conjugate', 'cross', 'dot', 'from_rpy',
    'inverse', 'is_expanded_xacro', 'normalise', 'one_line', 'plain_text', 'relative', 'rotate',
    'subtract', 'to_rpy', 'yaw_of',
]
