"""Which topics each drive has: those that drive.py describes."""

from ...sim.plugins.diff_drive import DiffDrive
from ...sim.plugins.planar_move import PlanarMove
from ...sim.plugins.skid_steer_drive import SkidSteerDrive
from ...sim.plugins.tricycle_drive import TricycleDrive
from .drive import DriveAdapter, WheeledDriveAdapter
from .registry import adapter


@adapter(DiffDrive)
class DiffDriveAdapter(WheeledDriveAdapter):
    """Joins a `DiffDrive` to its topics; joint_states are right, left."""


@adapter(SkidSteerDrive)
class SkidSteerDriveAdapter(DriveAdapter):
    """Joins a `SkidSteerDrive` to its topics."""


@adapter(PlanarMove)
class PlanarMoveAdapter(DriveAdapter):
    """Joins a `PlanarMove` to its topics."""


@adapter(TricycleDrive)
class TricycleDriveAdapter(WheeledDriveAdapter):
    """Joins a `TricycleDrive` to its topics; joint_states have velocities and efforts."""
