"""Physics engines, one folder each, and the protocol through which the simulator uses them."""

from .bullet import make_engine
from .compiled_model import CompiledModel
from .crash_sandbox import CrashSandbox
from .engine import (
    CollisionName,
    Contact,
    EngineBody,
    EngineFactory,
    JointState,
    Motion,
    PhysicsEngine,
    Snapshot,
    Wrench,
)

__all__ = [
    'CollisionName',
    'CompiledModel',
    'Contact',
    'CrashSandbox',
    'EngineBody',
    'EngineFactory',
    'JointState',
    'Motion',
    'PhysicsEngine',
    'Snapshot',
    'Wrench',
    'make_engine',
]
