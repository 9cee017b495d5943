"""Names, types and MD5 sums of services and topics, as in gazebo_ros 2.9.2."""

import rosgraph
import rospy
import rosservice
from dynamic_reconfigure.msg import Config, ConfigDescription
from gazebo_msgs.msg import LinkState, LinkStates, ModelState, ModelStates
from rosgraph_msgs.msg import Clock

EMPTY = ('std_srvs/Empty', 'd41d8cd98f00b204e9800998ecf8427e')
BODY = ('gazebo_msgs/BodyRequest', '5eade9afe7f232d78005bd0cafeab755')
JOINT = ('gazebo_msgs/JointRequest', '0be1351618e1dc030eb7959d9a4902de')
SPAWN = ('gazebo_msgs/SpawnModel', '9ed9c82c96abe1a00c3e8cdaeee24413')
SERVICES = {
    'apply_body_wrench': ('gazebo_msgs/ApplyBodyWrench', '585b9f9618aa0581b207e2f2d90866bc'),
    'apply_joint_effort': ('gazebo_msgs/ApplyJointEffort', 'c0039811b8cc919490b3cff748cdf46b'),
    'clear_body_wrenches': BODY,
    'clear_joint_forces': JOINT,
    'delete_light': ('gazebo_msgs/DeleteLight', 'ae11ea8100d536d5b92c2b5917abf912'),
    'delete_model': ('gazebo_msgs/DeleteModel', '9ce56b4e9e54616de25d796dc972a262'),
    'get_joint_properties': ('gazebo_msgs/GetJointProperties', '7b30be900f50aa21efec4a0ec92d91c9'),
    'get_light_properties': ('gazebo_msgs/GetLightProperties', 'df2cef87e13e2e6990e81e8aaa454c19'),
    'get_link_properties': ('gazebo_msgs/GetLinkProperties', '0e06a70386d0ee3fb880c02f23fcd821'),
    'get_link_state': ('gazebo_msgs/GetLinkState', '09d6c98cce97b35f7ab9bd70300657ab'),
    'get_loggers': ('roscpp/GetLoggers', '32e97e85527d4678a8f9279894bb64b0'),
    'get_model_properties': ('gazebo_msgs/GetModelProperties', '5717f7bd34ed990fa80e28b3015027a3'),
    'get_model_state': ('gazebo_msgs/GetModelState', '4c515e936d3319c9610c559c60bfc3d4'),
    'get_physics_properties': (
        'gazebo_msgs/GetPhysicsProperties',
        '575a5e74786981b7df2e3afc567693a6',
    ),
    'get_world_properties': ('gazebo_msgs/GetWorldProperties', '36bb0f2eccf4d8be971410c22818ba3f'),
    'pause_physics': EMPTY,
    'reset_simulation': EMPTY,
    'reset_world': EMPTY,
    'set_joint_properties': ('gazebo_msgs/SetJointProperties', '15a76e921b1410c698d82782ea5fa370'),
    'set_light_properties': ('gazebo_msgs/SetLightProperties', 'e6f13430c57278bb364aca53a1bf5ebf'),
    'set_link_properties': ('gazebo_msgs/SetLinkProperties', 'd534ce1b36ee99de0ffa806c3a6348f0'),
    'set_link_state': ('gazebo_msgs/SetLinkState', '8a5146eb66ae4d26b0860b08f3f271be'),
    'set_logger_level': ('roscpp/SetLoggerLevel', '51da076440d78ca1684d36c868df61ea'),
    'set_model_configuration': (
        'gazebo_msgs/SetModelConfiguration',
        '10e3139d3b669c40afc057d38956fff7',
    ),
    'set_model_state': ('gazebo_msgs/SetModelState', '5b3ab0281d4f5445def017e3a2e4a07b'),
    'set_parameters': ('dynamic_reconfigure/Reconfigure', 'bb125d226a21982a4a98760418dc2672'),
    'set_physics_properties': (
        'gazebo_msgs/SetPhysicsProperties',
        '97e2057080558ce4730434b5fae75c91',
    ),
    'spawn_sdf_model': SPAWN,
    'spawn_urdf_model': SPAWN,
    'unpause_physics': EMPTY,
}
PUBLISHED = {
    '/clock': Clock,
    '/gazebo/link_states': LinkStates,
    '/gazebo/model_states': ModelStates,
    '/gazebo/parameter_descriptions': ConfigDescription,
    '/gazebo/parameter_updates': Config,
}
SUBSCRIBED = {'/gazebo/set_link_state': LinkState, '/gazebo/set_model_state': ModelState}
OF_ROSOUT = {'/rosout'}  # /rosout_agg exists where roslaunch starts a master
OUR_TOPICS = {
    '/gazebo/visual_markers',
    '/gazebo/view/markers',
    '/gazebo/view/frames',
    '/gazebo/view/image_raw',
    '/gazebo/view/scene',
    '/gazebo/view/motion',
    '/gazebo/view/contacts',
    '/tf_static',
}
OUR_SERVICES = {
    'get_friction',
    'get_model_description',
    'get_model_library',
    'get_model_omissions',
    'hold_model',
    'insert_model',
    'save_world',
    'set_friction',
    'step',
}
# What the article's robot adds when it is spawned.
OF_ROBOT = {'/odom', '/joint_states', '/tf', '/part2_cmr/cmd_vel'}
PARAMETERS = {
    'auto_disable_bodies',
    'cfm',
    'contact_max_correcting_vel',
    'contact_surface_layer',
    'erp',
    'gravity_x',
    'gravity_y',
    'gravity_z',
    'max_contacts',
    'max_update_rate',
    'sor_pgs_iters',
    'sor_pgs_precon_iters',
    'sor_pgs_rms_error_tol',
    'sor_pgs_w',
    'time_step',
}


def services_of(node='/gazebo'):
    """Return the names of a node's services, without the node's name."""
    _, _, services = rospy.get_master().getSystemState()[2]
    return {name.removeprefix(f'{node}/') for name, nodes in services if node in nodes}


def type_and_sum(service):
    """Return the type and the MD5 sum of a service of the running server."""
    name = f'/gazebo/{service}'
    uri = rosgraph.Master(rospy.get_name()).lookupService(name)
    header = rosservice.get_service_headers(name, uri)
    return header['type'], header['md5sum']
