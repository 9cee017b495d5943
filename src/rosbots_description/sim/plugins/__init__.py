"""Model plugins, chosen by the library name that a description gives; importing registers them."""

from . import diff_drive, planar_move, skid_steer_drive, tricycle_drive, wheel_slip  # noqa: F401
