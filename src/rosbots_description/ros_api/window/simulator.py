"""The simulator as the window in the browser sees it."""

from .contacts import RosContacts
from .hands import RosHands
from .inspection import RosInspection
from .library import RosLibrary
from .robots import RosRobots
from .time_control import RosTimeControl
from .view import RosView
from .worlds import RosWorlds


class GazeboSimulator:
    """What `web.Page` asks for, over the topics and services of `gazebo`."""

    def __init__(self) -> None:
        self.view = RosView()
        self.time = RosTimeControl()
        self.robots = RosRobots()
        self.inspection = RosInspection()
        self.contacts = RosContacts()
        self.library = RosLibrary()
        self.hands = RosHands()
        self.worlds = RosWorlds()
