#!/usr/bin/env python3
"""Let move_base drive to one goal after another, and say how far from each the robot is then.

Usage: drive_to_goals.py X,Y[,YAW] …  in the frame map [m, m, rad]; without any, to five in the
rooms. The simulator says where the robot really is, so the frames map and world have to be one.
"""

import math
import socket
import sys
import xmlrpc.client
from http.client import HTTPException
from xml.parsers.expat import ExpatError

import actionlib
import rosgraph
import rospy
from actionlib_msgs.msg import GoalStatus
from gazebo_msgs.srv import GetModelState
from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal

# One in each room, and back
ROOMS = '1.5,1.5,1.57', '6,4.2,0', '5.2,-0.5,3.14', '0,4.5,-1.57', '0,0,0'


def parse(word):
    """Return x, y and yaw of a goal; ValueError if it is none."""
    numbers = [float(number) for number in word.split(',')]
    if len(numbers) not in (2, 3) or not all(map(math.isfinite, numbers)):
        raise ValueError
    return (*numbers, 0.0)[:3]


def drive_to(move_base, model_state, x, y, yaw):
    """Drive to a pose in the map; print and return whether move_base says that it got there."""
    goal, start = MoveBaseGoal(), rospy.Time.now()
    goal.target_pose.header.frame_id, goal.target_pose.header.stamp = 'map', start
    goal.target_pose.pose.position.x, goal.target_pose.pose.position.y = x, y
    goal.target_pose.pose.orientation.z = math.sin(yaw / 2)
    goal.target_pose.pose.orientation.w = math.cos(yaw / 2)
    state = move_base.send_goal_and_wait(goal)
    pose = model_state('rosbots', 'world').pose
    q = pose.orientation
    is_yaw = math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y**2 + q.z**2))
    print(
        f'{x:5.2f} {y:5.2f} {yaw:5.2f}: {GoalStatus.to_string(state)} '
        f'after {(rospy.Time.now() - start).to_sec():.1f} s, '
        f'{math.hypot(pose.position.x - x, pose.position.y - y):.3f} m and '
        f'{abs(math.remainder(is_yaw - yaw, math.tau)):.3f} rad from the goal',
        flush=True,
    )
    return state == GoalStatus.SUCCEEDED


def require_master():
    """End the program with a sentence if no ROS master answers; rospy would wait for ever."""
    socket.setdefaulttimeout(20.0)
    try:
        rosgraph.Master('/drive_to_goals').getUri()
    except (
        OSError,
        ValueError,
        HTTPException,
        xmlrpc.client.Error,
        ExpatError,
        rosgraph.MasterException,
    ):
        sys.exit(f'drive_to_goals.py: no ROS master answers at {rosgraph.get_master_uri()}')
    finally:
        socket.setdefaulttimeout(None)


def main():
    """Drive to the goals of the command line; return 1 if one was not reached."""
    words = rospy.myargv()[1:] or ROOMS
    try:
        goals = [parse(word) for word in words]
    except ValueError:
        sys.exit(f'drive_to_goals.py: a goal is X,Y or X,Y,YAW, not {" ".join(words)}')
    require_master()
    rospy.init_node('drive_to_goals')
    move_base = actionlib.SimpleActionClient('move_base', MoveBaseAction)
    move_base.wait_for_server()
    model_state = rospy.ServiceProxy('/gazebo/get_model_state', GetModelState)
    reached = sum(drive_to(move_base, model_state, *goal) for goal in goals)
    print(f'{reached} of {len(goals)} goals')
    return 0 if reached == len(goals) else 1


if __name__ == '__main__':
    try:
        sys.exit(main())
    except rospy.ROSInterruptException:
        sys.exit('drive_to_goals.py: stopped before the last goal')
    except (rospy.ROSException, rospy.ServiceException, OSError) as error:
        sys.exit(f'drive_to_goals.py: {error}')
