"""Outputs of plugins and sensors, and their readings, which are plain values."""

from collections.abc import Callable
from typing import Generic, NamedTuple, TypeVar

from ..core import NotFoundError, Pose, Twist

Reading = TypeVar('Reading')


class Odometry(NamedTuple):
    """Pose in a frame; twist in the body's axes, but for `P3D` in those of the frame."""

    pose: Pose
    twist: Twist


class FrameTransform(NamedTuple):
    """The pose of the frame `child` in the frame `parent`."""

    parent: str
    child: str
    pose: Pose


class JointStates(NamedTuple):
    """Joint names and positions [rad or m]; velocities and efforts if they are reported."""

    names: tuple[str, ...]
    positions: tuple[float, ...]
    velocities: tuple[float, ...] = ()  # [rad/s or m/s]
    efforts: tuple[float, ...] = ()  # [N m or N]


class Output(Generic[Reading]):
    """An output of a plugin with any number of readers: ROS, a window, a script.

    While `wanted` is false there is no reader, and nothing needs to be computed. Connect and
    disconnect readers between two runs of the world, on the thread that owns it.
    """

    def __init__(self, changed: Callable[[], None]) -> None:
        """Call `changed()` when the first reader connects, and when the last one disconnects."""
        self._changed = changed
        self._readers: tuple[Callable[[Reading], object], ...] = ()
        self.latched: Reading | None = None  # see `newest`
        self.wanted = False

    def __repr__(self) -> str:
        """Return how many read it, and whether it stores the newest reading."""
        readers = f'{self.readers} reader{"" if self.readers == 1 else "s"}'
        latched = ', latched' if self.is_read_by(self._latch) else ''
        return f'<{type(self).__name__} with {readers}{latched}>'

    @property
    def readers(self) -> int:
        """Return how many there are."""
        return len(self._readers)

    def is_read_by(self, read: Callable[[Reading], object]) -> bool:
        """Return whether `read` is connected."""
        return read in self._readers

    def connect(self, read: Callable[[Reading], object]) -> None:
        """Pass every reading to `read(reading)`, after the readers connected before."""
        self._set_readers((*self._readers, read))

    def disconnect(self, read: Callable[[Reading], object]) -> None:
        """Disconnect `read`; no effect if it is not connected."""
        self._set_readers(tuple(other for other in self._readers if other != read))

    def latch(self) -> None:
        """Keep the newest reading from now on, for `newest`."""
        if not self.is_read_by(self._latch):
            self.connect(self._latch)

    @property
    def newest(self) -> Reading:
        """Return the newest reading since `latch`.

        Raises:
            NotFoundError: there is none yet.
        """
        if self.latched is not None:
            return self.latched
        if self._latch in self._readers:
            raise NotFoundError('this output has no reading yet; let the world run on')
        raise NotFoundError('this output stores no reading; call its latch() before the world runs')

    def _latch(self, reading: Reading) -> None:
        self.latched = reading

    def send(self, reading: Reading) -> None:
        """Pass a reading to all readers."""
        for read in self._readers:
            read(reading)

    def _set_readers(self, readers: tuple[Callable[[Reading], object], ...]) -> None:
        self._readers = readers
        if self.wanted != bool(readers):
            self.wanted = bool(readers)
            self._changed()
