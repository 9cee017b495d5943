"""The topics, actions and services of ros_control's controllers.

What controllers alone need is imported when a robot has them.
"""

from . import ros_control  # noqa: F401  registers its plugins
