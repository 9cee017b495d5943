#!/usr/bin/env python3
"""Measure the real-time factor of the arm of arm.launch, under effort control, in the whole server.

Seven joints follow trajectories by PIDs that give efforts, and a gripper holds a box, all at 1 kHz.
Four cases: it holds still, it moves, it holds the box, it moves with the box. The server runs
unthrottled; each window alternates with one of a bare PyBullet loop that steps the article's robot
(17 links). Their quotient, and the server's processor time, depend little on other load.
"""

from __future__ import annotations

import os
import runpy
import sys
from collections.abc import Callable, Sequence
from statistics import median
from typing import NamedTuple

import actionlib
import rospy
from article import ROOT
from control_msgs.msg import GripperCommand, GripperCommandAction, GripperCommandGoal
from gazebo_msgs.srv import GetModelState
from loops import Loop
from server import STEPS_PER_SECOND, Server, run_in_new_process, wait_until
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

LAUNCH = ('rosbots_description', 'arm.launch', 'gui:=false', 'demo:=false')
WINDOW = 0.5  # [s, wall]
ROUNDS = 8  # windows of each case
STROKE = 2.0  # [s, simulated] of a motion from one place to the other
STROKES = 100  # more than fit into a window
SETTLE = 3.0  # [s, simulated] until the arm stands
WIDE, SHUT, FORCE = 0.04, 0.0, 20.0  # of a finger [m], [N]
HEIGHT = 0.15  # of the grip above the floor [m]
LEFT, RIGHT = (0.4, 0.2, 0.25), (0.4, -0.2, 0.35)  # between which it moves [m]
TARGET = 8.0  # real-time factor of the slowest case

Place = tuple[float, float, float]


class Measured(NamedTuple):
    """The windows of a case: real-time factors of the server and of the bare loop, in pairs."""

    case: str
    pairs: Sequence[tuple[float, float]]
    cost: float  # processor time of the server [s] per simulated second
    load: float

    @property
    def middle(self) -> float:
        """Return the median of the server's real-time factors."""
        return median(ours for ours, _ in self.pairs)


class Arm:
    """Commands the arm of a server; positions are those of the grip in the world [m]."""

    def __init__(self, server: Server) -> None:
        """Wait until its controllers run."""
        self._server = server
        example = runpy.run_path(str(ROOT / 'scripts' / 'pick_and_place.py'))
        self._joints, self._reach = example['JOINTS'], example['reach']
        self._command = rospy.Publisher(
            '/arm/arm_controller/command', JointTrajectory, queue_size=1
        )
        self._gripper = actionlib.SimpleActionClient(
            '/arm/gripper_controller/gripper_cmd', GripperCommandAction
        )
        wait_until(self._command.get_num_connections, 'the controller of the arm')
        wait_until(lambda: self._gripper.wait_for_server(rospy.Duration(1)), 'the gripper')

    def follow(self, places: Sequence[Place], seconds: float) -> None:
        """Move through places, each `seconds` [s, simulated] after the one before."""
        self._command.publish(
            JointTrajectory(
                joint_names=self._joints,
                points=[
                    JointTrajectoryPoint(
                        positions=self._reach(*place),
                        velocities=[0.0] * 7,
                        time_from_start=rospy.Duration.from_sec(seconds * (number + 1)),
                    )
                    for number, place in enumerate(places)
                ],
            )
        )

    def move(self, place: Place) -> None:
        """Move to a place and stand there."""
        self.follow([place], STROKE)
        self._server.wait_simulated(STROKE + SETTLE)

    def swing(self) -> None:
        """Begin to move between two places, for longer than a window lasts."""
        self.follow([LEFT, RIGHT] * (STROKES // 2), STROKE)

    def grip(self, position: float) -> None:
        """Move the fingers until they are at a position [m] or stall."""
        self._gripper.send_goal_and_wait(GripperCommandGoal(GripperCommand(position, FORCE)))

    def box(self) -> Place:
        """Return where the box is."""
        state = self._server.service('get_model_state', GetModelState)('box', 'world')
        if not state.success:
            raise RuntimeError(state.status_message)
        return state.pose.position.x, state.pose.position.y, state.pose.position.z

    def take(self) -> None:
        """Take the box up.

        Raises:
            RuntimeError: it has not come along.
        """
        x, y, z = self.box()
        for height in (HEIGHT, z):
            self.move((x, y, height))
        self.grip(SHUT)
        self.move((x, y, HEIGHT))
        self.require_box()

    def require_box(self) -> None:
        """Raise a RuntimeError if the box is on the floor."""
        if (height := self.box()[2]) < HEIGHT / 2.0:
            raise RuntimeError(f'the arm has lost the box, which is {height:.3f} m above the floor')


def measure() -> list[Measured]:
    """Return all cases; starts a server, so it needs its own process."""
    with Server(launch=LAUNCH) as server, Loop('bare', 1, False) as bare:
        arm = Arm(server)
        server.unthrottle()
        bare.speed(0.0)  # wait until it is ready

        def windows(case: str, begin: Callable[[], object] = lambda: None) -> Measured:
            pairs, used, simulated = [], 0.0, 0.0
            for _ in range(ROUNDS):
                begin()
                server.wait_simulated(STROKE / 2.0)  # in motion, if it moves
                server.pause()
                used, simulated = used - server.cpu_seconds(), simulated - server.simulated()
                speed = server.speed(WINDOW)
                used, simulated = used + server.cpu_seconds(), simulated + server.simulated()
                pairs.append((speed / STEPS_PER_SECOND, bare.speed(WINDOW) / STEPS_PER_SECOND))
                server.unpause()
            return Measured(case, pairs, used / simulated, os.getloadavg()[0])

        arm.grip(WIDE)
        arm.move(LEFT)
        found = [windows('holds still'), windows('moves', arm.swing)]
        arm.take()
        found.append(windows('holds the box'))
        found.append(windows('moves the box', arm.swing))
        arm.require_box()
        return found


def table(found: Sequence[Measured]) -> str:
    """Return the table, and the slowest case."""
    rows = ['times real time    min  median     max   bare PyBullet  of bare  processor s/s  load']
    for case, pairs, cost, load in found:
        ours = [one for one, _ in pairs]
        rows.append(
            f'{case:15} {min(ours):6.1f} {median(ours):7.1f} {max(ours):7.1f} '
            f'{median(bare for _, bare in pairs):15.1f} '
            f'{median(one / bare for one, bare in pairs):8.2f} {cost:14.3f} {load:5.1f}'
        )
    worst = min(found, key=lambda one: one.middle)
    verdict = 'met' if worst.middle >= TARGET else 'NOT met'
    rows.append(
        f'slowest, while it {worst.case}: {worst.middle:.1f} times real time '
        f'(target {TARGET:g}: {verdict}), {1.0 / worst.cost:.1f} by its processor time'
    )
    return '\n'.join(rows)


def main() -> int:
    """Print the table; return the exit code."""
    print(
        'the arm of arm.launch, whole server, efforts at 1 kHz, no clients but its '
        'robot_state_publisher'
    )
    print(table(run_in_new_process(measure)))
    return 0


if __name__ == '__main__':
    sys.exit(main())
