"""Clients of the soak test: seeded random calls, with the expected responses.

Each client runs in its own process, counts its actions and records each unexpected response. All
clients share the given robots; only the client that spawned a model deletes it.
"""

from __future__ import annotations

import contextlib
import itertools
import logging
import os
import random
import signal
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from multiprocessing.synchronize import Event

import rospy
from article import robot_urdf
from gazebo_msgs import srv
from gazebo_msgs.msg import LinkState, LinkStates, ModelState, ModelStates
from genpy import Message
from geometry_msgs.msg import Point, Pose, Quaternion, Twist, Vector3, Wrench
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from std_srvs.srv import Empty

VICTIM = 'victim'  # prefix of models of killed clients
MOST_MODELS = 3  # of one client at a time
PAUSE = (0.01, 0.1)  # between two actions, and of physics [s, wall]
LISTEN = (0.1, 1.0)  # duration of a subscription [s, wall]
FIELD = 60.0  # side of the square in which models are placed [m]
BOX = """<robot name="box"><link name="body">
  <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  <collision><geometry><box size="1 1 1"/></geometry></collision>
</link></robot>"""
PENDULUM = """<sdf version="1.6"><model name="pendulum">
  <link name="foot"><inertial><mass>10</mass></inertial>
    <collision name="c"><geometry><box><size>1 1 0.2</size></box></geometry></collision></link>
  <link name="bob"><pose>0 0 1 0 0 0</pose></link>
  <joint name="hinge" type="revolute"><parent>foot</parent><child>bob</child>
    <axis><xyz>1 0 0</xyz></axis></joint></model></sdf>"""
BROKEN = '<robot name="broken"><link name="body"><inertial/></link></robot>'
TOPICS = {
    '/clock': Clock,
    '/gazebo/model_states': ModelStates,
    '/gazebo/link_states': LinkStates,
    '/robot0/odom': Odometry,
}


@dataclass
class Report:
    """Actions of a client, and unexpected responses."""

    done: Counter[str] = field(default_factory=Counter)
    faults: list[str] = field(default_factory=list)
    slowest: float = 0.0  # longest response time [s, wall]


class Client:
    """Makes random calls, one after the other."""

    def __init__(self, seed: int, robots: list[str], name: str, cleans_up: bool = False) -> None:
        """Begin without models.

        Args:
            name: prefix of its models' names.
            cleans_up: also delete models of killed clients; set for one client only, since two
                would delete the same model.
        """
        self.report = Report()
        self._random = random.Random(seed)
        self._name = name
        self._robots = robots
        self._own: dict[str, str] = {}  # model -> its kind
        self._spawned = 0
        self._robot_text = robot_urdf(command_topic='cmd_vel')
        self._state_topic = rospy.Publisher('/gazebo/set_model_state', ModelState, queue_size=1)
        # Relative frequencies.
        self._actions: dict[Callable[[], None], int] = {
            self.spawn: 12,
            self.delete: 10,
            self.spawn_again: 2,
            self.spawn_broken: 2,
            self.delete_nobody: 2,
            self.reset_world: 1,
            self.reset_simulation: 1,
            self.pause: 2,
            self.teleport: 10,
            self.teleport_by_topic: 5,
            self.move_link: 4,
            self.push: 8,
            self.push_joint: 4,
            self.set_joint: 3,
            self.set_mass: 2,
            self.set_physics: 2,
            self.query: 10,
            self.read_a_topic: 3,
        }
        if cleans_up:
            self._actions[self.delete_leftovers] = 20

    def act_once_each(self) -> None:
        """Do each action once, in random order."""
        for action in self._random.sample(list(self._actions), len(self._actions)):
            self._do(action)

    def act(self) -> None:
        """Do one random action."""
        (action,) = self._random.choices(list(self._actions), list(self._actions.values()))
        self._do(action)

    def _do(self, action: Callable[[], None]) -> None:
        """Do an action, and record a failure."""
        self.report.done[action.__name__] += 1
        try:
            action()
        except Exception as error:  # no action may fail
            self.report.faults.append(f'{action.__name__}: {type(error).__name__}: {error}')
        time.sleep(self._random.uniform(*PAUSE))

    def leave(self) -> None:
        """Delete all its models."""
        while self._own:
            self.delete()

    def spawn(self) -> None:
        """Spawn a robot, a box or a pendulum; the robot takes commands in a namespace."""
        if len(self._own) >= MOST_MODELS:
            self.delete()
        kind = self._random.choice(('robot', 'box', 'pendulum'))
        self._spawned += 1
        name = f'{self._name}_{kind}{self._spawned}'
        text = {'robot': self._robot_text, 'box': BOX, 'pendulum': PENDULUM}[kind]
        pose = self._random_pose()
        answer = self._call('spawn_sdf_model', srv.SpawnModel, name, text, name, pose, '')
        self._expect(answer, True, 'Successfully spawned')
        self._own[name] = kind

    def delete(self) -> None:
        """Delete one of its models, if it has any."""
        if self._own:
            name = self._random.choice(sorted(self._own))
            del self._own[name]
            answer = self._call('delete_model', srv.DeleteModel, name)
            self._expect(answer, True, 'successfully deleted')

    def delete_leftovers(self) -> None:
        """Delete models of killed clients."""
        for name in self._call('get_world_properties', srv.GetWorldProperties).model_names:
            if name.startswith(VICTIM):
                answer = self._call('delete_model', srv.DeleteModel, name)
                words = 'successfully deleted' if answer.success else 'model does not exist'
                self._expect(answer, answer.success, words)  # a live owner may delete it first

    def spawn_again(self) -> None:
        """Spawn a model under a name that exists."""
        answer = self._call(
            'spawn_urdf_model', srv.SpawnModel, self._robots[0], BOX, '', Pose(), 'world'
        )
        self._expect(answer, False, 'entity already exists')

    def spawn_broken(self) -> None:
        """Spawn a model that cannot be simulated."""
        answer = self._call('spawn_urdf_model', srv.SpawnModel, 'broken', BROKEN, '', Pose(), '')
        self._expect(answer, False, 'an <inertial> without <mass')

    def delete_nobody(self) -> None:
        """Delete a model that does not exist."""
        answer = self._call('delete_model', srv.DeleteModel, 'nobody')
        self._expect(answer, False, 'model does not exist')

    def reset_world(self) -> None:
        """Reset all poses."""
        self._call('reset_world', Empty)

    def reset_simulation(self) -> None:
        """Reset poses and time."""
        self._call('reset_simulation', Empty)

    def pause(self) -> None:
        """Pause physics for a moment."""
        self._call('pause_physics', Empty)
        time.sleep(self._random.uniform(*PAUSE))
        self._call('unpause_physics', Empty)

    def teleport(self) -> None:
        """Set the pose of a robot."""
        answer = self._call('set_model_state', srv.SetModelState, self._random_state())
        self._expect(answer, True, 'set model state done')

    def teleport_by_topic(self) -> None:
        """Set the pose of a robot by a message."""
        self._state_topic.publish(self._random_state())

    def move_link(self) -> None:
        """Set the pose of a robot by that of a link."""
        state = LinkState(
            f'{self._a_robot()}::base_footprint', self._random_pose(), Twist(), 'world'
        )
        self._expect(self._call('set_link_state', srv.SetLinkState, state), True, 'success')

    def push(self) -> None:
        """Apply a wrench to a robot."""
        wrench = Wrench(Vector3(self._random.uniform(-2.0, 2.0), 0.0, 0.0), Vector3())
        answer = self._call(
            'apply_body_wrench',
            srv.ApplyBodyWrench,
            f'{self._a_robot()}::base_footprint',
            '',
            Point(),
            wrench,
            rospy.Time(),
            rospy.Duration(self._random.uniform(0.0, 0.5)),
        )
        self._expect(answer, True, '')
        if self._random.random() < 0.3:
            self._call('clear_body_wrenches', srv.BodyRequest, f'{self._a_robot()}::base_footprint')

    def push_joint(self) -> None:
        """Apply an effort to a wheel joint."""
        answer = self._call(
            'apply_joint_effort',
            srv.ApplyJointEffort,
            f'{self._a_robot()}::wheel_left_joint',
            self._random.uniform(-1.0, 1.0),
            rospy.Time(),
            rospy.Duration(0.2),
        )
        self._expect(answer, True, 'effort set')

    def set_joint(self) -> None:
        """Set the damping of a wheel joint."""
        request = srv.SetJointPropertiesRequest(joint_name=f'{self._a_robot()}::wheel_left_joint')
        request.ode_joint_config.damping = [self._random.uniform(0.0, 0.01)]
        answer = self._call('set_joint_properties', srv.SetJointProperties, request)
        self._expect(answer, True, 'properties set')

    def set_mass(self) -> None:
        """Set the mass of a robot."""
        link = f'{self._a_robot()}::base_footprint'
        now = self._call('get_link_properties', srv.GetLinkProperties, link)
        self._expect(now, True, 'got properties')
        answer = self._call(
            'set_link_properties',
            srv.SetLinkProperties,
            link,
            now.com,
            True,
            self._random.uniform(0.9, 1.1),
            now.ixx,
            now.ixy,
            now.ixz,
            now.iyy,
            now.iyz,
            now.izz,
        )
        self._expect(answer, True, 'properties set')

    def set_physics(self) -> None:
        """Set gravity, step size and solver iterations."""
        now = self._call('get_physics_properties', srv.GetPhysicsProperties)
        now.ode_config.sor_pgs_iters = self._random.randint(30, 70)
        answer = self._call(
            'set_physics_properties',
            srv.SetPhysicsProperties,
            self._random.choice((0.001, 0.001, 0.002)),
            1000.0,
            Vector3(0.0, 0.0, self._random.uniform(-10.0, -9.0)),
            now.ode_config,
        )
        self._expect(answer, True, 'physics engine updated')

    def query(self) -> None:
        """Query the world and a robot."""
        world = self._call('get_world_properties', srv.GetWorldProperties)
        self._expect(world, set(self._robots) | set(self._own) <= set(world.model_names), '')
        name = self._a_robot()
        self._expect(self._call('get_model_state', srv.GetModelState, name, ''), True, '')
        self._expect(self._call('get_model_properties', srv.GetModelProperties, name), True, '')
        joint = f'{name}::wheel_right_joint'
        self._expect(self._call('get_joint_properties', srv.GetJointProperties, joint), True, '')

    def read_a_topic(self) -> None:
        """Subscribe to a topic and unsubscribe."""
        name, message_class = self._random.choice(sorted(TOPICS.items()))
        subscriber = rospy.Subscriber(name, message_class, lambda _: None)
        time.sleep(self._random.uniform(*LISTEN))
        subscriber.unregister()

    def _call(self, name: str, service_class: type, *arguments: object) -> Message:
        begin = time.monotonic()
        try:
            return rospy.ServiceProxy(f'/gazebo/{name}', service_class)(*arguments)
        finally:
            self.report.slowest = max(self.report.slowest, time.monotonic() - begin)

    def _expect(self, answer: Message, success: bool, words: str) -> None:
        if answer.success != success or words not in answer.status_message:
            raise ValueError(f'success={answer.success}: {answer.status_message}')

    def _a_robot(self) -> str:
        return self._random.choice(self._robots)

    def _random_pose(self) -> Pose:
        x, y = (self._random.uniform(0.0, FIELD) for _ in 'xy')
        return Pose(Point(x, y, 0.5), Quaternion(0.0, 0.0, 0.0, 1.0))

    def _random_state(self) -> ModelState:
        return ModelState(self._a_robot(), self._random_pose(), Twist(), 'world')


def serve(number: int, seed: int, robots: list[str], over: Event, reports: Connection) -> None:
    """Run a client until `over` is set; the entry point of its process.

    It is ready when it has made all calls, so that none is new to the server from then on.
    """
    name = f'client{number}'
    _begin(name)
    client = Client(seed, robots, name, cleans_up=number == 0)
    client.act_once_each()
    reports.send('ready')
    while not over.is_set():
        client.act()
    client.leave()
    reports.send(client.report)
    rospy.signal_shutdown('done')


def kill_clients(
    number: int, seed: int, robots: list[str], over: Event, reports: Connection
) -> None:
    """Start clients one by one and kill each in mid-call; send their number."""
    rng, killed = random.Random(seed), number
    reports.send('ready')
    while not over.is_set():
        victim = os.fork()
        if victim == 0:
            _run_victim(killed, robots)
        time.sleep(rng.uniform(0.3, 1.0))
        os.kill(victim, signal.SIGKILL)
        os.waitpid(victim, 0)
        killed += 1
    reports.send(Report(Counter(killed_clients=killed - number)))


def _run_victim(number: int, robots: list[str]) -> None:
    """Make calls without a pause, with subscriptions, until this process is killed."""
    _begin('victim')  # all have one name, like a program that is restarted after a crash
    for name, message_class in TOPICS.items():
        rospy.Subscriber(name, message_class, lambda _: None)
    client = Client(number, robots, f'{VICTIM}{number}')  # its models remain
    actions = itertools.cycle(
        (client.spawn, client.teleport, client.teleport_by_topic, client.push)
    )
    while True:
        with contextlib.suppress(ValueError):  # its models may have been deleted by another client
            next(actions)()


def _begin(name: str) -> None:
    logging.getLogger('rosout').setLevel(logging.ERROR)
    rospy.init_node(name, disable_rostime=True, disable_signals=True)
