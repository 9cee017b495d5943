"""Every service and topic by name, type and MD5 sum; the ones that differ by parameter."""

from threading import Thread

import rospy
from gazebo_msgs.msg import PerformanceMetrics
from network import (
    OF_ROSOUT,
    OUR_SERVICES,
    OUR_TOPICS,
    PUBLISHED,
    SERVICES,
    SUBSCRIBED,
    services_of,
    type_of,
)
from rosbots_msgs.srv import Step
from sensor_msgs.msg import LaserScan
from simulator import SimulatorTest, proxy, topics_of, wait_until

from rosbots_description.ros_api.server.loop import MAX_LAG
from rosbots_description.ros_api.topics.performance import PERIOD

METRICS = '/gazebo/performance_metrics'
MANY_STEPS = 10 * 1000 * 1000  # with the robot, hours
CALLS = 10  # of another service meanwhile
MOST = 1.0 + MAX_LAG / PERIOD + 0.2  # real-time factor


RAY = (
    '<sensor name="{name}" type="ray"><update_rate>40</update_rate><ray><range><max>9</max>'
    '</range></ray>{plugin}</sensor>'
)
LASER = '<plugin name="p" filename="libgazebo_ros_laser.so"><topicName>{topic}</topicName></plugin>'
SENSORS = (
    '<robot name="bot"><link name="l"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/>'
    '</inertial></link><gazebo><static>true</static></gazebo><gazebo reference="l">'
    + RAY.format(name='read', plugin=LASER.format(topic='scan'))
    + RAY.format(name='unread', plugin=LASER.format(topic='other'))
    + RAY.format(name='bare', plugin='')
    + '</gazebo></robot>'
)


class NetworkTest(SimulatorTest):
    def test_services(self):
        wait_until(lambda: 'set_parameters' in services_of(), 'dynamic_reconfigure')
        self.assertEqual(services_of(), set(SERVICES) | OUR_SERVICES)
        for name, expected in SERVICES.items():
            with self.subTest(name):
                self.assertEqual(type_of(name), expected)
        self.assertEqual(type_of('step'), 'rosbots_msgs/Step')
        self.assertEqual(type_of('get_model_omissions'), 'rosbots_msgs/GetModelOmissions')

    def test_topics(self):
        wait_until(lambda: set(PUBLISHED) <= topics_of(), 'dynamic_reconfigure')
        self.assertEqual(
            topics_of() - OF_ROSOUT, set(PUBLISHED) | set(SUBSCRIBED) | OUR_TOPICS | {METRICS}
        )
        # rospy connects only where type and MD5 sum agree.
        ends = [rospy.Subscriber(name, kind) for name, kind in PUBLISHED.items()]
        ends += [rospy.Publisher(name, kind, queue_size=1) for name, kind in SUBSCRIBED.items()]
        self._connections += ends
        wait_until(lambda: all(end.get_num_connections() for end in ends), 'all connections')

    def test_performance_metrics(self):
        metrics = self.collect(METRICS, PerformanceMetrics)
        wait_until(lambda: len(metrics) > 10, 'two seconds of metrics')
        # Slower on a busy machine, which catches up at once; the benchmark measures the speed.
        wait_until(lambda: 0.0 < metrics[-1].real_time_factor < MOST, 'a real-time factor')
        self.assertEqual(metrics[-1].sensors, [])
        self.spawn('bot', SENSORS)
        self.collect('/scan', LaserScan)
        wait_until(lambda: any(one.sim_update_rate for one in metrics[-1].sensors), 'scans')
        read, unread, bare = metrics[-1].sensors
        self.assertEqual(
            (read.name, unread.name, bare.name),
            ('default::bot::l::read', 'default::bot::l::unread', 'default::bot::l::bare'),
        )
        self.assertAlmostEqual(read.sim_update_rate, 40.0, 6)
        self.assertEqual((unread.sim_update_rate, bare.sim_update_rate, bare.fps), (0.0, 0.0, -1.0))
        self.assertGreater(metrics[-1].header.stamp.to_sec(), metrics[0].header.stamp.to_sec())
        self.pause()
        metrics.clear()
        wait_until(lambda: len(metrics) > 3 and metrics[-1].real_time_factor == 0.0, 'a stop')

    def test_step_advances_paused_time_and_serves_other_calls_until_unpaused(self):
        step = proxy('step', Step)
        response = step(10)
        self.assertFalse(response.success)
        self.assertIn('pause_physics', response.status_message)
        self.spawn()
        self.pause()
        before = self.world().sim_time
        for steps in (0, 1, 999):
            response = step(steps)
            self.assertTrue(response.success)
        self.assertAlmostEqual(response.sim_time, before + 1.0, places=9)
        self.assertEqual(self.world().sim_time, response.sim_time)
        responses = []
        stepping = Thread(target=lambda: responses.append(step(MANY_STEPS)))
        stepping.start()
        wait_until(lambda: self.world().sim_time > before + 1.0, 'the first of them')
        other = step(1)
        self.assertFalse(other.success)
        self.assertIn('another caller', other.status_message)
        for _ in range(CALLS):  # that they are answered is the test: the steps take hours
            reached = self.world().sim_time
            self.assertLess(reached, before + 1.0 + MANY_STEPS / 1000)
        wait_until(lambda: self.world().sim_time > reached, 'further steps')
        self.unpause()
        stepping.join()
        self.assertFalse(responses[0].success)
        self.assertIn('was unpaused', responses[0].status_message)

    def test_equal_steps_give_equal_motion(self):
        step = proxy('step', Step)
        self.pause()
        self.spawn()
        ends = []
        for _ in range(2):
            self.reset_simulation()
            self.assertEqual(step(1500).sim_time, 1.5)
            ends.append(self.model_state('rosbots', '').pose)
        self.assertEqual(*ends)
        self.assertLess(ends[0].position.z, 0.0)
