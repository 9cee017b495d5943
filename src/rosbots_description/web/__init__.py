"""The window in the browser, on viser: what it shows and what it asks for, without ROS."""

from .editing import Editor, Inspection, Library
from .page import Page
from .panels import Contacts, Goals, Joints, Maps, Robots, ShownTopics, Signals, Worlds
from .recorder import Recorder
from .simulator import Simulator
from .site import LOOPBACK, Site, WindowError

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
