"""The state that services, topics and adapters share."""

import threading
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field

from ...sim.physics import CrashSandbox
from ...sim.resources import FileSearch, FindModel, FindPackage
from ...sim.runtime import World
from ..transport import Registrar
from .loop import Loop
from .static_frames import StaticFrames


@dataclass
class Server:
    """The simulator of one ROS node. Only commands given to `loop` may touch `world`."""

    world: World
    loop: Loop
    registrar: Registrar
    find_package: FindPackage
    find_model: FindModel
    sandbox: CrashSandbox
    find_file: FileSearch = field(default_factory=FileSearch)
    static_frames: StaticFrames = field(default_factory=StaticFrames)  # of other nodes
    lookups: Counter[str] = field(default_factory=Counter)  # per model: found by get_model_state
    physics_listeners: list[Callable[[], None]] = field(default_factory=list)
    parameters: list[Callable[[], None]] = field(default_factory=list)  # write those that are ours
    stepping: threading.Lock = field(default_factory=threading.Lock)  # one caller of step at a time

    def physics_changed(self) -> None:
        """Notify the listeners that a service has changed the physics settings."""
        for listener in self.physics_listeners:
            listener()
