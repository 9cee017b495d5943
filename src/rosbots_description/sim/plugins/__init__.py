"""Model plugins, chosen by the library name that a description gives; importing registers them."""

from . import drive, force  # noqa: F401
from .base import ModelPlugin

__all__ = ['ModelPlugin']
