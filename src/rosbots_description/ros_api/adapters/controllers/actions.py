"""Actions: goals that a controller follows, by the protocol of actionlib.

Publishes:
    <action>/status (actionlib_msgs/GoalStatusArray, latched): at each change, and at 5 Hz
    <action>/feedback and <action>/result
Subscribes:
    <action>/goal and <action>/cancel (actionlib_msgs/GoalID)

actionlib's own server stamps by the clock of rospy, which is not the simulated time in this
process, and cannot be taken down: its thread ends with the process.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import rospy
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray
from genpy import Message, Time
from std_msgs.msg import Header

from ....sim.controllers import ABORTED, ACTIVE, CANCELED, REJECTED, SUCCEEDED, Goal
from ....sim.core import NANOSECONDS
from ....sim.runtime import NEVER, Hook
from ...messages import stamp
from ...transport import has_subscribers
from ..adapter import Adapter
from ..declarations import Endpoint

QUEUE = 50  # as actionlib
STATUS_PERIOD_NS = NANOSECONDS // 5
REMEMBERED_NS = 5 * NANOSECONDS  # how long the status of a goal is published after its end
MOST_REMEMBERED = 100  # goals that have ended
_NUMBERS = {
    ACTIVE: GoalStatus.ACTIVE,
    SUCCEEDED: GoalStatus.SUCCEEDED,
    ABORTED: GoalStatus.ABORTED,
    CANCELED: GoalStatus.PREEMPTED,
    REJECTED: GoalStatus.REJECTED,
}
_TOO_LATE = (
    'This goal handle was canceled by the action server because its timestamp is before '
    'the timestamp of the last cancel request'
)


@dataclass(frozen=True)
class Acts:
    """An action of a controller."""

    action: type[Message]
    follow: Callable[[Any, Any], Goal]  # controller, goal message -> followed goal
    cancel: Callable[[Any, Any], None]  # controller, followed goal
    result: Callable[[Any], Message]  # followed goal -> message
    # Reading of the followed goal's output `feedback` -> message; None: it has no such output.
    feedback: Callable[[Any], Message] | None = None

    def __call__(self, adapter: Adapter) -> 'ActionServer':
        """Return the server of the adapter's controller."""
        return ActionServer(adapter, self)


class _Goal:
    """A goal that was received; `followed` is None if it was not passed on."""

    def __init__(self, status: GoalStatus, followed: Goal | None = None) -> None:
        self.status, self.followed = status, followed
        self.ended_ns: int | None = None


class ActionServer(Endpoint, Hook):
    """Passes goals on to a controller; its state is used on the world's thread only."""

    def __init__(self, adapter: Adapter, declared: Acts) -> None:
        super().__init__(adapter, adapter.plugin.topic_names['follow'])
        self._declared = declared
        self._world = adapter.server.world
        self._goals: dict[str, _Goal] = {}
        self._last_cancel = Time()
        self._received = 0
        self._is_scheduled = False

    def open(self) -> None:
        """Advertise and subscribe."""
        adapter, name, parts = self.adapter, self.name, self._declared.action()
        goal, result, feedback = (
            type(getattr(parts, f'action_{part}')) for part in ('goal', 'result', 'feedback')
        )
        self._result = adapter.advertise(f'{name}/result', result, QUEUE)
        self._feedback = adapter.advertise(f'{name}/feedback', feedback, QUEUE)
        self._status = adapter.advertise(f'{name}/status', GoalStatusArray, QUEUE, latch=True)
        post = adapter.server.loop.post
        adapter.subscribe(f'{name}/goal', goal, lambda m: post(lambda: self._take(m)), QUEUE)
        adapter.subscribe(f'{name}/cancel', GoalID, lambda m: post(lambda: self._cancel(m)), QUEUE)

    def refresh(self) -> None:
        """Publish the status, and again while it has subscribers."""
        if not self._is_scheduled:
            self._is_scheduled = True
            self._world.schedule.add(self)
        self._publish_status()

    def disconnect(self) -> None:
        """Publish nothing any more."""
        if self._is_scheduled:
            self._is_scheduled = False
            self._world.schedule.remove(self)

    def before_step(self) -> None:
        """Publish the status."""
        self._publish_status()

    def _take(self, message: Message) -> None:
        """Pass a goal on."""
        if not self._is_scheduled:  # the robot or the controller was removed
            return
        given = message.goal_id
        now_ns = self._world.clock.now_ns
        if not given.id:
            self._received += 1
            given.id = f'{rospy.get_name()}-{self._received}-{now_ns / NANOSECONDS:.9f}'
        if given.id in self._goals:
            return
        if not given.stamp:
            given.stamp = stamp(now_ns)
        elif self._last_cancel and given.stamp <= self._last_cancel:
            goal = self._goals[given.id] = _Goal(GoalStatus(given, GoalStatus.RECALLED, _TOO_LATE))
            self._close(goal, self._declared.action().action_result.result)
            return
        followed = self._declared.follow(self.adapter.plugin, message.goal)
        goal = self._goals[given.id] = _Goal(GoalStatus(given, GoalStatus.ACTIVE, ''), followed)
        if followed.is_active:
            if (convert := self._declared.feedback) is not None:
                followed.feedback.connect(  # type: ignore[attr-defined]
                    lambda reading: self._publish(self._feedback, goal, convert(reading))
                )
            followed.done.connect(lambda _followed: self._finish(goal))
            self._publish_status()
        else:
            self._finish(goal)

    def _cancel(self, message: GoalID) -> None:
        """Cancel the goal of that id, those up to that time, or all if neither is given."""
        everything = not message.id and not message.stamp
        for goal in list(self._goals.values()):
            own = goal.status.goal_id
            if (
                goal.ended_ns is None
                and goal.followed is not None
                and (
                    everything
                    or own.id == message.id
                    or (message.stamp and own.stamp <= message.stamp)
                )
            ):
                self._declared.cancel(self.adapter.plugin, goal.followed)
        self._last_cancel = max(self._last_cancel, message.stamp)

    def _finish(self, goal: _Goal) -> None:
        assert goal.followed is not None
        goal.status.status = _NUMBERS[goal.followed.status]
        self._close(goal, self._declared.result(goal.followed))

    def _close(self, goal: _Goal, result: Message) -> None:
        goal.ended_ns = self._world.clock.now_ns
        self._publish(self._result, goal, result)
        self._publish_status()

    def _publish(self, publisher: rospy.Publisher | None, goal: _Goal, content: Message) -> None:
        if publisher is not None:
            publisher.publish(
                publisher.data_class(
                    Header(stamp=stamp(self._world.clock.now_ns)), goal.status, content
                )
            )

    def _publish_status(self) -> None:
        clock, publisher = self._world.clock, self._status
        now_ns = clock.now_ns
        self._forget(now_ns)
        if publisher is not None:
            publisher.publish(
                GoalStatusArray(
                    Header(stamp=stamp(now_ns)), [one.status for one in self._goals.values()]
                )
            )
        self.due = (
            clock.first_step_after(now_ns + STATUS_PERIOD_NS - 1)
            if has_subscribers(publisher)
            else NEVER
        )

    def _forget(self, now_ns: int) -> None:
        """Drop goals that ended long ago, or before a reset of the time."""
        ended = [name for name, one in self._goals.items() if one.ended_ns is not None]
        for number, name in enumerate(ended):
            age = now_ns - (self._goals[name].ended_ns or 0)
            if number < len(ended) - MOST_REMEMBERED or not 0 <= age <= REMEMBERED_NS:
                del self._goals[name]
