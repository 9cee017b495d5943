"""The window in the browser, on viser: what it shows and what it asks for, without ROS."""

from .access import LOOPBACK
from .change_panel import Inspection
from .contacts import Contacts
from .downloads import Worlds
from .drive import Robots
from .editor import Editor
from .goals import Goals
from .insert import Library
from .joints import Joints
from .maps import Maps
from .page import Page
from .plot import Signals
from .recorder import Recorder
from .simulator import Simulator
from .site import Site, WindowError
from .topics import ShownTopics

__all__ = [
    'LOOPBACK',
    'Contacts',
    'Editor',
    'Goals',
    'Inspection',
    'Joints',
    'Library',
    'Maps',
    'Page',
    'Recorder',
    'Robots',
    'ShownTopics',
    'Signals',
    'Simulator',
    'Site',
    'WindowError',
    'Worlds',
]
