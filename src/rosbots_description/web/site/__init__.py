"""The server of the page: who gets in, and what a browser may make it do."""

from .access import LOOPBACK
from .site import Allow, Site, WindowError

__all__ = ['LOOPBACK', 'Allow', 'Site', 'WindowError']
