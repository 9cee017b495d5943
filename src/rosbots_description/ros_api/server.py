"""What services, topics and adapters work with."""

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field

from ..sim.world import World
from .loop import Loop
from .registrar import Registrar


@dataclass
class Server:
    """The simulator of one ROS node. Only commands given to `loop` may touch `world`."""

    world: World
    loop: Loop
    registrar: Registrar
    find_package: Callable[[str], str | None]
    lookups: Counter = field(default_factory=Counter)  # per model: found by get_model_state
