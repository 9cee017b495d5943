#!/usr/bin/env python3
"""Measure the whole server on the wire, at its default rate, with a robot that drives.

odom, tf, joint_states and model_states are subscribed. Printed: real-time factor (to be 1.00 +-
0.01), messages per simulated second, the server's share of a core and its memory, how long start
and spawn take, and how long services take to answer.
"""

import os
import socket
import statistics
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import rosgraph
import rospy
import rosservice
from gazebo_msgs.msg import ModelStates
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage

from rosbots_description.cli.launched import Launched

SECONDS = 10.0  # [s, wall]
CALLS = 50  # of each service
SLOWEST = 5  # services to be named
# What an empty request would change for what comes after.
NOT_CALLED = {'spawn_urdf_model', 'spawn_sdf_model', 'set_physics_properties', 'pause_physics',
              'reset_world', 'reset_simulation', 'step'}
TOPICS = {
    '/odom': Odometry,
    '/tf': TFMessage,
    '/joint_states': JointState,
    '/gazebo/model_states': ModelStates,
}


def server_process() -> int:
    """Return the process number of the simulator of this master."""
    listing = subprocess.run(
        ['rosnode', 'info', '/gazebo'], capture_output=True, text=True, check=True
    )
    return int(listing.stdout.rsplit('Pid:', 1)[1].split()[0])


def cpu_seconds(process: int) -> float:
    """Return the processor time that a process has used so far [s]."""
    fields = Path(f'/proc/{process}/stat').read_text(encoding='ascii').rsplit(')', 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')


def measure() -> None:
    """Drive the robot and print what was measured; simulator and robot are there."""
    counts, stamps = Counter(), []
    for name, message_class in TOPICS.items():
        rospy.Subscriber(name, message_class, lambda _, name=name: counts.update([name]))
    rospy.Subscriber(
        '/odom', Odometry, lambda m: stamps.append((time.monotonic(), m.header.stamp.to_sec()))
    )
    publisher = rospy.Publisher('/part2_cmr/cmd_vel', Twist, queue_size=1)
    while not publisher.get_num_connections() or len(stamps) < 100:
        time.sleep(0.05)
    command = Twist()
    command.linear.x, command.angular.z = 0.5, 0.5
    publisher.publish(command)
    process = server_process()
    counts.clear()
    stamps.clear()
    used, begin = cpu_seconds(process), time.monotonic()
    time.sleep(SECONDS)
    used, elapsed = cpu_seconds(process) - used, time.monotonic() - begin
    simulated = stamps[-1][1] - stamps[0][1]
    print(f'real-time factor      {simulated / (stamps[-1][0] - stamps[0][0]):.4f}')
    for name in TOPICS:
        print(f'{name:21} {counts[name] / simulated:.0f} /s')
    print(f'processor             {100 * used / elapsed:.0f} % of a core')
    publisher.publish(Twist())  # what is measured after this is not to find it driving
    pages = int(Path(f'/proc/{process}/statm').read_text(encoding='ascii').split()[1])
    print(f'memory                {pages * os.sysconf("SC_PAGE_SIZE") / 1e6:.0f} MB')


def measure_services() -> None:
    """Print how long services take to answer while all stands; each is to stay below 10 ms."""
    times = []
    for name in rosservice.get_service_list(node='/gazebo'):
        if name.rsplit('/', 1)[1] in NOT_CALLED:
            continue
        service_class = rosservice.get_service_class_by_name(name)
        call = rospy.ServiceProxy(name, service_class, persistent=True)
        call()
        taken = []
        for _ in range(CALLS):
            begin = time.perf_counter()
            call()
            taken.append(time.perf_counter() - begin)
        call.close()
        times.append((statistics.median(taken), name))
    for median, name in sorted(times, reverse=True)[:SLOWEST]:
        print(f'{name:37} answers in {1000 * median:.2f} ms (median)')


def main() -> int:
    """Start everything on a master of its own, measure, end it; return the exit code."""
    with socket.socket() as probe:
        probe.bind(('localhost', 0))
        port = probe.getsockname()[1]
    os.environ.update(ROS_MASTER_URI=f'http://localhost:{port}', ROS_HOSTNAME='localhost')
    with tempfile.TemporaryDirectory() as folder:
        logs = Path(folder)
        begin = time.monotonic()
        world = ['gazebo_ros', 'empty_world.launch', 'gui:=false']
        with Launched(world, logs / 'server.log', os.environ):
            while not rosgraph.is_master_online():
                time.sleep(0.02)
            rospy.init_node('real_time', disable_rostime=True, disable_signals=True)
            rospy.wait_for_service('/gazebo/spawn_urdf_model', 30.0)
            print(f'spawn service up      {time.monotonic() - begin:.2f} s after roslaunch')
            begin = time.monotonic()
            robot = ['rosbots_description', 'spawn.launch']
            with Launched(robot, logs / 'spawn.log', os.environ) as spawn:
                if not spawn.wait(30.0):
                    print(spawn.complaint(), file=sys.stderr)
                    return 1
            print(f'spawn.launch          {time.monotonic() - begin:.2f} s in all')
            measure()
            measure_services()
            rospy.signal_shutdown('measured')
    return 0


if __name__ == '__main__':
    sys.exit(main())
