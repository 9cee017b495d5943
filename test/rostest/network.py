"""Names and types of services and topics, as in gazebo_ros 2.9.2."""

import rosgraph
import rospy
import rosservice
from dynamic_reconfigure.msg import Config, ConfigDescription
from gazebo_msgs.msg import LinkState, LinkStates, ModelState, ModelStates
from rosgraph_msgs.msg import Clock
from roslib.message import get_service_class

SERVICES = {
    'apply_body_wrench': 'gazebo_msgs/ApplyBodyWrench',
    'apply_joint_effort': 'gazebo_msgs/ApplyJointEffort',
    'clear_body_wrenches': 'gazebo_msgs/BodyRequest',
    'clear_joint_forces': 'gazebo_msgs/JointRequest',
    'delete_light': 'gazebo_msgs/DeleteLight',
    'delete_model': 'gazebo_msgs/DeleteModel',
    'get_joint_properties': 'gazebo_msgs/GetJointProperties',
    'get_light_properties': 'gazebo_msgs/GetLightProperties',
    'get_link_properties': 'gazebo_msgs/GetLinkProperties',
    'get_link_state': 'gazebo_msgs/GetLinkState',
    'get_loggers': 'roscpp/GetLoggers',
    'get_model_properties': 'gazebo_msgs/GetModelProperties',
    'get_model_state': 'gazebo_msgs/GetModelState',
    'get_physics_properties': 'gazebo_msgs/GetPhysicsProperties',
    'get_world_properties': 'gazebo_msgs/GetWorldProperties',
    'pause_physics': 'std_srvs/Empty',
    'reset_simulation': 'std_srvs/Empty',
    'reset_world': 'std_srvs/Empty',
    'set_joint_properties': 'gazebo_msgs/SetJointProperties',
    'set_light_properties': 'gazebo_msgs/SetLightProperties',
    'set_link_properties': 'gazebo_msgs/SetLinkProperties',
    'set_link_state': 'gazebo_msgs/SetLinkState',
    'set_logger_level': 'roscpp/SetLoggerLevel',
    'set_model_configuration': 'gazebo_msgs/SetModelConfiguration',
    'set_model_state': 'gazebo_msgs/SetModelState',
    'set_parameters': 'dynamic_reconfigure/Reconfigure',
    'set_physics_properties': 'gazebo_msgs/SetPhysicsProperties',
    'spawn_sdf_model': 'gazebo_msgs/SpawnModel',
    'spawn_urdf_model': 'gazebo_msgs/SpawnModel',
    'unpause_physics': 'std_srvs/Empty',
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
# name: type, default, least, most (gazebo_ros/cfg/Physics.cfg), in the order of the description
PARAMETERS = {
    'time_step': ('double', 0.001, 0.0, 10.0),
    'max_update_rate': ('double', 60.0, 0.0, 1000.0),
    'gravity_x': ('double', 0.0, -100.0, 100.0),
    'gravity_y': ('double', 0.0, -100.0, 100.0),
    'gravity_z': ('double', -9.8, -100.0, 100.0),
    'auto_disable_bodies': ('bool', False, False, True),
    'sor_pgs_precon_iters': ('int', 0, 0, 10000),
    'sor_pgs_iters': ('int', 20, 0, 10000),
    'sor_pgs_w': ('double', 1.3, 0.0, 5.0),
    'sor_pgs_rms_error_tol': ('double', -1.0, -1.0, 10000.0),
    'cfm': ('double', 0.0, 0.0, 10.0),
    'erp': ('double', 0.2, 0.0, 10.0),
    'contact_surface_layer': ('double', 0.001, 0.0, 10.0),
    'contact_max_correcting_vel': ('double', 100.0, 0.0, 1e7),
    'max_contacts': ('int', 100, 0, 10000000),
}


def services_of(node='/gazebo'):
    """Return the names of a node's services, without the node's name."""
    _, _, services = rospy.get_master().getSystemState()[2]
    return {name.removeprefix(f'{node}/') for name, nodes in services if node in nodes}


def type_of(service):
    """Return the type of a service of the running server, with the MD5 sum that clients know.

    Those of gazebo_msgs are Gazebo's: see test/unit/test_companion_messages.py.
    """
    name = f'/gazebo/{service}'
    uri = rosgraph.Master(rospy.get_name()).lookupService(name)
    header = rosservice.get_service_headers(name, uri)
    known = get_service_class(header['type'])._md5sum
    assert header['md5sum'] == known, f'{name} has the MD5 sum {header["md5sum"]}, not {known}'
    return header['type']
