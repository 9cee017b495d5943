"""Serialization of messages in which only the numbers change.

Serializing the constant parts each time, as genpy does, takes several times as long as the numbers
alone. A serialized message is its size followed by its fields in order; numbers are little-endian,
strings and lists are preceded by their length.
"""

import struct
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...sim.core import NANOSECONDS, Pose
from ...sim.runtime import JointStates, Odometry
from ...sim.sensors import ImuReading

_SIZE = 4  # of the number at the beginning, which does not count itself [bytes]
_COVARIANCE = struct.Struct('<36d')  # row-major 6x6: x, y, z, then rotations about x, y, z


class OdometryLayout:
    """nav_msgs/Odometry between two frames."""

    def __init__(
        self,
        frame: str,
        child: str,
        pose_variances: Sequence[float],
        twist_variances: Sequence[float] = (0.0,) * 6,
    ) -> None:
        """Note what stays the same.

        Args:
            frame: in which the pose is given.
            child: the frame that moves, in which the twist is given.
            pose_variances: six, the diagonal of the pose's covariance.
            twist_variances: the same of the twist.
        """
        self._frames = _text(frame) + _text(child)
        self._pose_covariance = _diagonal(pose_variances)
        self._twist_covariance = _diagonal(twist_variances)
        covariance = f'{_COVARIANCE.size}s'
        self._layout = struct.Struct(f'<4I{len(self._frames)}s7d{covariance}6d{covariance}')
        self._size = self._layout.size - _SIZE

    def pack(self, seq: int, now_ns: int, reading: Odometry) -> bytes:
        """Return the message with the number `seq`, stamped `now_ns` [ns]."""
        pose, twist = reading
        return self._layout.pack(
            self._size,
            seq,
            *divmod(now_ns, NANOSECONDS),
            self._frames,
            *pose.position,
            *pose.orientation,
            self._pose_covariance,
            *twist.linear,
            *twist.angular,
            self._twist_covariance,
        )


class TransformLayout:
    """tf2_msgs/TFMessage with one transform."""

    def __init__(self, parent: str, child: str) -> None:
        """Note the names of the two frames."""
        self._frames = _text(parent) + _text(child)
        self._layout = struct.Struct(f'<5I{len(self._frames)}s7d')
        self._size = self._layout.size - _SIZE

    def pack(self, now_ns: int, pose: Pose) -> bytes:
        """Return the message for the child standing so in its parent at `now_ns` [ns]."""
        return self._layout.pack(  # one transform, whose header nobody counts
            self._size,
            1,
            0,
            *divmod(now_ns, NANOSECONDS),
            self._frames,
            *pose.position,
            *pose.orientation,
        )


class JointStatesLayout:
    """sensor_msgs/JointState with positions; velocity and effort are empty where none are told."""

    def __init__(self, reading: JointStates) -> None:
        """Note the names of the joints, and what is told of them."""
        names, *told = reading
        self._names = _text('') + struct.pack('<I', len(names)) + b''.join(map(_text, names))
        lists = ''.join(f'I{len(values)}d' for values in told)
        self._layout = struct.Struct(f'<4I{len(self._names)}s{lists}')
        self._size = self._layout.size - _SIZE

    def pack(self, seq: int, now_ns: int, reading: JointStates) -> bytes:
        """Return the message with the number `seq`, stamped `now_ns` [ns]."""
        numbers = (number for values in reading[1:] for number in (len(values), *values))
        return self._layout.pack(
            self._size, seq, *divmod(now_ns, NANOSECONDS), self._names, *numbers
        )


class FrameLayout:
    """A message of a frame: its header, and numbers."""

    numbers: str  # as of `struct`

    def __init__(self, frame: str) -> None:
        """Note the name of the frame."""
        self._frame = _text(frame)
        self._layout = struct.Struct(f'<4I{len(self._frame)}s{self.numbers}')
        self._size = self._layout.size - _SIZE


class LaserScanLayout(FrameLayout):
    """sensor_msgs/LaserScan of a frame; the times within a scan are 0."""

    numbers = '7f'

    def pack(
        self,
        seq: int,
        now_ns: int,
        angles: Sequence[float],
        limits: Sequence[float],
        ranges: NDArray[np.float64],
        intensities: NDArray[np.float64],
    ) -> bytes:
        """Return the message with the number `seq`, stamped `now_ns` [ns].

        Args:
            angles: least, greatest and increment [rad].
            limits: least and greatest range [m].
        """
        size = self._size + 8 + 4 * (len(ranges) + len(intensities))
        head = self._layout.pack(
            size, seq, *divmod(now_ns, NANOSECONDS), self._frame, *angles, 0.0, 0.0, *limits
        )
        return head + floats(ranges) + floats(intensities)


class PointCloudLayout(FrameLayout):
    """sensor_msgs/PointCloud of a frame, with intensities in a channel without a name."""

    numbers = 'I'

    def pack(
        self,
        seq: int,
        now_ns: int,
        positions: NDArray[np.float64],
        intensities: NDArray[np.float64],
    ) -> bytes:
        """Return the message with the number `seq`, stamped `now_ns` [ns].

        Args:
            positions: (n, 3) [m] in the frame.
            intensities: (n,).
        """
        tail = (
            positions.astype('<f4').tobytes()
            + struct.pack('<I', 1)
            + _text('')
            + floats(intensities)
        )
        size, count = self._size + len(tail), len(positions)
        head = self._layout.pack(size, seq, *divmod(now_ns, NANOSECONDS), self._frame, count)
        return head + tail


class ImuLayout(FrameLayout):
    """sensor_msgs/Imu of a frame."""

    numbers = '4d9d3d9d3d9d'

    def pack(self, seq: int, now_ns: int, reading: ImuReading) -> bytes:
        """Return the message with the number `seq`, stamped `now_ns` [ns]."""
        covariances = [0.0] * 27  # row-major 3x3 each
        for i in range(3):
            covariances[9 * i : 9 * i + 9 : 4] = reading.variances[3 * i : 3 * i + 3]
        return self._layout.pack(
            self._size,
            seq,
            *divmod(now_ns, NANOSECONDS),
            self._frame,
            *reading.orientation,
            *covariances[:9],
            *reading.angular_velocity,
            *covariances[9:18],
            *reading.linear_acceleration,
            *covariances[18:],
        )


def floats(values: NDArray[np.float64]) -> bytes:
    """Return a list of float32, behind its length."""
    return struct.pack('<I', len(values)) + values.astype('<f4').tobytes()


def _text(text: str) -> bytes:
    data = text.encode()
    return struct.pack('<I', len(data)) + data


def _diagonal(variances: Sequence[float]) -> bytes:
    matrix = [0.0] * 36
    matrix[::7] = variances
    return _COVARIANCE.pack(*matrix)
