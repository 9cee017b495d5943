"""Closes and opens a gripper by one joint, until it is there or stalls.

Parameters, defaults and results are those of gripper_action_controller 0.22.
"""

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from .controller import RUNNING, Controller, nanoseconds, require_finite
from .errors import ControllerError, ResourceError
from .goal import ABORTED, CANCELED, REJECTED, SUCCEEDED, Goal
from .hardware import EFFORT, POSITION
from .registry import register_controller


class GripperResult(NamedTuple):
    """Position [rad or m] and effort [N m or N] of the joint, and why the action has ended."""

    position: float
    effort: float
    stalled: bool = False
    reached_goal: bool = False


class GripperGoal(Goal):
    """A command that is followed, or was."""

    result = GripperResult(0.0, 0.0)

    def finish(self, status: str, result: GripperResult | None = None) -> None:
        """End it."""
        self.result = result or self.result
        self.end(status)


@register_controller('effort_controllers/GripperActionController', EFFORT)
@register_controller('position_controllers/GripperActionController', POSITION)
class GripperActionController(Controller):
    """Move a joint to a position with at most an effort; the goal also ends when it stalls.

    On the effort interface a PID (gains/<joint>) drives the joint, and an effort of 0 is none.
    """

    topic_names: Mapping[str, str] = {'follow': 'gripper_cmd'}

    def load(self) -> None:
        """Read the parameters and find the joint."""
        read = self.params.read
        read('action_monitor_rate', 20.0)
        name = read('joint', '')
        if not name:
            raise ControllerError('Could not find joint name on param server')
        if name not in self.robot.control.joints:
            raise ControllerError(f"Could not find joint '{name}' in URDF model.")
        try:
            self.handle = self.joint(name)
        except ResourceError:
            raise ControllerError(f"Could not find joint '{name}' in '{self.interface}'.") from None
        self._tolerance = abs(read('goal_tolerance', 0.01))
        self._default_effort = abs(read('max_effort', 0.0))
        self._stall_velocity = read('stall_velocity_threshold', 0.001)
        self._stall_ns = nanoseconds(read('stall_timeout', 1.0))
        self._pid = self.pid(f'gains/{name}') if self.interface == EFFORT else None
        self._active: GripperGoal | None = None
        self._wanted, self._max_effort, self._effort = 0.0, self._default_effort, 0.0
        self._moved_ns = 0

    def starting(self, now_ns: int) -> None:
        """Hold the position."""
        self._hold()
        self._moved_ns = now_ns
        if self._pid is not None:
            self._pid.reset()
            self.handle.command = 0.0

    def stopping(self, now_ns: int) -> None:
        """Cancel the goal."""
        self._finish(CANCELED)

    def time_reset(self, now_ns: int) -> None:
        """Begin to watch for a stall again."""
        self._moved_ns = now_ns

    def command(self, position: float, max_effort: float | None = None) -> None:
        """Follow a command; see `follow`. Without an effort, that of the parameters is used."""
        self.follow(position, self._default_effort if max_effort is None else max_effort)

    def follow(self, position: float, max_effort: float) -> GripperGoal:
        """Follow a goal; the one before is canceled.

        Args:
            position: of the joint [rad or m].
            max_effort: [N m or N]; without effect on the position interface.
        Returns:
            the goal, which is rejected if the controller does not run.

        Raises:
            ValueError: a number is not finite.
        """
        require_finite((position, max_effort))
        goal = GripperGoal()
        if self.state != RUNNING:
            goal.finish(REJECTED)
            return goal
        self._finish(CANCELED)
        self._wanted, self._max_effort = float(position), abs(max_effort)
        self._moved_ns = self.world.clock.now_ns
        self._active = goal
        return goal

    def cancel(self, goal: GripperGoal) -> None:
        """Hold the position, if the joint follows this goal."""
        if self._active is goal:
            self._hold()
            self._finish(CANCELED)

    def update(self, now_ns: int, period: float) -> None:
        """Check the goal, and command the joint."""
        position, velocity = self.handle.position, self.handle.velocity
        error = self._wanted - position
        if self._active is not None:
            self._check(now_ns, error, position, velocity)
        if self._pid is None:
            self.handle.command, self._effort = self._wanted, self._max_effort
            return
        most = self._max_effort
        self._effort = min(max(self._pid.update(error, period, -velocity), -most), most)
        self.handle.command = self._effort

    def _check(self, now_ns: int, error: float, position: float, velocity: float) -> None:
        if abs(error) < self._tolerance:
            self._finish(SUCCEEDED, GripperResult(position, self._effort, reached_goal=True))
        elif abs(velocity) > self._stall_velocity:
            self._moved_ns = now_ns
        elif now_ns - self._moved_ns > self._stall_ns:
            self._finish(ABORTED, GripperResult(position, self._effort, stalled=True))

    def _hold(self) -> None:
        self._wanted, self._max_effort = self.handle.position, self._default_effort

    def _finish(self, status: str, result: GripperResult | None = None) -> None:
        goal, self._active = self._active, None
        if goal is not None:
            goal.finish(status, result)

    def parts(self) -> Iterable[object]:
        """Return the goal."""
        return () if self._active is None else (self._active,)

    def shared(self) -> Iterable[object]:
        """Also return the output of the goal."""
        yield from super().shared()
        if self._active is not None:
            yield self._active.done
