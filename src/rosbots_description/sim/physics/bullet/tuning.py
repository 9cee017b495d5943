"""Engine settings that neither a model nor a world prescribes."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Tuning:
    """Engine settings. The defaults were measured (doc/physics.md, benchmark/physics.py).

    Attributes:
        iterations: solver iterations for each of Gazebo's `sor_pgs_iters`.
        friction_cone: whether all worlds use a friction cone, also those that set a pyramid.
        exact_cylinders: whether cylinders are exact; False makes them prisms of 32 edges.
        push_out: rate at which penetration is corrected [1/s].
        rest: time for which a body rests before it sleeps [s]; infinite: none ever does.
        residual: convergence threshold of the solver: squared change of velocity [m^2/s^2] in an
            iteration. With PyBullet's default, 1e-7, a robot on a slope creeps at 0.01 mm/s.
    """

    iterations: float = 0.2
    friction_cone: bool = False
    exact_cylinders: bool = True
    push_out: float = 10.0
    rest: float = 1.0
    residual: float = 1e-8
