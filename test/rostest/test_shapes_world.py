"""The world of shapes, as `empty_world.launch world_name:=worlds/shapes.world` starts it."""

import unittest

import rospy
from gazebo_msgs.msg import LinkStates, ModelStates
from gazebo_msgs.srv import GetLightProperties, GetModelProperties, GetWorldProperties
from simulator import DEADLINE, proxy

MODELS = ['ground_plane', 'box', 'sphere', 'cylinder']
PLACES = {'box': (2.5, 0.0, 0.5), 'sphere': (0.0, 1.5, 0.5), 'cylinder': (0.0, -1.5, 0.5)}
STILL = 0.01  # [m]; contacts with the ground allow some penetration


class ShapesWorldTest(unittest.TestCase):
    def test_models_are_in_the_order_of_the_file(self):
        world = proxy('get_world_properties', GetWorldProperties)()
        self.assertEqual(world.model_names, MODELS)
        self.assertEqual(
            rospy.wait_for_message('/gazebo/model_states', ModelStates, DEADLINE).name, MODELS
        )

    def test_links_are_at_the_poses_of_the_file(self):
        states = rospy.wait_for_message('/gazebo/link_states', LinkStates, DEADLINE)
        self.assertEqual(states.name, [f'{model}::link' for model in MODELS])
        for name, pose in zip(states.name, states.pose, strict=True):
            x, y, z = PLACES.get(name.removesuffix('::link'), (0.0, 0.0, 0.0))
            for measured, expected in (
                (pose.position.x, x),
                (pose.position.y, y),
                (pose.position.z, z),
            ):
                self.assertAlmostEqual(measured, expected, delta=STILL, msg=name)

    def test_only_the_ground_is_static(self):
        describe = proxy('get_model_properties', GetModelProperties)
        self.assertEqual(
            [describe(model).is_static for model in MODELS], [True, False, False, False]
        )

    def test_properties_of_the_sun(self):
        sun = proxy('get_light_properties', GetLightProperties)('sun')
        self.assertTrue(sun.success)
        self.assertAlmostEqual(sun.diffuse.r, 0.8, places=6)
