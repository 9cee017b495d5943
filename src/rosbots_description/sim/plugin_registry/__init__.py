"""Which plugin libraries and types of sensors are known, and which class stands for each."""

from .gazebo_libraries import PAGE, library_remark, missing_libraries
from .registry import (
    library_name,
    plugin_class,
    register,
    register_in_sensor,
    register_sensor,
    sensor_class,
    sensor_plugin_class,
)

__all__ = [
    'PAGE',
    'library_name',
    'library_remark',
    'missing_libraries',
    'plugin_class',
    'register',
    'register_in_sensor',
    'register_sensor',
    'sensor_class',
    'sensor_plugin_class',
]
