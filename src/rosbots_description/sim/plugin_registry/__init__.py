"""Which plugin libraries are known by name, and which class stands for each."""

from .gazebo_libraries import PAGE, library_remark, missing_libraries
from .registry import library_name, plugin_class, register

__all__ = [
    'PAGE', 'library_name', 'library_remark', 'missing_libraries', 'plugin_class', 'register',
]
