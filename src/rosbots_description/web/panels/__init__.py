"""Panels that show the world or command it: one file for each."""

from .clock import Clock
from .contacts import Contacts, ContactsPanel
from .downloads import DownloadsPanel, Worlds
from .drive import DrivePanel, Robots, VelocityCommands
from .faults import FaultList, GetFaults
from .goals import GoalPanel, Goals
from .joints import JointPanel, Joints
from .joystick import Joystick
from .maps import MapPanel, Maps
from .overlay_panel import OverlayPanel, add_look
from .plot import PlotPanel, Signals
from .time_control import TimeControl, TimePanel
from .topics import ShownTopics, TopicPanel
from .tree import ModelTree

__all__ = [
    'Clock',
    'Contacts',
    'ContactsPanel',
    'DownloadsPanel',
    'DrivePanel',
    'FaultList',
    'GetFaults',
    'GoalPanel',
    'Goals',
    'JointPanel',
    'Joints',
    'Joystick',
    'MapPanel',
    'Maps',
    'ModelTree',
    'OverlayPanel',
    'PlotPanel',
    'Robots',
    'ShownTopics',
    'Signals',
    'TimeControl',
    'TimePanel',
    'TopicPanel',
    'VelocityCommands',
    'Worlds',
    'add_look',
]
