#!/usr/bin/env python3
"""Try a robot of a running simulation: `./rosbots exec tools/try_robot.py MODEL [--help]`.

It prints the real-time factor and which sensors send, drives the robot by velocity commands and
prints how far it came by its true pose, and takes a picture by a camera that stands in the world
meanwhile. The numbers and pictures of doc/robots.md are made by it.
"""

import argparse
import os
import sys
import time
from math import cos, hypot, pi, sin
from pathlib import Path
from typing import Any
from xmlrpc.client import ServerProxy

import rosgraph
import rospy
from gazebo_msgs.srv import (
    DeleteModel,
    GetLinkState,
    GetModelProperties,
    GetModelState,
    GetWorldProperties,
    SpawnModel,
)
from geometry_msgs.msg import Pose, Quaternion, Twist
from PIL import Image
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Image as ImageMessage

from rosbots_description.sim.core.transforms import yaw_of

APPEARS = 60.0  # [s, wall] timeout of the start of the simulation, and of the picture
SENDS = 30.0  # [s, wall] timeout of the first message of a sensor
SENSORS = {
    f'sensor_msgs/{kind}'
    for kind in ('Image', 'Imu', 'LaserScan', 'NavSatFix', 'PointCloud', 'PointCloud2', 'Range')
}
MEASURED = 6.0  # [s, wall] over which the real-time factor is taken
RATE = 20.0  # of commands [Hz]
SIZE = (320, 240)  # of the picture [pixels]; taken at twice that
FIELD_OF_VIEW = 0.9  # horizontal [rad]
QUALITY = 80  # of the picture, of 100
CAMERA = 'try_robot_camera'  # model, and namespace of its topic
CAMERA_SDF = f"""<sdf version="1.6"><model name="{CAMERA}"><static>true</static><link name="link">
<sensor name="camera" type="camera"><update_rate>5</update_rate><camera>
<horizontal_fov>{FIELD_OF_VIEW}</horizontal_fov>
<image><width>{2 * SIZE[0]}</width><height>{2 * SIZE[1]}</height><format>R8G8B8</format></image>
<clip><near>0.02</near><far>200</far></clip></camera>
<plugin name="camera" filename="libgazebo_ros_camera.so"><cameraName>{CAMERA}</cameraName>
<imageTopicName>image_raw</imageTopicName><cameraInfoTopicName>camera_info</cameraInfoTopicName>
<frameName>world</frameName></plugin></sensor></link></model></sdf>"""


class TrialError(RuntimeError):
    """The robot cannot be tried; the message says why."""


def parser() -> argparse.ArgumentParser:
    """Return the parser of the options."""
    made = argparse.ArgumentParser(prog='try_robot.py', description=__doc__.splitlines()[0])
    made.add_argument('model', metavar='MODEL', help='its name in the world')
    made.add_argument('--drive', metavar='TOPIC', help='of its geometry_msgs/Twist commands')
    made.add_argument('--speed', type=float, default=0.5, help='forward [m/s] (default: 0.5)')
    made.add_argument('--sideways', type=float, default=0.0, help='also to the left [m/s]')
    made.add_argument('--turn', type=float, default=0.5, help='in place [rad/s] (default: 0.5)')
    made.add_argument('--seconds', type=float, default=3.0, help='of each [s] (default: 3)')
    made.add_argument('--picture', metavar='FILE', type=Path, help='WebP, JPEG or PNG')
    made.add_argument(
        '--distance',
        type=float,
        metavar='M',
        help='of the camera [m] (default: by the distances between the links)',
    )
    made.add_argument(
        '--bearing',
        type=float,
        default=-0.6,
        metavar='RAD',
        help='of the camera, seen from the robot (default: -0.6, on its right)',
    )
    made.add_argument(
        '--pitch',
        type=float,
        default=0.4,
        metavar='RAD',
        help='of the camera, downwards (default: 0.4)',
    )
    return made


def call(service: str, kind: type[Any], **request: object) -> Any:  # noqa: ANN401  any message
    """Return the response of a service of the simulator.

    Raises:
        TrialError: it reports a failure.
    """
    response = rospy.ServiceProxy(f'/gazebo/{service}', kind)(**request)
    if not response.success:
        raise TrialError(response.status_message)
    return response


def pose(model: str) -> Pose:
    """Return the true pose of a model in the world."""
    return call('get_model_state', GetModelState, model_name=model).pose


def heading_of(pose: Pose) -> float:
    """Return the rotation of a pose about z [rad]."""
    turn = pose.orientation
    return yaw_of((turn.x, turn.y, turn.z, turn.w))


def wait_for(model: str) -> None:
    """Return when the world has the model.

    Raises:
        TrialError: it does not come.
    """
    began = time.monotonic()
    rospy.wait_for_service('/gazebo/get_world_properties', APPEARS)
    while model not in (names := call('get_world_properties', GetWorldProperties).model_names):
        if time.monotonic() - began > APPEARS:
            raise TrialError(f"there is no model '{model}'; there are {', '.join(names)}")
        time.sleep(0.5)


def simulated() -> float:
    """Return the time that /clock says next [s]."""
    seconds: float = rospy.wait_for_message('/clock', Clock, APPEARS).clock.to_sec()
    return seconds


def processor_time() -> float:
    """Return what the simulator has used so far, without its other processes [s]."""
    server: Any = ServerProxy(rospy.get_master().lookupNode('/gazebo')[2])
    _, _, process = server.getPid('/try_robot')
    user, system = Path(f'/proc/{process}/stat').read_text().rpartition(')')[2].split()[11:13]
    return (int(user) + int(system)) / os.sysconf('SC_CLK_TCK')


def measure_speed() -> str:
    """Return the real-time factor and the load of the server, in words."""
    before, used, began = simulated(), processor_time(), time.monotonic()
    time.sleep(MEASURED)
    elapsed = simulated() - before
    return (
        f'real-time factor {elapsed / (time.monotonic() - began):.2f}, load '
        f'{(processor_time() - used) / elapsed:.2f} s per simulated second, '
        f'{os.getloadavg()[0]:.1f} processes on {os.cpu_count()} processors'
    )


def sensors() -> str:
    """Return which sensor topics of the simulator send a message, in words."""
    published, _, _ = rospy.get_master().getSystemState()[2]
    kinds = dict(rospy.get_published_topics())
    topics = sorted(
        topic
        for topic, nodes in published
        if '/gazebo' in nodes and kinds.get(topic) in SENSORS and not topic.startswith('/gazebo/')
    )
    words = []
    for topic in topics:
        try:
            rospy.wait_for_message(topic, rospy.AnyMsg, SENDS)
        except rospy.ROSException:
            words.append(f'{topic} is SILENT')
        else:
            words.append(topic)
    return ', '.join(words) or 'none'


def drive(model: str, publisher: rospy.Publisher, command: Twist, seconds: float) -> str:
    """Command a velocity for some simulated seconds; return where the robot came, in words."""
    before, end = pose(model), rospy.get_time() + seconds
    rate = rospy.Rate(RATE)
    while rospy.get_time() < end:
        publisher.publish(command)
        rate.sleep()
    after = pose(model)
    publisher.publish(Twist())
    heading = heading_of(before)
    x, y = after.position.x - before.position.x, after.position.y - before.position.y
    turned = (heading_of(after) - heading + pi) % (2 * pi) - pi
    return (
        f'{command.linear.x:g} m/s, {command.linear.y:g} m/s to the left and '
        f'{command.angular.z:g} rad/s for {seconds:g} s: '
        f'{x * cos(heading) + y * sin(heading):.2f} m forward, '
        f'{y * cos(heading) - x * sin(heading):.2f} m to the left, turned by {turned:.2f} rad, '
        f'now {after.position.z:.2f} m high'
    )


def drive_all(options: argparse.Namespace) -> None:
    """Drive forward, sideways if asked for, and turn in place; print what came of each."""
    publisher = rospy.Publisher(options.drive, Twist, queue_size=1)
    began = time.monotonic()
    while not publisher.get_num_connections():
        if time.monotonic() - began > APPEARS:
            raise TrialError(f'nothing subscribes to {options.drive}')
        time.sleep(0.1)
    for attribute, part, value in (
        ('linear', 'x', options.speed),
        ('linear', 'y', options.sideways),
        ('angular', 'z', options.turn),
    ):
        if value:
            command = Twist()
            setattr(getattr(command, attribute), part, value)
            print(drive(options.model, publisher, command, options.seconds))
            rospy.sleep(1.0)  # until it stands


def extent(model: str) -> tuple[tuple[float, float, float], float]:
    """Return the centre of a model's link frames and the radius of a ball around them [m]."""
    names = call('get_model_properties', GetModelProperties, model_name=model).body_names
    points = [
        call('get_link_state', GetLinkState, link_name=f'{model}::{name}').link_state.pose.position
        for name in names
    ]
    lows, highs = (
        tuple(chosen(getattr(point, axis) for point in points) for axis in 'xyz')
        for chosen in (min, max)
    )
    centre = tuple((low + high) / 2 for low, high in zip(lows, highs, strict=True))
    return centre, max(hypot(*(high - low for low, high in zip(lows, highs, strict=True))) / 2, 0.1)


def camera_pose(options: argparse.Namespace) -> Pose:
    """Return the pose of the camera, which looks at the centre of the model."""
    (x, y, z), radius = extent(options.model)
    distance = options.distance or 3 * radius + 0.35
    bearing = heading_of(pose(options.model)) + options.bearing
    made = Pose()
    made.position.x = x + distance * cos(options.pitch) * cos(bearing)
    made.position.y = y + distance * cos(options.pitch) * sin(bearing)
    made.position.z = z + distance * sin(options.pitch)
    half_turn, half_pitch = (bearing + pi) / 2, options.pitch / 2
    made.orientation = Quaternion(
        -sin(half_turn) * sin(half_pitch),
        cos(half_turn) * sin(half_pitch),
        sin(half_turn) * cos(half_pitch),
        cos(half_turn) * cos(half_pitch),
    )
    return made


def take_picture(options: argparse.Namespace) -> None:
    """Write what a camera sees of the model, which is removed again."""
    call(
        'spawn_sdf_model',
        SpawnModel,
        model_name=CAMERA,
        model_xml=CAMERA_SDF,
        initial_pose=camera_pose(options),
    )
    try:
        seen = rospy.wait_for_message(f'/{CAMERA}/image_raw', ImageMessage, APPEARS)
    finally:
        call('delete_model', DeleteModel, model_name=CAMERA)
    whole = Image.frombytes('RGB', (seen.width, seen.height), seen.data)
    whole.resize(SIZE, Image.Resampling.LANCZOS).save(options.picture, quality=QUALITY)
    print(f'{options.picture}: {options.picture.stat().st_size} bytes')


def main() -> int:
    """Try the robot; return the exit code."""
    options = parser().parse_args(rospy.myargv()[1:])
    try:
        if not rosgraph.is_master_online():
            raise TrialError('there is no ROS master, and so no simulation')
        rospy.init_node('try_robot', anonymous=True)
        wait_for(options.model)
        print(measure_speed())
        print('sensors:', sensors())
        if options.drive:
            drive_all(options)
        if options.picture:
            take_picture(options)
    except (TrialError, rospy.ROSException, rospy.ServiceException) as error:
        sys.stderr.write(f'try_robot.py: {error}\n')
        return 1
    return 0


if __name__ == '__main__':
    sys.exit(main())
