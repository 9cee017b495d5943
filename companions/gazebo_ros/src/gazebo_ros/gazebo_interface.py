"""The client functions that other people's scripts import from gazebo_ros."""

from rosbots_simulator.ros_api.clients.gazebo_interface import (
    set_model_configuration_client,
    spawn_sdf_model_client,
    spawn_urdf_model_client,
)

__all__ = [
    'set_model_configuration_client',
    'spawn_sdf_model_client',
    'spawn_urdf_model_client',
]
