"""Model plugins, chosen by the library name that a description gives; importing registers them."""

from .base import ModelPlugin

__all__ = ['ModelPlugin']
