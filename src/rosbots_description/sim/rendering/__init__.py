"""Pictures of the world without a screen."""

from .camera import EYE, TARGET, View

__all__ = ['EYE', 'TARGET', 'View']
