"""Plugins that apply or change forces; importing registers them."""

from .force import Force
from .hand_of_god import HandOfGod
from .wheel_slip import WheelSlip

__all__ = ['Force', 'HandOfGod', 'WheelSlip']
