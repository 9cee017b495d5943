"""Plugins that apply or change forces; importing registers them."""

from . import force, hand_of_god, wheel_slip  # noqa: F401
from .force import Force
from .hand_of_god import HandOfGod
from .wheel_slip import WheelSlip

__all__ = ['Force', 'HandOfGod', 'WheelSlip']
