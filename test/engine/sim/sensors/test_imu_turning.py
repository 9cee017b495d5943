"""An IMU 0.1 m before the middle of a robot that turns steadily, flat and tilted."""

import numpy as np
import pytest
from support.sensing import recordings, robot_text

from rosbots_description.sim.core.transforms import conjugate, from_rpy, rotate
from rosbots_description.sim.formats.urdf.urdf import load_urdf
from rosbots_description.sim.public.world import World

RECORDED = recordings('imu_turning')
MOUNTS = {'flat': (0.0, 0.0, 0.0), 'tilt': (0.2, -0.3, 0.5)}


@pytest.mark.parametrize('name', MOUNTS)
def test_turning_imu_measures_rate_and_centripetal_acceleration(name):
    text = robot_text(f'planar_imu_{name}')
    with World.empty() as world:
        model = world.spawn(load_urdf(text, 'bot', robot_namespace='/')[0], 'bot')
        world.run(500)
        model.plugin('planar_move').command(0.5, 1.0)
        world.run(1500)
        found, turning, forward = [], [], []
        model.plugin('imu_sensor').outputs['imu'].connect(
            lambda reading: found.append((*reading.angular_velocity, *reading.linear_acceleration))
        )
        for _ in range(100):
            world.run(10)
            turning.append(model.twist.angular[2])
            forward.append(np.hypot(*model.twist.linear[:2]))
    # The first is of one step, within which friction brakes what planar_move has set.
    mean, w, v = np.mean(found[1:], axis=0), np.mean(turning[1:]), np.mean(forward[1:])
    back = conjugate(from_rpy(*MOUNTS[name]))
    assert mean[:3] == pytest.approx(rotate(back, (0.0, 0.0, w)), abs=2e-3)
    assert mean[3:] == pytest.approx(rotate(back, (-0.1 * w * w, v * w, 9.8)), abs=0.02)
    recorded = RECORDED[name]  # of a robot that friction shakes
    assert (np.abs(mean[:3] - recorded['w_mean']) < 1.5 * np.array(recorded['w_std'])).all()
    assert (np.abs(mean[3:] - recorded['a_mean']) < 0.5 * np.array(recorded['a_std'])).all()
