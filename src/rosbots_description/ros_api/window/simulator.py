"""The simulator as the window in the browser sees it."""

from ..messages import SENSOR_TYPES
from .contacts import RosContacts
from .editor import RosEditor
from .goals import RosGoals
from .inspection import RosInspection
from .joints import RosJoints
from .library import RosLibrary
from .maps import RosMaps
from .readings import RosReadings
from .robots import RosRobots
from .signals import RosSignals
from .time_control import RosTimeControl
from .topic_graph import TopicGraph
from .view import RosView
from .worlds import RosWorlds


class GazeboSimulator:
    """What `web.Page` asks for, over the topics and services of `gazebo`."""

    faults = None  # they are in its log; ROS has no place for them

    def __init__(self) -> None:
        topics = TopicGraph()
        self.view = RosView()
        self.time = RosTimeControl()
        self.robots = RosRobots(topics)
        self.joints = RosJoints(topics)
        self.inspection = RosInspection()
        self.contacts = RosContacts()
        self.library = RosLibrary()
        self.editor = RosEditor()
        self.worlds = RosWorlds()
        self.sensors = RosReadings(topics, SENSOR_TYPES)
        self.maps = RosMaps(topics)
        self.goals = RosGoals(topics)
        self.signals = RosSignals(topics)
