"""Which topics stand for which plugin; importing registers the adapters."""

from . import contacts, drives, force, imus, lasers, state, wheel_slip, wrenches  # noqa: F401
from .registry import Adapters

__all__ = ['Adapters']
