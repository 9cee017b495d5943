"""The simulator: plain values and physics, without ROS. These are the names that a script needs.

Each is imported on first use: a script that needs only poses or errors does not load the engine.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .core import (
        Fault,
        Faults,
        ModelError,
        NotFoundError,
        PluginError,
        Pose,
        SimError,
        Twist,
        from_rpy,
        to_rpy,
        yaw_of,
    )
    from .description import PhysicsSettings
    from .public import World
    from .runtime import (
        FrameTransform,
        Joint,
        JointStates,
        Link,
        Model,
        Odometry,
        Output,
        SavedState,
    )

__all__ = [
    'Fault',
    'Faults',
    'FrameTransform',
    'Joint',
    'JointStates',
    'Link',
    'Model',
    'ModelError',
    'NotFoundError',
    'Odometry',
    'Output',
    'PhysicsSettings',
    'PluginError',
    'Pose',
    'SavedState',
    'SimError',
    'Twist',
    'World',
    'from_rpy',
    'to_rpy',
    'yaw_of',
]

_HOMES = {
    'description': ('PhysicsSettings',),
    'public': ('World',),
    'runtime': (
        'FrameTransform',
        'Joint',
        'JointStates',
        'Link',
        'Model',
        'Odometry',
        'Output',
        'SavedState',
    ),
}


def __getattr__(name: str) -> object:
    if name not in __all__:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    room = next((room for room, names in _HOMES.items() if name in names), 'core')
    return getattr(import_module(f'.{room}', __name__), name)
