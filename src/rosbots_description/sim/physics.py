"""The physics settings of a world, under the names of gazebo_msgs and with Gazebo's live values."""

from dataclasses import dataclass

from .pose import Vector


@dataclass(frozen=True)
class PhysicsSettings:
    """Step, rate and gravity, and the ODE fields of gazebo_msgs/ODEPhysics.

    The defaults are those of an empty world in Gazebo 11 (contract 2.5). Of the ODE fields the
    engine applies `sor_pgs_iters`; the others have no counterpart in PyBullet and are kept.
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
