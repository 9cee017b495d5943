"""The topics of ray sensors.

Publishes:
    <ns>/<topicName> (sensor_msgs/LaserScan): laser and gpu_laser; rows of more than one, if there
        are any, from the lowest upward.
Parameters:
    tf_prefix, searched from the plugin's namespace upward.
"""

from sensor_msgs.msg import LaserScan

from ...sim.sensors import LaserPlugin, Scan
from ..messages import LaserScanLayout
from .adapter import Adapter
from .declarations import Pack, Publishes
from .registry import connects


def scan_pack(adapter: Adapter) -> Pack:
    """Return what lays scans out."""
    layout = LaserScanLayout(adapter.frame(adapter.plugin.params.values['frameName']))

    def pack(number: int, now_ns: int, scan: Scan) -> bytes:
        return layout.pack(number, now_ns, scan[2:5], scan[5:], scan.ranges, scan.intensities)

    return pack


connects(LaserPlugin, Publishes('scan', '<topicName>', LaserScan, pack=scan_pack))
