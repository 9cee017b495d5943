"""The client functions that other people's scripts import from controller_manager."""

from rosbots_simulator.ros_api.controller_programs.calls import (
    list_controller_types,
    list_controllers,
    load_controller,
    reload_libraries,
    start_controller,
    start_controllers,
    start_stop_controllers,
    stop_controller,
    stop_controllers,
    unload_controller,
)

__all__ = [
    'list_controller_types',
    'list_controllers',
    'load_controller',
    'reload_libraries',
    'start_controller',
    'start_controllers',
    'start_stop_controllers',
    'stop_controller',
    'stop_controllers',
    'unload_controller',
]
