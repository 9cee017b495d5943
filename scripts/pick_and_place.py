#!/usr/bin/env python3
"""Pick a box up, put it onto another one, and end.

Calls:
    /gazebo/get_model_state (gazebo_msgs/GetModelState): where the boxes are.
Actions (called):
    arm_controller/follow_joint_trajectory (control_msgs/FollowJointTrajectoryAction)
    gripper_controller/gripper_cmd (control_msgs/GripperCommandAction)
Subscribes:
    arm_controller/state (control_msgs/JointTrajectoryControllerState): it has begun to run.
"""

import math

import actionlib
import rospy
from control_msgs.msg import (
    FollowJointTrajectoryAction,
    FollowJointTrajectoryGoal,
    GripperCommandAction,
    GripperCommandGoal,
    JointTrajectoryControllerState,
)
from gazebo_msgs.srv import GetModelState
from trajectory_msgs.msg import JointTrajectoryPoint

from rosbots_description.ros_api.clients.node_program import run_node

JOINTS = [f'joint{number}' for number in range(1, 8)]
SHOULDER, UPPER, FORE, HAND = 0.3, 0.4, 0.36, 0.18  # height; lengths, of the hand to the grip [m]
ABOVE = 0.13  # from which the hand comes down [m]
OPEN, CLOSED = 0.04, 0.0  # positions of a finger [m]
HALF_EDGES = 0.05 + 0.02  # of the stand and of the box [m]


def reach(x, y, z):
    """Return the joints' positions [rad] at which the hand grips x, y, z [m] from above.

    The elbow bends in the vertical plane through the goal: a triangle of three known sides.
    """
    far, high = math.hypot(x, y), z + HAND - SHOULDER
    cosine = (far**2 + high**2 - UPPER**2 - FORE**2) / (2 * UPPER * FORE)
    bend = math.acos(max(-1.0, min(1.0, cosine)))
    lean = math.atan2(far, high) - math.atan2(FORE * math.sin(bend), UPPER + FORE * math.cos(bend))
    return [math.atan2(y, x), lean, 0.0, bend, 0.0, math.pi - lean - bend, 0.0]


def main():
    """Do it."""
    rospy.init_node('pick_and_place')
    arm = actionlib.SimpleActionClient(
        'arm_controller/follow_joint_trajectory', FollowJointTrajectoryAction
    )
    gripper = actionlib.SimpleActionClient('gripper_controller/gripper_cmd', GripperCommandAction)
    model_state = rospy.ServiceProxy('/gazebo/get_model_state', GetModelState)
    rospy.wait_for_message('arm_controller/state', JointTrajectoryControllerState)
    arm.wait_for_server()
    gripper.wait_for_server()

    def move(seconds, x, y, z):
        goal = FollowJointTrajectoryGoal()
        goal.trajectory.joint_names = JOINTS
        goal.trajectory.points = [
            JointTrajectoryPoint(
                positions=reach(x, y, z),
                velocities=[0.0] * len(JOINTS),
                time_from_start=rospy.Duration.from_sec(seconds),
            )
        ]
        arm.send_goal_and_wait(goal)
        if arm.get_result().error_code:
            raise SystemExit(f'pick_and_place: {arm.get_result().error_string}')

    def grip(position):
        goal = GripperCommandGoal()
        goal.command.position, goal.command.max_effort = position, 20.0
        gripper.send_goal_and_wait(goal)

    def place_of(name):
        while not (state := model_state(name, 'world')).success:
            rospy.sleep(0.5)
        return state.pose.position.x, state.pose.position.y, state.pose.position.z

    grip(OPEN)
    for name, higher, finger in (('box', 0.0, CLOSED), ('stand', HALF_EDGES, OPEN)):
        x, y, z = place_of(name)
        move(2.0, x, y, z + higher + ABOVE)
        move(1.0, x, y, z + higher)
        grip(finger)
        move(1.0, x, y, z + higher + ABOVE)
    rospy.loginfo('The box is at %.3f, %.3f, %.3f', *place_of('box'))


if __name__ == '__main__':
    run_node(main)
