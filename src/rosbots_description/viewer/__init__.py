"""A World on the page of `web`, without ROS: in a browser, in a notebook, and as a recording."""

from .files import open_file, open_sandbox
from .notebook import show
from .recording import Recording
from .viewer import Viewer
from .window import Window

__all__ = ['Recording', 'Viewer', 'Window', 'open_file', 'open_sandbox', 'show']
