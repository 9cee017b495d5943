"""What plugins and sensors give out: readings, which are plain values, and outputs for them."""

from collections.abc import Callable
from typing import Generic, NamedTuple, TypeVar

from ..core import NotFoundError, Pose, Twist

Reading = TypeVar('Reading')


class Odometry(NamedTuple):
    """Pose in a frame; twist in the axes of what moves, for `P3D` in those of the frame."""

    pose: Pose
    twist: Twist


class FrameTransform(NamedTuple):
    """Where the frame `child` stands in the frame `parent`."""

    parent: str
    child: str
    pose: Pose


class JointStates(NamedTuple):
    """Joint names with their positions [rad or m], and velocities and efforts if they are told."""

    names: tuple[str, ...]
    positions: tuple[float, ...]
    velocities: tuple[float, ...] = ()  # [rad/s or m/s]
    efforts: tuple[float, ...] = ()  # [N m or N]


class Output(Generic[Reading]):
    """What a plugin gives out, to any number of readers: ROS, a window, a script.

    While `wanted` is false there is none, and nothing is to be computed for it. Readers come and go
    between two runs of the world, on the thread that owns it.
    """

    def __init__(self, changed: Callable[[], None]) -> None:
        """Call `changed()` when the first reader has come, and when the last one has gone."""
        self._changed = changed
        self._readers: tuple[Callable[[Reading], object], ...] = ()
        self.kept: Reading | None = None  # see `newest`
        self.wanted = False

    @property
    def readers(self) -> int:
        """Return how many there are."""
        return len(self._readers)

    def connect(self, read: Callable[[Reading], object]) -> None:
        """Give every reading to `read(reading)`, after those that were connected before."""
        self._set_readers((*self._readers, read))

    def disconnect(self, read: Callable[[Reading], object]) -> None:
        """Give no more readings to `read`; it may have none already."""
        self._set_readers(tuple(other for other in self._readers if other != read))

    def keep(self) -> None:
        """Keep the newest reading from now on, for `newest`."""
        if self._keep not in self._readers:
            self.connect(self._keep)

    @property
    def newest(self) -> Reading:
        """Return the newest reading since `keep`.

        Raises:
            NotFoundError: there is none yet.
        """
        if self.kept is not None:
            return self.kept
        if self._keep in self._readers:
            raise NotFoundError('this output has no reading yet; let the world run on')
        raise NotFoundError('this output keeps no readings; call its keep() before the world runs')

    def _keep(self, reading: Reading) -> None:
        self.kept = reading

    def send(self, reading: Reading) -> None:
        """Give a reading to all readers."""
        for read in self._readers:
            read(reading)

    def _set_readers(self, readers: tuple[Callable[[Reading], object], ...]) -> None:
        self._readers = readers
        if self.wanted != bool(readers):
            self.wanted = bool(readers)
            self._changed()
