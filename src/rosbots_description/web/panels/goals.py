"""Goals and initial poses for navigation, set by two clicks on the ground."""

import math
from collections.abc import Callable, Collection, Sequence
from functools import partial
from typing import Protocol

import viser

from ...sim.core import Pose, SimError, Vector, compose, from_rpy, inverse, to_rpy
from ..controls import Choice, Panel, attempt
from ..scene import GroundClicks, Models

FRAMES = ('map', 'odom')  # of REP 105: the first that is known is that of the pose
GOAL, ESTIMATE = '2D Nav Goal', '2D Pose Estimate'  # RViz's names of its tools
HINTS = {GOAL: 'where a robot is to drive to', ESTIMATE: 'where a robot is, for its localisation'}


class Goals(Protocol):
    """Topics that take a pose."""

    def goal_topics(self) -> Sequence[str]:
        """Return the topics of goals that have subscribers."""

    def estimate_topics(self) -> Sequence[str]:
        """Return the topics of initial poses that have subscribers."""

    def locate(self, frame: str, links: Collection[str]) -> tuple[str, Pose] | None:
        """Return a link of these that TF connects a frame with, and the frame's pose in it.

        The first call begins to listen to TF.
        """

    def rest(self) -> None:
        """Listen no more."""

    def send_goal(self, topic: str, frame: str, pose: Pose) -> None:
        """Send a goal."""

    def send_estimate(self, topic: str, frame: str, pose: Pose) -> None:
        """Send an initial pose, with RViz's uncertainty."""


class GoalPanel(Panel):
    """Buttons that are there while somebody takes goals or initial poses."""

    def __init__(
        self,
        gui: viser.GuiApi,
        goals: Goals,
        models: Models,
        clicks: GroundClicks,
        notify: Callable[[str], None],
    ) -> None:
        self._tools = [
            Tool(gui, label, topics, send, goals, models, clicks, notify)
            for label, topics, send in (
                (GOAL, goals.goal_topics, goals.send_goal),
                (ESTIMATE, goals.estimate_topics, goals.send_estimate),
            )
        ]
        self._goals = goals

    def close(self) -> None:
        """Listen to TF no more."""
        self._goals.rest()

    def refresh(self) -> None:
        """Offer the topics that there are."""
        for tool in self._tools:
            tool.offer()


class Tool:
    """A button, and the topics of its poses."""

    def __init__(
        self,
        gui: viser.GuiApi,
        label: str,
        topics: Callable[[], Sequence[str]],
        send: Callable[[str, str, Pose], None],
        goals: Goals,
        models: Models,
        clicks: GroundClicks,
        notify: Callable[[str], None],
    ) -> None:
        self._label, self._topics, self._send = label, topics, send
        self._goals, self._models, self._clicks, self._notify = goals, models, clicks, notify
        self._offered: Sequence[str] = ()
        self._folder = gui.add_folder(None, visible=False)
        with self._folder:
            self._topic = Choice(gui, 'Topic', [''], hint=HINTS[label])
            gui.add_button(label, icon=viser.Icon.MAP_PIN, hint=HINTS[label]).on_click(self._begin)

    def offer(self) -> None:
        """Offer the topics that there are."""
        topics = tuple(self._topics())
        if topics != self._offered:
            self._offered = topics
            self._folder.visible = bool(topics)
            if topics:
                self._topic.offer(topics)

    def _begin(self, event: viser.GuiEvent[viser.GuiButtonHandle]) -> None:
        if event.client is not None:
            self._frame()  # it begins to listen to TF
            self._clicks.ask(
                event.client, f'{self._label}: click on the ground where it is.', self._take_point
            )

    def _take_point(self, client: viser.ClientHandle, point: Vector) -> None:
        self._clicks.mark(client, point)
        self._clicks.ask(
            client, 'Now click on what the robot is to face.', partial(self._take_direction, point)
        )

    def _take_direction(self, point: Vector, client: viser.ClientHandle, ahead: Vector) -> None:
        self._clicks.unmark(client)
        heading = math.atan2(ahead[1] - point[1], ahead[0] - point[0])
        attempt(partial(self._set, Pose(point, from_rpy(0.0, 0.0, heading))), self._notify)

    def _set(self, pose: Pose) -> None:
        """Send a pose in the world, in the frame of a robot's map."""
        topic = self._topic.value
        if topic not in self._offered:
            raise SimError(f'nobody takes a {self._label} any more')
        found = self._frame()
        if found is None:
            raise SimError(
                f'TF connects neither {" nor ".join(FRAMES)} with a robot, so nobody '
                'would know where that is'
            )
        frame, origin = found
        x, y, yaw = _flat(compose(inverse(origin), pose))
        self._send(topic, frame, Pose((x, y, 0.0), from_rpy(0.0, 0.0, yaw)))
        self._notify(f"{topic}: x {x:.2f} m, y {y:.2f} m, yaw {yaw:.2f} rad in '{frame}'")

    def _frame(self) -> tuple[str, Pose] | None:
        """Return the frame for poses, and its pose in the world."""
        links = self._models.links_for(self._topic.value)
        for frame in FRAMES:
            found = self._goals.locate(frame, links)
            if found is not None:
                link, pose = found
                return frame, compose(self._models.link_pose(links[link]), pose)
        return None


def _flat(pose: Pose) -> tuple[float, float, float]:
    return pose.position[0], pose.position[1], to_rpy(pose.orientation)[2]
