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
from .limits import HEAVIEST, LARGEST, LIGHTEST, LONGEST, MOST_INERT, SLOWEST_RATE
from .messages import (
    MAX_NOTES,
    document_url,
    fault,
    line_of,
    location,
    note,
    owner,
    shortened,
    source_of,
    suggestion,
)
from .transforms import (
    ALONG,
    IDENTITY,
    NO_ROTATION,
    UP,
    ZERO,
    Pose,
    Quaternion,
    Twist,
    Vector,
    add,
    as_quaternion,
    as_vector,
    compose,
    conjugate,
    cross,
    dot,
    from_rpy,
    inverse,
    multiply,
    normalise,
    relative,
    rotate,
    subtract,
    to_rpy,
    yaw_of,
)
from .xml_text import is_expanded_xacro, plain_text

__all__ = [
    'ALONG', 'END', 'HEAVIEST', 'IDENTITY', 'LARGEST', 'LIGHTEST', 'LONGEST', 'MAX_NOTES',
    'MOST_INERT', 'NANOSECONDS', 'NO_ROTATION', 'SLOWEST_RATE', 'UP', 'ZERO', 'AbsentError',
    'ModelError', 'NotFoundError', 'PluginError', 'Pose', 'Quaternion', 'ShapeError', 'SimClock',
    'SimError', 'Twist', 'Vector', 'add', 'arrays', 'as_quaternion', 'as_vector', 'compose',
    'conjugate', 'cross', 'document_url', 'dot', 'fault', 'from_rpy', 'inverse',
    'is_expanded_xacro', 'line_of', 'location', 'multiply', 'normalise', 'note', 'one_line',
    'owner', 'plain_text', 'relative', 'rotate', 'shortened', 'source_of', 'subtract', 'suggestion',
    'to_rpy', 'yaw_of',
]
