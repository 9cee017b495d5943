"""The window in the browser, on viser: what it shows and what it asks for, without ROS."""

from .page import Page, Simulator
from .site import Site, WindowError

__all__ = ['Page', 'Simulator', 'Site', 'WindowError']
