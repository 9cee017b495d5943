"""The plugin libraries that descriptions name, and what to say of those that are not here."""

from difflib import get_close_matches

from .registry import known_filenames, library_name, sensor_plugin_class

PAGE = 'doc/gazebo_compatibility.md'
_CLOSE = 0.9  # similarity of a name that is misspelt; that of somebody else's library is less

# Of gazebo_ros_pkgs; those that are built in by now are looked for first.
_OF_GAZEBO_ROS = (
    'skid_steer_drive', 'planar_move', 'tricycle_drive', 'joint_state_publisher',
    'joint_pose_trajectory', 'laser', 'gpu_laser', 'block_laser', 'range', 'camera',
    'multicamera', 'triggered_camera', 'triggered_multicamera', 'depth_camera', 'openni_kinect',
    'prosilica', 'imu', 'imu_sensor', 'p3d', 'bumper', 'ft_sensor', 'f3d', 'force', 'hand_of_god',
    'elevator', 'harness', 'wheel_slip', 'vacuum_gripper', 'projector', 'video', 'control',
)


def missing_libraries() -> list[str]:
    """Return the file names of Gazebo's libraries that are known and not built in."""
    built_in = known_filenames()
    return [name for name in (f'libgazebo_ros_{short}.so' for short in _OF_GAZEBO_ROS)
            if name not in built_in]


def library_remark(filename: str) -> str:
    """Return what is to be said of a plugin's library that is not run where it is asked for.

    One that Gazebo has reads differently from one that is misspelt, and from anybody else's.
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
