"""How a free rigid body turns in a time step: as PyBullet has it, and as keeps its energy.

All vectors lie along the principal axes of the body. There Euler's equations for a free body are
w' = -I^-1 (w x I w), in components a wx' = (b - c) wy wz and so on in turn.
"""

from .pose import Vector

_TRIES = 30  # of the iteration, which gains a digit or more in each below 100 rad/s
_EXACT = 1e-12


def lost_share(moments: Vector, velocity: Vector, step_size: float) -> float:
    """Return the share of its energy that PyBullet's step takes from a body, per second.

    By implicit Euler it is dt (w' I w') / (w I w).
    """
    (a, b, c), (x, y, z) = moments, velocity
    energy = a * x * x + b * y * y + c * z * z
    if energy <= 0.0 or min(moments) <= 0.0:
        return 0.0
    torque = ((b - c) * y * z, (c - a) * z * x, (a - b) * x * y)
    return step_size * sum(t * t / i for t, i in zip(torque, moments, strict=True)) / energy


def missing_torque(moments: Vector, velocity: Vector, step_size: float) -> Vector | None:
    """Return what makes PyBullet's step keep the energy of a free body [N m].

    PyBullet makes one Newton step of implicit Euler, which loses energy. The implicit midpoint rule
    keeps it, and the magnitude of the angular momentum.

    Args:
        moments: principal moments of inertia [kg m^2].
        velocity: angular velocity [rad/s].

    Returns:
        None if the body turns too far in a step to find it.
    """
    kept = _by_midpoint_rule(moments, velocity, step_size)
    if kept is None:
        return None
    given = _by_newton_step(moments, velocity, step_size)
    tx, ty, tz = (i * (k - g) / step_size for i, k, g in zip(moments, kept, given, strict=True))
    return (tx, ty, tz)


def _by_midpoint_rule(moments: Vector, velocity: Vector, step_size: float) -> Vector | None:
    (a, b, c), (x, y, z), half = moments, velocity, 0.5 * step_size
    p, q, r = half * (b - c) / a, half * (c - a) / b, half * (a - b) / c
    wx, wy, wz = velocity
    enough = _EXACT * max(abs(x), abs(y), abs(z))
    for _ in range(_TRIES):
        before = wx, wy, wz
        wx = x + p * wy * wz
        wy = y + q * wz * wx
        wz = z + r * wx * wy
        if abs(wx - before[0]) + abs(wy - before[1]) + abs(wz - before[2]) <= enough:
            return (2.0 * wx - x, 2.0 * wy - y, 2.0 * wz - z)
    return None


def _by_newton_step(moments: Vector, velocity: Vector, dt: float) -> Vector:
    """Return w - J^-1 f with f = dt (w x I w) and J = I + df/dw, solved by Cramer's rule."""
    (a, b, c), (x, y, z) = moments, velocity
    p, q, r = dt * (c - b), dt * (a - c), dt * (b - a)
    f, g, h = p * y * z, q * z * x, r * x * y
    # J = ((a, p z, p y), (q z, b, q x), (r y, r x, c))
    m, n, o = b * c - q * r * x * x, q * (c * z - r * x * y), r * (q * x * z - b * y)
    whole = a * m - p * z * n + p * y * o
    dx = f * m - p * z * (g * c - q * x * h) + p * y * (g * r * x - b * h)
    dy = a * (g * c - q * x * h) - f * n + p * y * (q * z * h - g * r * y)
    dz = a * (b * h - g * r * x) - p * z * (q * z * h - g * r * y) + f * o
    return (x - dx / whole, y - dy / whole, z - dz / whole)
