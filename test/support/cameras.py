"""What tests of cameras share: limits, stamps, and the process that renders."""

from rosbots_description.sim.rendering.image_capture import renderer_of
from rosbots_description.sim.sensors.camera_plugins import CameraPlugin

LEVELS = 3  # of 255 that a face may differ
EDGES = 1e-4  # share of pixels on edges, where one of four samples may fall to the other side


def plugin_of(sensor):
    return next(
        one for one in sensor.model.parts if isinstance(one, CameraPlugin) and one.sensor is sensor
    )


def camera_sdf(inside='', rate='0'):
    """Return a static model of a camera `s` that looks along x, as SDF."""
    return (
        '<sdf version="1.6"><model name="m"><static>1</static><link name="l"><sensor name="s" '
        f'type="camera"><update_rate>{rate}</update_rate><camera>{inside}</camera></sensor>'
        '</link></model></sdf>'
    )


def stamps(sensor):
    """Return a list that takes the stamp [ns] and the time [ns] of each picture from now on."""
    found = []
    sensor.readings.connect(
        lambda picture: found.append((picture.stamp_ns, sensor.world.clock.now_ns))
    )
    return found


def process_of(world):
    return renderer_of(world).process.process_id
