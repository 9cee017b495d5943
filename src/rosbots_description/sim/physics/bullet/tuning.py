"""What the engine is free to choose: the settings that nothing in a model or a world prescribes."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Tuning:
    """The choices of the engine. The defaults were measured (doc/physics.md, benchmark/physics.py).

    Attributes:
        iterations: of the solver, for each of Gazebo's `sor_pgs_iters`.
        friction_cone: whether friction is limited by its length, whatever a world says.
        exact_cylinders: whether cylinders are round; False makes them prisms of 32 edges.
        push_out: rate at which overlapping bodies are pushed apart [1/s].
    """

    iterations: float = 0.18
    friction_cone: bool = False
    exact_cylinders: bool = True
    push_out: float = 10.0
