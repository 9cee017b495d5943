"""Plugins that change which forces act; importing registers them."""

from . import wheel_slip  # noqa: F401
from .wheel_slip import WheelSlip

__all__ = ['WheelSlip']
