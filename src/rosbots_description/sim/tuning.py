"""What the engine is free to choose: the settings that nothing in a model or a world prescribes."""

from dataclasses import dataclass

from .pose import Vector


@dataclass(frozen=True)
class Tuning:
    """The choices of the engine. The defaults were measured (doc/physics.md, benchmark/physics.py).

    Attributes:
        passes: solver passes for each of Gazebo's `sor_pgs_iters`.
        friction_cone: whether friction is limited by its length. False limits it along the world's
            x and y axis each, as Gazebo's ODE does: diagonally it can be 1.4 times as large.
        exact_cylinders: whether cylinders are round; False makes them prisms of 32 edges.
        push_out: rate at which overlapping bodies are pushed apart [1/s].
    """

    passes: float = 0.22
    friction_cone: bool = False
    exact_cylinders: bool = True
    push_out: float = 10.0

    def reach(self, direction: Vector) -> float:
        """Return how many times its limit friction can hold in a level direction, a unit vector."""
        return 1.0 if self.friction_cone else max(1.0, abs(direction[0]) + abs(direction[1]))
