"""Every outcome and text of the services as in gazebo_ros, and the effects of successful calls."""

import math

import rospy
import rosservice
from gazebo_msgs.msg import LinkState, ModelState, ODEJointProperties
from genpy.message import fill_message_args
from geometry_msgs.msg import Point, Pose, Quaternion, Twist, Vector3
from sensor_msgs.msg import Image
from simulator import BOX, GROUND, SimulatorTest, pose, proxy, wait_until
from std_msgs.msg import ColorRGBA

LINK = """<link name="{}">
  <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
</link>"""
ARM = f"""<robot name="arm">{LINK.format('base')}{LINK.format('rod')}{LINK.format('tip')}
<joint name="hinge" type="revolute">
  <parent link="base"/><child link="rod"/><axis xyz="0 0 1"/>
  <limit lower="-1" upper="1" effort="10" velocity="10"/>
</joint>
<joint name="weld" type="fixed"><parent link="rod"/><child link="tip"/></joint>
<gazebo reference="weld"><preserveFixedJoint>true</preserveFixedJoint></gazebo>
</robot>"""
SDF = """<sdf version="1.6"><model name="other">
  <pose>1 0 0 0 0 0</pose><static>true</static><link name="slab"/>
</model></sdf>"""
INCLUDE = """<sdf version="1.6"><world name="w"><include><uri>model://ground_plane</uri></include>
</world></sdf>"""
LIGHT = """<sdf version="1.6"><light type="point" name="other"><diffuse>1 0.5 0 1</diffuse></light>
</sdf>"""
PICTURE = 60.0  # [s, wall] timeout of an image
SPAWNED = 'SpawnModel: Successfully spawned entity'
NO_LINK = 'link not found, did you forget to scope the link by model name?'
NO_MODEL = 'model does not exist'
EXISTS = 'Failure - entity already exists.'
NO_FRAME = 'reference {} not found, did you forget to scope the {} by model name?'
NAN = 'nan; it must be a finite number'
# Of refusals: service, request, text behind the name of its type; with the models `arm` and `box`,
# paused.
REFUSALS = [
    ('get_model_properties', {'model_name': 'nope'}, NO_MODEL),
    ('get_model_state', {'model_name': 'nope'}, NO_MODEL),
    (
        'get_model_state',
        {'model_name': 'box', 'relative_entity_name': 'nope'},
        NO_FRAME.format('relative_entity_name', 'body'),
    ),
    ('get_joint_properties', {'joint_name': 'nope'}, 'joint not found'),
    ('get_link_properties', {'link_name': 'arm'}, NO_LINK),
    ('get_link_state', {'link_name': 'nope'}, NO_LINK),
    (
        'get_link_state',
        {'link_name': 'rod', 'reference_frame': 'nope'},
        NO_FRAME.format('reference_frame', 'link'),
    ),
    ('set_model_state', {'model_state': {'model_name': 'nope'}}, NO_MODEL),
    ('set_model_state', {'model_state': {'model_name': 'arm::rod'}}, NO_MODEL),
    (
        'set_model_state',
        {'model_state': {'model_name': 'box', 'reference_frame': 'odom'}},
        'specified reference frame entity does not exist',
    ),
    (
        'set_model_state',
        {'model_state': {'model_name': 'box', 'pose': {'position': {'x': math.nan}}}},
        f'Failure - model_state.pose.position.x is {NAN}',
    ),
    ('set_link_state', {'link_state': {'link_name': 'nope'}}, 'link does not exist'),
    ('set_link_state', {'link_state': {'link_name': 'rod', 'reference_frame': 'box'}}, 'failed'),
    ('set_model_configuration', {'model_name': 'nope'}, NO_MODEL),
    (
        'set_model_configuration',
        {'model_name': 'arm', 'joint_names': ['hinge']},
        'joint name and position list have different lengths',
    ),
    (
        'set_model_configuration',
        {'model_name': 'arm', 'joint_names': ['hinge'], 'joint_positions': [math.inf]},
        'Failure - joint_positions[0] is inf; it must be a finite number',
    ),
    ('set_joint_properties', {'joint_name': 'nope'}, 'joint not found'),
    (
        'set_joint_properties',
        {'joint_name': 'hinge', 'ode_joint_config': {'loStop': [2.0]}},
        "Failure - loStop 2 of joint 'hinge' is above hiStop 1",
    ),
    (
        'set_joint_properties',
        {'joint_name': 'hinge', 'ode_joint_config': {'damping': [-1.0]}},
        "Failure - damping of joint 'hinge' is -1; it must not be negative",
    ),
    ('set_link_properties', {'link_name': 'nope'}, NO_LINK),
    (
        'set_link_properties',
        {'link_name': 'box::body', 'mass': 0.0},
        "Failure - mass is 0.0; link 'box::body' moves, so it must be greater than zero [kg]",
    ),
    (
        'set_link_properties',
        {'link_name': 'box::body', 'mass': 1.0, 'ixx': -1.0},
        "Failure - the inertia tensor for link 'box::body' has a negative principal moment; give "
        'the tensor about the centre of mass [kg m^2]',
    ),
    (
        'set_link_properties',
        {'link_name': 'box::body', 'mass': 1.0, 'com': {'position': {'y': -1e308}}},
        "Failure - com.position of link 'box::body' is -1e+308 m from its frame; at most 1e+07 m "
        'are accepted',
    ),
    ('delete_model', {'model_name': 'nope'}, NO_MODEL),
    ('delete_model', {'model_name': ''}, NO_MODEL),
    (
        'delete_light',
        {'light_name': 'nope'},
        'Timeout reached while removing light "nope"',
    ),
    ('apply_body_wrench', {'body_name': 'nope'}, 'body does not exist'),
    (
        'apply_body_wrench',
        {'body_name': 'rod', 'reference_frame': 'nope'},
        'reference_frame not found',
    ),
    (
        'apply_body_wrench',
        {'body_name': 'rod', 'wrench': {'torque': {'z': math.nan}}},
        f'Failure - wrench.torque.z is {NAN}',
    ),
    ('apply_joint_effort', {'joint_name': 'nope'}, 'joint not found'),
    (
        'apply_joint_effort',
        {'joint_name': 'hinge', 'effort': math.nan},
        f'Failure - effort is {NAN}',
    ),
    (
        'spawn_sdf_model',
        {'model_name': 'new', 'model_xml': SDF, 'reference_frame': 'nope'},
        NO_FRAME.format('reference_frame', 'link'),
    ),
    ('spawn_sdf_model', {'model_name': 'box', 'model_xml': SDF}, EXISTS),
    ('spawn_urdf_model', {'model_name': 'box', 'model_xml': BOX}, EXISTS),
    ('spawn_sdf_model', {'model_name': 'sun', 'model_xml': LIGHT}, EXISTS),
]
# Refusals whose texts begin otherwise, whole.
OTHER_REFUSALS = [
    (
        'get_light_properties',
        {'light_name': 'nope'},
        'getLightProperties: Requested light nope not found!',
    ),
    (
        'set_light_properties',
        {'light_name': 'nope'},
        'setLightProperties: Requested light nope not found!',
    ),
    (
        'spawn_sdf_model',
        {'model_name': 'new', 'model_xml': 'hello world'},
        'GazeboRosApiPlugin SpawnModel Failure: input model_xml not SDF or URDF, '
        'or cannot be converted to Gazebo compatible format.',
    ),
]
# Of what is done: service, request, whole text.
DONE = [
    ('get_model_properties', {'model_name': 'arm'}, 'GetModelProperties: got properties'),
    ('get_joint_properties', {'joint_name': 'arm::hinge'}, 'GetJointProperties: got properties'),
    ('get_joint_properties', {'joint_name': 'weld'}, 'GetJointProperties: got properties'),
    ('get_link_properties', {'link_name': 'arm::rod'}, 'GetLinkProperties: got properties'),
    ('get_link_state', {'link_name': 'rod', 'reference_frame': 'map'}, 'GetLinkState: got state'),
    (
        'set_model_state',
        {'model_state': {'model_name': 'box', 'reference_frame': 'world'}},
        'SetModelState: set model state done',
    ),
    (
        'set_link_state',
        {'link_state': {'link_name': 'body', 'reference_frame': 'base'}},
        'SetLinkState: success',
    ),
    (
        'set_model_configuration',
        {'model_name': 'arm', 'joint_names': ['nope'], 'joint_positions': [1.0]},
        'SetModelConfiguration: success',
    ),
    ('set_joint_properties', {'joint_name': 'hinge'}, 'SetJointProperties: properties set'),
    (
        'set_link_properties',
        {'link_name': 'box::body', 'mass': 2.0, 'ixx': 1.0, 'iyy': 1.0, 'izz': 1.0},
        'SetLinkProperties: properties set',
    ),
    ('get_light_properties', {'light_name': 'sun'}, ''),
    ('apply_body_wrench', {'body_name': 'rod', 'reference_frame': 'arm::base'}, ''),
    ('apply_joint_effort', {'joint_name': 'hinge'}, 'ApplyJointEffort: effort set'),
    ('spawn_sdf_model', {'model_name': 'new', 'model_xml': SDF}, SPAWNED),
    ('spawn_sdf_model', {'model_name': 'newer', 'model_xml': BOX}, SPAWNED),
]


def filled(message, fields):
    """Return a message with fields as for rosservice."""
    fill_message_args(message, [fields])
    return message


class OutcomesTest(SimulatorTest):
    def setUp(self):
        super().setUp()
        self.pause()
        self._services = {}
        self.spawn('arm', ARM, pose(2.0, 0.0, 50.0))
        self.spawn('box', BOX, pose(0.0, 0.0, 50.0))

    def _service(self, name):
        """Return the class and the proxy of a service."""
        if name not in self._services:
            kind = rosservice.get_service_class_by_name(f'/gazebo/{name}')
            self._services[name] = kind, proxy(name, kind)
        return self._services[name]

    def _named(self, refusal):
        """Return a refusal with the name of the service's type before its text."""
        name, fields, text = refusal
        return name, fields, f'{self._service(name)[0].__name__}: {text}'

    def _call(self, name, **fields):
        kind, service = self._service(name)
        return service(filled(kind._request_class(), fields))

    def _done(self, name, **fields):
        response = self._call(name, **fields)
        self.assertTrue(response.success, response.status_message)
        return response

    def test_every_outcome(self):
        outcomes = [
            *((*refusal, False) for refusal in (*map(self._named, REFUSALS), *OTHER_REFUSALS)),
            *((*done, True) for done in DONE),
        ]
        for name, fields, text, success in outcomes:
            with self.subTest(f'{name} {fields}'):
                response = self._call(name, **fields)
                self.assertEqual((response.success, response.status_message), (success, text))
        for name, field in (
            ('clear_body_wrenches', 'body_name'),
            ('clear_joint_forces', 'joint_name'),
        ):
            self._call(name, **{field: 'nope'})

    def test_model_properties(self):
        arm = self._done('get_model_properties', model_name='arm')
        self.assertEqual(arm.body_names, ['base', 'rod', 'tip'])
        self.assertEqual(arm.joint_names, ['hinge', 'weld'])
        self.assertFalse(arm.is_static)
        ground = self._done('get_model_properties', model_name=GROUND)
        self.assertEqual(
            (ground.body_names, ground.geom_names, ground.joint_names),
            (['link'], ['collision'], []),
        )
        self.assertTrue(ground.is_static)
        for response in (arm, ground):
            self.assertEqual((response.canonical_body_name, response.parent_model_name), ('', ''))

    def test_model_state_is_set_in_a_frame(self):
        turned = Quaternion(0.0, 0.0, 2.0, 2.0)  # a quarter turn, not normalised
        self._set_model('box', Pose(Point(1.0, 2.0, 50.0), turned))
        state = ModelState(
            'arm',
            pose(3.0, 0.0, 1.0),
            Twist(Vector3(1.0, 0.0, 0.0), Vector3(0.0, 1.0, 0.0)),
            'box::body',
        )
        self.assertTrue(self._service('set_model_state')[1](state).success)
        arm = self.model_state('arm', '')
        for part, expected in (
            (arm.pose.position, (1.0, 5.0, 51.0)),
            (arm.twist.linear, (0.0, 1.0, 0.0)),
            (arm.twist.angular, (-1.0, 0.0, 0.0)),
        ):
            for axis, number in zip('xyz', expected, strict=True):
                self.assertAlmostEqual(getattr(part, axis), number, places=6)
        self._set_model('box', Pose(Point(0.0, 0.0, 50.0), Quaternion(0.0, 0.0, 0.0, 0.0)))
        self.assertEqual(self.model_state('box', '').pose.orientation.w, 1.0)

    def _set_model(self, name, where):
        _, set_state = self._service('set_model_state')
        self.assertTrue(set_state(ModelState(name, where, Twist(), '')).success)

    def test_states_by_topic(self):
        for topic, message, link in (
            ('set_model_state', ModelState('box', pose(7.0), Twist(), ''), 'body'),
            ('set_link_state', LinkState('base', pose(8.0), Twist(), 'world'), 'base'),
        ):
            publisher = self.publisher(f'/gazebo/{topic}', type(message))
            publisher.publish(type(message)())  # without a name: an error in the log
            publisher.publish(message)

            def there(link=link, x=message.pose.position.x):
                state = self._done('get_link_state', link_name=link).link_state
                return abs(state.pose.position.x - x) < 1e-6

            wait_until(there, f'{link} at the pose of {topic}')

    def test_first_image_has_the_viewpoint_of_the_parameters(self):
        sky = {'eye': [50.0, 50.0, 5.0], 'target': [60.0, 50.0, 60.0]}
        for name, place in sky.items():
            rospy.set_param(f'/gazebo/view/{name}', place)
            self.addCleanup(rospy.delete_param, f'/gazebo/view/{name}')
        picture = rospy.wait_for_message('/gazebo/view/image_raw', Image, PICTURE)
        self.assertEqual(set(picture.data), {178})  # the background

    def test_link_state_is_set_and_read_relative_to_another_link(self):
        self._done(
            'set_link_state',
            link_state={
                'link_name': 'base',
                'reference_frame': 'box::body',
                'pose': {'position': {'x': 4.0}, 'orientation': {'w': 1.0}},
                'twist': {'linear': {'y': 0.5}},
            },
        )
        state = self._done('get_link_state', link_name='arm::base', reference_frame='body')
        self.assertAlmostEqual(state.link_state.pose.position.x, 4.0, places=6)
        self.assertAlmostEqual(state.link_state.twist.linear.y, 0.5, places=6)
        self.assertEqual(state.link_state.link_name, 'arm::base')
        self.assertEqual(state.link_state.reference_frame, 'body')

    def test_joint_positions_are_set_within_their_limits(self):
        for asked, reached in ((0.5, 0.5), (3.0, 1.0), (-3.0, -1.0)):
            self._done(
                'set_model_configuration',
                model_name='arm',
                joint_names=['arm::hinge', 'nope'],
                joint_positions=[asked, 1.0],
            )
            joint = self._done('get_joint_properties', joint_name='hinge')
            self.assertAlmostEqual(joint.position[0], reached)
            self.assertEqual((len(joint.rate), joint.type, list(joint.damping)), (1, 0, []))
        limits = ODEJointProperties(hiStop=[2.0], damping=[0.1])
        self.assertTrue(self._service('set_joint_properties')[1]('hinge', limits).success)
        self._done(
            'set_model_configuration',
            model_name='arm',
            joint_names=['hinge'],
            joint_positions=[3.0],
        )
        joint = self._done('get_joint_properties', joint_name='hinge')
        self.assertAlmostEqual(joint.position[0], 2.0)

    def test_link_properties(self):
        changed = {
            'link_name': 'box::body',
            'mass': 3.0,
            'gravity_mode': False,
            'com': {'position': {'x': 0.1}},
            'ixx': 1.0,
            'iyy': 2.0,
            'izz': 2.5,
            'ixy': 0.1,
            'ixz': 0.0,
            'iyz': 0.0,
        }
        self._done('set_link_properties', **changed)
        told = self._done('get_link_properties', link_name='body')
        self.assertEqual(
            (told.mass, told.gravity_mode, told.com.position.x, told.ixy, told.izz),
            (3.0, False, 0.1, 0.1, 2.5),
        )
        self.assertEqual(told.com.orientation, Quaternion(0.0, 0.0, 0.0, 1.0))
        ground = self._done('get_link_properties', link_name='ground_plane::link')
        self.assertEqual((ground.mass, ground.gravity_mode), (1.0, True))

    def test_lights(self):
        sun = self._done('get_light_properties', light_name='sun')
        self.assertAlmostEqual(sun.diffuse.g, 0.8, places=6)
        self.assertEqual(sun.attenuation_constant, 0.9)
        self._done('spawn_sdf_model', model_name='lamp', model_xml=LIGHT)
        lamp = self._done('get_light_properties', light_name='lamp')
        self.assertEqual(lamp.diffuse, ColorRGBA(1.0, 0.5, 0.0, 1.0))
        self._done('set_light_properties', light_name='lamp', attenuation_linear=0.25)
        lamp = self._done('get_light_properties', light_name='lamp')
        self.assertEqual((lamp.diffuse, lamp.attenuation_linear), (ColorRGBA(), 0.25))
        response = self._call('delete_light', light_name='lamp')
        self.assertEqual(
            (response.success, response.status_message),
            (True, 'DeleteLight: lamp successfully deleted'),
        )
        self.assertFalse(self._call('delete_light', light_name='lamp').success)
        self.assertNotIn('lamp', self.world().model_names)

    def test_ground_can_be_deleted_and_included_again(self):
        self.assertTrue(self.delete(GROUND).success)
        self.unpause()
        self._set_model('box', pose(z=0.6))
        wait_until(lambda: self.model_state('box', '').pose.position.z < -1.0, 'falling')
        self._done('spawn_sdf_model', model_name=GROUND, model_xml=INCLUDE)
        self._set_model('box', pose(z=0.6))
        landed = self.world().sim_time + 1.0
        wait_until(lambda: self.world().sim_time > landed, 'a landing')
        box = self.model_state('box', '')
        self.assertAlmostEqual(box.pose.position.z, 0.5, delta=0.01)
        self.assertAlmostEqual(box.twist.linear.z, 0.0, delta=0.01)

    def test_pose_of_an_sdf_model_is_initial_pose_times_own_pose(self):
        where = {'position': {'y': 2.0}, 'orientation': {'z': 1.0, 'w': 1.0}}  # a quarter turn
        self._done('spawn_sdf_model', model_name='slab', model_xml=SDF, initial_pose=where)
        position = self.model_state('slab', '').pose.position
        self.assertAlmostEqual(position.x, 0.0, places=6)
        self.assertAlmostEqual(position.y, 3.0, places=6)
