"""The running world: models, the schedule of hooks, and outputs."""

from .changes import NOTHING
from .empty_world import add_empty_world
from .model import CollisionFrame, Joint, Link, Model
from .outputs import FrameTransform, JointStates, Odometry, Output
from .plugin import Plugin
from .population import describe, populate
from .properties import collisions_named, set_friction, set_inertial
from .saved_state import SavedState
from .scheduler import NEVER, Hook, PreRunPublisher
from .sensor import SensorPart
from .shown_world import ShownWorld
from .world import WORLD_FRAMES, Entity, Listener, World

__all__ = [
    'NEVER',
    'NOTHING',
    'WORLD_FRAMES',
    'CollisionFrame',
    'Entity',
    'FrameTransform',
    'Hook',
    'Joint',
    'JointStates',
    'Link',
    'Listener',
    'Model',
    'Odometry',
    'Output',
    'Plugin',
    'PreRunPublisher',
    'SavedState',
    'SensorPart',
    'ShownWorld',
    'World',
    'add_empty_world',
    'collisions_named',
    'describe',
    'populate',
    'set_friction',
    'set_inertial',
]
