"""Shared code of tests of the running simulator: services, and waiting for conditions."""

import contextlib
import random
import re
import socket
import time
import unittest
from pathlib import Path
from xmlrpc.client import ServerProxy

import rosgraph
import rosnode
import rospy
from gazebo_msgs.srv import DeleteModel, GetModelState, GetWorldProperties, SpawnModel
from geometry_msgs.msg import Point, Pose, Quaternion, Twist, Vector3
from programs import find_program, ran
from std_srvs.srv import Empty

DEADLINE = 60.0  # [s, wall] only ends a hopeless wait; what it limits takes a fraction of it
COMMANDS = '/part2_cmr/cmd_vel'
GROUND = 'ground_plane'
DATA = Path(__file__).resolve().parents[1] / 'data'
BOX = """<robot name="box"><link name="body">
  <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  <collision><geometry><box size="1 1 1"/></geometry></collision>
</link></robot>"""


def wait_until(condition, what, deadline=DEADLINE):
    """Return what a condition returns, when it is true; with a timeout of wall time.

    Simulated time may be paused. A look at it leaves the processor to what is waited for: the
    longer one takes, the fewer.
    """
    end = time.monotonic() + deadline
    while True:
        began = time.monotonic()
        if value := condition():
            return value
        now = time.monotonic()
        if now > end:
            raise AssertionError(f'not within {deadline:g} s: {what}')
        time.sleep(min(max(0.02, 2.0 * (now - began)), 1.0))


def free_port():
    """Return a port of this machine on which nothing listens, for another ROS master.

    Linux gives it to nobody who asks for any port, so none takes it before the master is there.
    """
    while True:
        port = random.SystemRandom().randrange(20000, 32768)
        with socket.socket() as probe, contextlib.suppress(OSError):
            probe.bind(('localhost', port))
            return port


def proxy(name, service_type, node='/gazebo'):
    """Return a service of the simulator, when it is offered."""
    rospy.wait_for_service(f'{node}/{name}', DEADLINE)
    return rospy.ServiceProxy(f'{node}/{name}', service_type)


def process_of(node='/gazebo'):
    """Return the process id of a node."""
    return ServerProxy(rosgraph.Master('/test').lookupNode(node)).getPid('/test')[2]


def page_address(shown, deadline=DEADLINE):
    """Return the address of the window in the browser; `shown` returns what it has printed."""
    said = re.compile(r'the world is at (\S+)\s')
    return wait_until(lambda: said.search(shown()), 'the address', deadline)[1]


def hears(subscriber, node='/gazebo'):
    """Tell whether a node sends to a subscriber: what it publishes from now on arrives.

    The subscriber's own number of connections tells only that the node has answered it.
    """
    return sends(node, subscriber.resolved_name, rospy.get_name())


def sends(node, topic, receiver):
    """Tell whether a node sends a topic to another node: what it publishes from now on arrives."""
    try:
        address = rosnode.get_api_uri(rosgraph.Master('/test'), node, skip_cache=True)
        connections = ServerProxy(address).getBusInfo('/test')[2]
    except (OSError, rosgraph.MasterError, TypeError):  # it has not started yet
        return False
    return any(
        (other, way, what) == (receiver, 'o', topic) for _, other, way, _, what, *_ in connections
    )


def pose(x=0.0, y=0.0, z=0.5):
    return Pose(Point(x, y, z), Quaternion(0.0, 0.0, 0.0, 1.0))


# What it opens last when it starts; from then on its topics come and go with models.
LAST_TOPICS = {'/gazebo/parameter_descriptions', '/gazebo/parameter_updates'}


def topics_of(node='/gazebo'):
    """Return the topics that a node publishes or subscribes to."""
    published, subscribed, _ = rospy.get_master().getSystemState()[2]
    return {name for name, nodes in published + subscribed if node in nodes}


SENSOR_BOX = """<robot name="box">
<link name="body"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>
  <collision><geometry><mesh filename="file:///nowhere/nope.stl"/></geometry></collision></link>
<gazebo reference="body"><sensor name="sonar1" type="sonar"/></gazebo>
<gazebo><plugin name="imu" filename="libgazebo_ros_imu.so"/></gazebo>
</robot>"""


def recorded(robot):
    """Return the URDF of a robot that was recorded in Gazebo."""
    (file,) = DATA.rglob(f'{robot}.urdf')
    return file.read_text(encoding='utf-8')


def spawn_model(name, text):
    """Run spawn_model on a text until it ends; return the completed process."""
    program = find_program('gazebo_ros', 'spawn_model')
    return ran(program, '-urdf', '-stdin', '-model', name, input=text)


class SimulatorTest(unittest.TestCase):
    """Starts each test with an empty world, unpaused."""

    @contextlib.contextmanager
    def subTest(self, *name, **parameters):  # noqa: N802 (unittest's name)
        """As in unittest; but the test itself fails at its end: rosunit knows no part of one."""
        try:
            yield
        except AssertionError as error:
            self.addCleanup(self.fail, f'{name or parameters}: {error}')

    def setUp(self):
        wait_until(lambda: topics_of() >= LAST_TOPICS, 'the last topics of the simulator')
        self.spawn_service = proxy('spawn_urdf_model', SpawnModel)
        self.delete = proxy('delete_model', DeleteModel)
        self.model_state = proxy('get_model_state', GetModelState)
        self.world = proxy('get_world_properties', GetWorldProperties)
        self.pause = proxy('pause_physics', Empty)
        self.unpause = proxy('unpause_physics', Empty)
        self.reset_world = proxy('reset_world', Empty)
        self.reset_simulation = proxy('reset_simulation', Empty)
        self._connections = []
        self._clean()

    def tearDown(self):
        self.disconnect()
        self._clean()

    def _clean(self):
        self.unpause()
        for name in self.world().model_names:
            if name != GROUND:
                self.assertTrue(self.delete(name).success)

    def spawn(self, name='rosbots', xml=None, at=None, frame='', namespace='/'):
        xml = rospy.get_param('robot_description') if xml is None else xml
        return self.spawn_service(name, xml, namespace, at or pose(), frame)

    def spawn_recorded(self, robot, topics, z=0.0, namespace='/', change=str):
        """Spawn a robot that was recorded in Gazebo as 'bot', and assert that it has these topics.

        Args:
            change: of its URDF.
        """
        before, text = topics_of(), change(recorded(robot))
        self.assertTrue(self.spawn('bot', text, pose(z=z), namespace=namespace).success)
        self.assertEqual(topics_of() - before, topics)

    def collect(self, topic, message_class):
        """Return a list to which the messages of a topic are appended; waits for a publisher.

        To be unregistered before that publisher comes anew: rospy stays without a connection if it
        hears of the new one before it has closed the old one.
        """
        messages = []
        subscriber = rospy.Subscriber(topic, message_class, messages.append, tcp_nodelay=True)
        self._connections.append(subscriber)
        wait_until(
            lambda: (
                subscriber.get_num_connections()
                and all(hears(subscriber, one.callerid_pub) for one in subscriber.impl.connections)
            ),
            f'a publisher of {topic}',
        )
        return messages

    def disconnect(self):
        """Unregister what was connected so far."""
        while self._connections:
            self._connections.pop().unregister()

    def read(self, topic, message_class, count):
        """Return such a list when it has so many messages."""
        messages = self.collect(topic, message_class)
        wait_until(lambda: len(messages) >= count, f'messages on {topic}')
        return messages

    def publisher(self, topic, message_class):
        """Return a publisher that somebody reads."""
        made = rospy.Publisher(topic, message_class, queue_size=10)
        self._connections.append(made)
        wait_until(made.get_num_connections, f'a subscriber of {topic}')
        return made

    def driver(self, topic=COMMANDS):
        """Return a function that sends a velocity command to the robot."""
        publisher = self.publisher(topic, Twist)

        def drive(forward=0.0, turn=0.0, left=0.0):
            command = Twist(Vector3(forward, left, 0.0), Vector3(0.0, 0.0, turn))
            publisher.publish(command)

        return drive

    def x_of(self, name='rosbots'):
        return self.model_state(name, '').pose.position.x
