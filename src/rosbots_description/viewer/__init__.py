"""A World on the page of `web`, without ROS: in a browser, in a notebook, and as a recording."""

from .files import OpenedFile, open_file
from .notebook import show
from .recording import Recording
from .viewer import Viewer
from .window import Window

__all__ = ['OpenedFile', 'Recording', 'Viewer', 'Window', 'open_file', 'show']
