"""The plugin libraries of Gazebo, and the messages about those that are not available here."""

from difflib import get_close_matches

from .registry import known_filenames, library_name, sensor_plugin_class

PAGE = 'doc/gazebo_compatibility.md'
_CLOSE = 0.9  # similarity above which a name counts as misspelt

# Of gazebo_ros_pkgs; the built-in ones are looked up first.
_OF_GAZEBO_ROS = (
    'skid_steer_drive',
    'planar_move',
    'tricycle_drive',
    'joint_state_publisher',
    'joint_pose_trajectory',
    'laser',
    'gpu_laser',
    'block_laser',
    'range',
    'camera',
    'multicamera',
    'triggered_camera',
    'triggered_multicamera',
    'depth_camera',
    'openni_kinect',
    'prosilica',
    'imu',
    'imu_sensor',
    'p3d',
    'bumper',
    'ft_sensor',
    'f3d',
    'force',
    'hand_of_god',
    'elevator',
    'harness',
    'wheel_slip',
    'vacuum_gripper',
    'projector',
    'video',
    'control',
)


def missing_libraries() -> list[str]:
    """Return the file names of Gazebo's libraries that are known and not built in."""
    built_in = known_filenames()
    return [
        name
        for name in (f'libgazebo_ros_{short}.so' for short in _OF_GAZEBO_ROS)
        if name not in built_in
    ]


def library_remark(filename: str) -> str:
    """Return the remark about a plugin's library that is not loaded at its place.

    It distinguishes Gazebo's libraries, misspelt names and third-party libraries.
    """
    name, missing = library_name(filename), missing_libraries()
    if name in missing:
        return f'{name} is known but not supported yet'
    if name in known_filenames():
        place = 'a <sensor>' if sensor_plugin_class(name) else 'a <gazebo> or <model>'
        return f'{name} works only in {place}, not where it stands'
    close = get_close_matches(name[:100], [*known_filenames(), *missing], 1, _CLOSE)
    cure = f"did you mean '{close[0]}'?" if close else 'nothing is loaded from GAZEBO_PLUGIN_PATH'
    return f"unknown library '{name}'; {cure}"
