"""Encoder odometry agrees with the rotation of the wheels."""

import math

import pytest
from support import SETTLED, SPAWN_POSE, empty_world, package_directory, robot_urdf

from rosbots_description.sim.core.transforms import yaw_of
from rosbots_description.sim.formats.urdf.urdf import load_urdf
from rosbots_description.sim.runtime.scheduler import Hook

EXACT = 1e-6  # [m and rad]


class DeadReckoning(Hook):
    """Integrates the distances of two wheels from their joint positions."""

    def __init__(self, world, plugin):
        self._world, self._plugin = world, plugin
        self.x = self.y = self.yaw = 0.0
        self._ways = self._read()
        self.due = world.clock.steps + 1

    def before_step(self):
        before, self._ways = self._ways, self._read()
        left, right = (now - then for now, then in zip(self._ways, before, strict=True))
        turn = (right - left) / self._plugin.wheel_separation
        forward, heading = (left + right) / 2.0, self.yaw + turn / 2.0
        self.x += forward * math.cos(heading)
        self.y += forward * math.sin(heading)
        self.yaw += turn
        self.due = self._world.clock.steps + 1

    def _read(self):
        radius = self._plugin.wheel_diameter / 2.0
        return [wheel.position * radius for wheel in self._plugin.wheels]


@pytest.mark.parametrize('command', [(0.5, 0.0), (0.3, -0.8), (-0.4, 0.2)])
def test_encoder_odometry_is_the_dead_reckoning_of_the_wheels(command):
    text = robot_urdf().replace('</plugin>', '<odometrySource>encoder</odometrySource></plugin>')
    spec = load_urdf(text, 'rosbots', robot_namespace='/', find_package=package_directory)[0]
    with empty_world() as world:
        model = world.spawn(spec, 'rosbots', SPAWN_POSE)
        plugin = next(iter(model.plugins.values()))
        world.run(SETTLED)
        plugin.reset()  # both start here
        reckoned = DeadReckoning(world, plugin)
        world.schedule.add(reckoned)
        apart = []

        def compare(odometry):
            (x, y, _), orientation = odometry.pose
            # The plugin runs first in a step, so the dead reckoning is one step behind.
            reckoned.before_step()
            turned = math.remainder(yaw_of(orientation) - reckoned.yaw, 2.0 * math.pi)
            apart.append(max(abs(x - reckoned.x), abs(y - reckoned.y), abs(turned)))

        plugin.odometry.connect(compare)
        plugin.command(*command)
        world.run(4000)
        assert len(apart) == 399
        assert max(apart) < EXACT
