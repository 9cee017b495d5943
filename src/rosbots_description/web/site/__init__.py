"""The server of the page: who gets in, and what a browser may make it do."""

from .access import LOOPBACK
from .site import Site, WindowError

__all__ = ['LOOPBACK', 'Site', 'WindowError']
