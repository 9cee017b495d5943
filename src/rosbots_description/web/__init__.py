"""The window in the browser, on viser: what it shows and what it asks for, without ROS."""

from .door import LOOPBACK
from .page import Page, Simulator
from .site import Site, WindowError

__all__ = ['LOOPBACK', 'Page', 'Simulator', 'Site', 'WindowError']
