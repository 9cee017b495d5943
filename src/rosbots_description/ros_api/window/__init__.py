"""What the window in the browser needs of a simulator, a module for each of its panels."""

from .simulator import GazeboSimulator

__all__ = ['GazeboSimulator']
