"""Step size, update rate, gravity and solver: by service and by dynamic_reconfigure."""

import math
import time

import rospy
from dynamic_reconfigure.client import Client
from dynamic_reconfigure.msg import Config, ConfigDescription
from gazebo_msgs.msg import ODEPhysics
from gazebo_msgs.srv import GetPhysicsProperties, SetPhysicsProperties
from geometry_msgs.msg import Vector3
from network import PARAMETERS
from rosbots_msgs.srv import Step
from simulator import BOX, DEADLINE, SimulatorTest, pose, proxy, wait_until

from rosbots_description.ros_api.server.loop import MAX_LAG

LIVE = {
    'time_step': 0.001,
    'max_update_rate': 1000.0,
    'gravity_z': -9.8,
    'sor_pgs_iters': 50,
    'sor_pgs_w': 1.3,
    'erp': 0.2,
    'max_contacts': 20,
    'contact_max_correcting_vel': 100.0,
}
FREE = 1.5  # real-time factor that only a simulator without a limit reaches


def numbers(config):
    """Return a Config message's values by name."""
    return {p.name: p.value for p in config.bools + config.ints + config.doubles}


class PhysicsSettingsTest(SimulatorTest):
    def setUp(self):
        super().setUp()
        self.get = proxy('get_physics_properties', GetPhysicsProperties)
        self.set = proxy('set_physics_properties', SetPhysicsProperties)
        self._before = self.get()
        self.assertTrue(self._before.success)

    def tearDown(self):
        before = self._before
        self.set(before.time_step, before.max_update_rate, before.gravity, before.ode_config)
        super().tearDown()

    def _set(self, time_step=0.001, rate=1000.0, gravity=(0.0, 0.0, -9.8), ode=None):
        response = self.set(time_step, rate, Vector3(*gravity), ode or self._before.ode_config)
        return response.success, response.status_message

    def test_defaults_in_an_empty_world(self):
        now = self._before
        self.assertEqual(now.status_message, 'GetPhysicsProperties: got properties')
        self.assertEqual((now.time_step, now.max_update_rate, now.pause), (0.001, 1000.0, False))
        self.assertEqual(now.gravity, Vector3(0.0, 0.0, -9.8))
        self.assertEqual(
            now.ode_config,
            ODEPhysics(
                sor_pgs_iters=50,
                sor_pgs_w=1.3,
                contact_surface_layer=0.001,
                contact_max_correcting_vel=100.0,
                erp=0.2,
                max_contacts=20,
            ),
        )

    def test_every_field_is_kept(self):
        ode = ODEPhysics(True, 1, 30, 1.1, 0.5, 0.002, 50.0, 0.01, 0.3, 7)
        self.assertEqual(
            self._set(0.002, 500.0, (1.0, 2.0, 3.0), ode), (True, 'physics engine updated')
        )
        now = self.get()
        self.assertEqual((now.time_step, now.max_update_rate), (0.002, 500.0))
        self.assertEqual((now.gravity, now.ode_config), (Vector3(1.0, 2.0, 3.0), ode))

    def test_invalid_settings_are_rejected_and_change_nothing(self):
        endless = ODEPhysics(sor_pgs_iters=4_000_000_000)
        for settings, words in (
            ({'time_step': 0.0}, 'step_size is 0'),
            ({'time_step': -0.001}, 'step_size is -0.001'),
            ({'time_step': math.nan}, 'step_size is nan'),
            ({'time_step': 1e9}, 'step_size is 1e+09'),
            ({'rate': -1.0}, 'max_update_rate is -1'),
            ({'rate': 1e-300}, 'max_update_rate is 1e-300'),
            ({'gravity': (0.0, math.inf, 0.0)}, 'gravity is'),
            ({'ode': endless}, 'sor_pgs_iters is 4e+09'),
        ):
            with self.subTest(words):
                success, text = self._set(**settings)
                self.assertFalse(success)
                self.assertTrue(text.startswith(f'SetPhysicsProperties: Failure - {words}'), text)
        self.assertEqual(self.get(), self._before)

    def test_gravity_and_step_size_apply_from_the_next_step(self):
        self.pause()
        self.spawn('box', BOX, pose(z=50.0))
        step = proxy('step', Step)
        begin = step(100).sim_time
        self._set(gravity=(1.0, 0.0, 0.0))
        step(1000)
        twist = self.model_state('box', '').twist.linear
        self.assertAlmostEqual(twist.x, 1.0, places=6)
        self.assertAlmostEqual(twist.z, -0.98, places=6)
        self._set(0.005, gravity=(0.0, 0.0, 0.0))
        self.assertAlmostEqual(step(100).sim_time, begin + 1.5, places=9)
        self.assertTrue(self.get().pause)

    def test_update_rate_limits_the_real_time_factor(self):
        # A busy machine may be slower, but never faster than the rate.
        for rate, most in ((500.0, 0.51), (1000.0, 1.02)):
            self._set(rate=rate)
            self.assertLess(self._factor(), most, f'at {rate} Hz')
            self._set(rate=0.0)
            wait_until(lambda: self._factor() > FREE, 'time without a limit')
        self._set(rate=0.01)  # a step takes longer than the deadline of this wait
        self._set(rate=1000.0)
        simulated = self.world().sim_time
        wait_until(lambda: self.world().sim_time > simulated + 0.1, 'advance of time at once')

    def _factor(self):
        """Return a lower limit of the real-time factor over a second.

        The calls' time counts as wall time, and so does what the loop may catch up.
        """
        wall, simulated = time.monotonic(), self.world().sim_time
        wait_until(lambda: self.world().sim_time >= simulated + 1.0, 'a second')
        passed = self.world().sim_time - simulated
        return passed / (time.monotonic() - wall + MAX_LAG)

    def test_description_of_the_settings(self):
        heard = self.collect('/gazebo/parameter_descriptions', ConfigDescription)
        wait_until(heard.__len__, 'the latched description')
        description = heard[0]
        self.assertEqual(len(description.groups), 1)
        self.assertEqual([p.name for p in description.groups[0].parameters], list(PARAMETERS))
        default, least, most = map(numbers, (description.dflt, description.min, description.max))
        for parameter in description.groups[0].parameters:
            name = parameter.name
            self.assertEqual(
                (parameter.type, default[name], least[name], most[name]), PARAMETERS[name]
            )
            self.assertEqual(parameter.level, 1)

    def test_dynamic_reconfigure_shows_and_changes_the_settings(self):
        updates = self.collect('/gazebo/parameter_updates', Config)
        wait_until(updates.__len__, 'the latched settings')
        self.assertEqual(set(numbers(updates[0])), set(PARAMETERS))
        self._assert_shown(updates, LIVE)
        client = Client('/gazebo', timeout=DEADLINE)
        try:
            client.update_configuration({'gravity_z': -3.5, 'sor_pgs_iters': 40})
            now = self.get()
            self.assertEqual((now.gravity.z, now.ode_config.sor_pgs_iters), (-3.5, 40))
            self._assert_shown(updates, {'gravity_z': -3.5, 'sor_pgs_iters': 40})
            kept = client.update_configuration({'time_step': -5.0})  # clamped to 0, then rejected
            self.assertEqual(kept['time_step'], 0.001)
            self.assertEqual(self.get().time_step, 0.001)
        finally:
            client.close()
        # Changes by services are shown too, so that the next change does not undo them.
        self._set(gravity=(0.0, 0.0, -1.5))
        self._assert_shown(updates, {'gravity_z': -1.5, 'sor_pgs_iters': 50})

    def _assert_shown(self, updates, expected):
        def shown():
            return expected.items() <= numbers(updates[-1]).items() and all(
                rospy.get_param(f'/gazebo/{name}') == expected[name] for name in expected
            )

        wait_until(shown, f'{expected} as parameters and in the updates')
