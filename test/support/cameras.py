"""What tests of cameras share: limits, robots, stamps, and the process that renders."""

from rosbots_description.sim.rendering.image_capture import renderer_of
from rosbots_description.sim.sensors.camera_plugins import CameraPlugin
from support.sensing import ROBOTS

LEVELS = 3  # of 255 that a face may differ
EDGES = 1e-4  # share of pixels on edges, where one of four samples may fall to the other side


def plugin_of(sensor):
    return next(
        one for one in sensor.model.parts if isinstance(one, CameraPlugin) and one.sensor is sensor
    )


def robot_with(old, new):
    """Return the recorded robot with a camera of 320 x 240 pixels, after a replacement."""
    text = (ROBOTS / 'camera_320.urdf').read_text(encoding='utf-8')
    assert old in text
    return text.replace(old, new)


def stamps(sensor):
    """Return a list that takes the stamp [ns] and the time [ns] of each picture from now on."""
    found = []
    sensor.readings.connect(
        lambda picture: found.append((picture.stamp_ns, sensor.world.clock.now_ns))
    )
    return found


def process_of(world):
    return renderer_of(world).process.process_id
