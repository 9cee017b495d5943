#!/usr/bin/env python3
"""Topics, services and parameters are exactly Gazebo's, as in upstream's network test."""

import sys

import rospy
import rostest
from network import (
    OF_ROBOT,
    OF_ROSOUT,
    PARAMETERS,
    PUBLISHED,
    SERVICES,
    SUBSCRIBED,
    services_of,
    type_of,
)
from simulator import SENSOR_BOX, SimulatorTest, spawn_model, topics_of, wait_until

OF_GAZEBO = set(PUBLISHED) | set(SUBSCRIBED) | OF_ROSOUT


def nodes():
    """Return the names of all nodes that publish, subscribe or offer services."""
    return {
        node
        for entries in rospy.get_master().getSystemState()[2]
        for _, nodes in entries
        for node in nodes
    }


class WithoutExtensionsTest(SimulatorTest):
    def test_an_empty_world_and_the_robot_in_it(self):
        wait_until(lambda: 'set_parameters' in services_of(), 'dynamic_reconfigure')
        self.assertEqual(topics_of(), OF_GAZEBO)
        self.assertEqual({name: type_of(name) for name in services_of()}, SERVICES)
        self.assertEqual(len(SERVICES), 30)
        types = dict(rospy.get_master().getTopicTypes()[2])
        for name, message_class in {**PUBLISHED, **SUBSCRIBED}.items():
            self.assertEqual(types[name], message_class._type)
        self.assertEqual(nodes() - {rospy.get_name(), '/rosout'}, {'/gazebo'})
        parameters = set(rospy.get_param('/gazebo')) - {'extensions'}
        self.assertEqual(parameters, {*PARAMETERS, 'enable_ros_network'})
        self.assertIs(rospy.get_param('/use_sim_time'), True)
        self.spawn()
        self.assertEqual(topics_of(), OF_GAZEBO | OF_ROBOT)
        self.assertEqual(services_of(), set(SERVICES))

    def test_spawn_model_accepts_a_simulator_without_the_omissions_service(self):
        done = spawn_model('box', SENSOR_BOX)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn('Successfully spawned entity', done.stdout)
        self.assertNotIn('without', done.stdout + done.stderr)


if __name__ == '__main__':
    rospy.init_node('test_without_extensions', disable_rostime=True)
    rostest.rosrun('rosbots_description', 'without_extensions', WithoutExtensionsTest, sys.argv)
