"""The physics settings of a world, under the names of gazebo_msgs and with Gazebo's live values."""

import math
from dataclasses import astuple, dataclass, fields

from ..core import MIN_UPDATE_RATE, SimError, Vector

MIN_STEP_SIZE, MAX_STEP_SIZE = 1e-9, 10.0  # [s]; the clock counts nanoseconds
MAX_ITERATIONS = 10_000  # of the solver; more would only stall the simulation
MAX_CONTACTS = 10_000_000
MAX_GRAVITY = 1e6  # [m/s^2] where speeds of long steps stay finite


@dataclass(frozen=True)
class PhysicsSettings:
    """Step, rate and gravity, and the ODE fields of gazebo_msgs/ODEPhysics.

    The defaults are those that gazebo_ros 2.9.2 reports in an empty world of Gazebo 11. Of the
    ODE fields the engine applies `sor_pgs_iters`; the others have no counterpart in PyBullet and
    are only stored. `friction_cone` selects `cone_model` of SDF, sqrt(Fx^2 + Fy^2) <= mu N; else
    friction is limited along the world's x and y axes separately, as by ODE's default.
    """

    step_size: float = 0.001  # simulated time of one step [s]
    max_update_rate: float = 1000.0  # steps per wall second; 0: as fast as possible [Hz]
    gravity: Vector = (0.0, 0.0, -9.8)  # [m/s^2]
    auto_disable_bodies: bool = False
    sor_pgs_precon_iters: int = 0
    sor_pgs_iters: int = 50
    sor_pgs_w: float = 1.3
    sor_pgs_rms_error_tol: float = 0.0
    cfm: float = 0.0
    erp: float = 0.2
    contact_surface_layer: float = 0.001  # [m]
    contact_max_correcting_vel: float = 100.0  # [m/s]
    max_contacts: int = 20
    friction_cone: bool = False


def check_physics(physics: PhysicsSettings) -> None:
    """Reject settings that are not valid.

    Raises:
        SimError: a number is not finite or out of its range; the message says which.
    """
    for field, value in zip(fields(physics), astuple(physics), strict=True):
        if not all(map(math.isfinite, value if isinstance(value, tuple) else (value,))):
            raise SimError(f'{field.name} is {value}; it must be finite')
    for name, least, most, unit in (
        ('step_size', MIN_STEP_SIZE, MAX_STEP_SIZE, '[s]'),
        ('max_update_rate', 0.0, math.inf, '[Hz], where 0 is as fast as possible'),
        ('sor_pgs_iters', 0, MAX_ITERATIONS, ''),
        ('sor_pgs_precon_iters', 0, MAX_ITERATIONS, ''),
        ('max_contacts', 0, MAX_CONTACTS, ''),
    ):
        value = getattr(physics, name)
        if not least <= value <= most:
            words = f'from {least:g} to {most:g} {unit}'.rstrip()
            raise SimError(f'{name} is {value:g}; it must be {words}')
    if max(map(abs, physics.gravity)) > MAX_GRAVITY:
        raise SimError(f'gravity is {physics.gravity}; it must be at most {MAX_GRAVITY:g} [m/s^2]')
    if 0.0 < physics.max_update_rate < MIN_UPDATE_RATE:
        raise SimError(
            f'max_update_rate is {physics.max_update_rate:g}; it must be at least '
            f'{MIN_UPDATE_RATE:g} [Hz], or 0 for as fast as possible'
        )
