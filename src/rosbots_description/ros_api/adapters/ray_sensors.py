"""The topics of ray sensors.

Publishes:
    <ns>/<topicName> (sensor_msgs/LaserScan): laser and gpu_laser; rows of more than one, if there
        are any, from the lowest upward.
    <ns>/<topicName> (sensor_msgs/PointCloud): block_laser, with one channel without a name.
    <ns>/<topicName> (sensor_msgs/Range): range.
    <ns>/<topicName> (sensor_msgs/PointCloud2): Velodyne's, with x, y, z, intensity, ring and time.
Parameters:
    tf_prefix, searched from the plugin's namespace upward.
"""

from sensor_msgs.msg import LaserScan, PointCloud, PointCloud2, PointField, Range

from ...sim.sensors import (
    BlockLaserPlugin,
    Distance,
    LaserPlugin,
    RangePlugin,
    RingCloud,
    VelodynePlugin,
)
from ..messages import LaserScanLayout, PointCloudLayout
from .adapter import Adapter
from .declarations import Publishes, Serializer
from .registry import declare_topics

_RING_FIELDS = [
    PointField(name, offset, PointField.UINT16 if name == 'ring' else PointField.FLOAT32, 1)
    for name, offset in (
        ('x', 0),
        ('y', 4),
        ('z', 8),
        ('intensity', 12),
        ('ring', 16),
        ('time', 18),
    )
]


def scan_serializer(adapter: Adapter) -> Serializer:
    """Return what lays scans out."""
    layout = LaserScanLayout(adapter.frame(adapter.text('<frameName>')))
    return lambda number, now_ns, scan: layout.pack(
        number, now_ns, scan[2:5], scan[5:], scan.ranges, scan.intensities
    )


def range_message(distance: Distance) -> Range:
    """Return the message of a range."""
    kind = Range.INFRARED if distance.is_infrared else Range.ULTRASOUND
    return Range(
        radiation_type=kind,
        field_of_view=distance.field_of_view,
        min_range=distance.range_min,
        max_range=distance.range_max,
        range=distance.range,
    )


def points_serializer(adapter: Adapter) -> Serializer:
    """Return what lays point clouds out."""
    layout = PointCloudLayout(adapter.frame(adapter.text('<frameName>')))
    return lambda number, now_ns, points: layout.pack(number, now_ns, *points)


def ring_cloud_message(cloud: RingCloud) -> PointCloud2:
    """Return the message of a point cloud with rings."""
    height, width = cloud.points.shape
    step = cloud.points.itemsize
    return PointCloud2(
        height=height,
        width=width,
        fields=_RING_FIELDS,
        point_step=step,
        row_step=step * width,
        data=cloud.points.tobytes(),
        is_dense=cloud.is_dense,
    )


declare_topics(LaserPlugin, Publishes('scan', LaserScan, serializer=scan_serializer))
declare_topics(RangePlugin, Publishes('range', Range, convert=range_message, frame='<frameName>'))
declare_topics(
    BlockLaserPlugin, Publishes('points', PointCloud, '<topicName>', serializer=points_serializer)
)
declare_topics(
    VelodynePlugin,
    Publishes('cloud', PointCloud2, '<topicName>', ring_cloud_message, frame='<frameName>'),
)
