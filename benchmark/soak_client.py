"""What clients of a simulator do all day, at random but by a seed, and what is expected of it.

Each client has a process of its own. It counts what it did, and notes every answer it did not
expect; the robots, whose names are given, belong to all, the models it spawns to itself alone.
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

VICTIM = 'victim'  # what models of killed clients are called after
MOST_MODELS = 3  # of one client at a time
PAUSE = (0.01, 0.2)  # how long between two actions, and how long time is stopped [s, wall]
LOOK = (0.1, 1.0)  # how long a topic is read [s, wall]
FIELD = 60.0  # side of the square in which models are put [m]
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
TOPICS = {'/clock': Clock, '/gazebo/model_states': ModelStates, '/gazebo/link_states': LinkStates,
          '/robot0/odom': Odometry}


@dataclass
class Report:
    """What a client did, and what it was not prepared for."""

    done: Counter[str] = field(default_factory=Counter)
    faults: list[str] = field(default_factory=list)
    slowest: float = 0.0  # [s, wall] the longest that an answer took


class Client:
    """Does one random thing after the other."""

    def __init__(self, seed: int, robots: list[str], name: str, tidies: bool = False) -> None:
        """Begin with nothing of its own.

        Args:
            name: what its models are called after.
            tidies: it also deletes what killed clients left; one does that, or they would meet.
        """
        self.report = Report()
        self._random = random.Random(seed)
        self._name = name
        self._robots = robots
        self._own: dict[str, str] = {}  # model -> its kind
        self._spawned = 0
        self._robot_text = robot_urdf(command_topic='cmd_vel')
        self._state_topic = rospy.Publisher('/gazebo/set_model_state', ModelState, queue_size=1)
        # How often, relative to each other.
        self._actions: dict[Callable[[], None], int] = {
            self.spawn: 12, self.delete: 10, self.spawn_again: 2, self.spawn_broken: 2,
            self.delete_nobody: 2, self.reset_world: 1, self.reset_simulation: 1, self.pause: 2,
            self.teleport: 10, self.teleport_by_topic: 5, self.move_link: 4, self.push: 8,
            self.push_joint: 4, self.set_joint: 3, self.set_mass: 2, self.set_physics: 2,
            self.ask: 10, self.read_a_topic: 3,
        }
        if tidies:
            self._actions[self.bury] = 20

    def act(self) -> None:
        """Do one thing and note how it went."""
        (action,) = self._random.choices(list(self._actions), list(self._actions.values()))
        self.report.done[action.__name__] += 1
        try:
            action()
        except Exception as error:  # whatever it is, the call should not have failed
            self.report.faults.append(f'{action.__name__}: {type(error).__name__}: {error}')
        time.sleep(self._random.uniform(*PAUSE))

    def leave(self) -> None:
        """Delete what is left of its own."""
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
        answer = self._call('spawn_sdf_model', srv.SpawnModel, name, text, name, self._place(), '')
        self._expect(answer, True, 'Successfully spawned')
        self._own[name] = kind

    def delete(self) -> None:
        """Delete a model of its own, if it has one."""
        if self._own:
            name = self._random.choice(sorted(self._own))
            del self._own[name]
            answer = self._call('delete_model', srv.DeleteModel, name)
            self._expect(answer, True, 'successfully deleted')

    def bury(self) -> None:
        """Delete what killed clients left."""
        for name in self._call('get_world_properties', srv.GetWorldProperties).model_names:
            if name.startswith(VICTIM):
                answer = self._call('delete_model', srv.DeleteModel, name)
                words = 'successfully deleted' if answer.success else 'model does not exist'
                self._expect(answer, answer.success, words)  # its owner may live, and be quicker

    def spawn_again(self) -> None:
        """Ask for a name that is taken."""
        answer = self._call('spawn_urdf_model', srv.SpawnModel, self._robots[0], BOX, '', Pose(),
                            'world')
        self._expect(answer, False, 'entity already exists')

    def spawn_broken(self) -> None:
        """Send a description that cannot be simulated."""
        answer = self._call('spawn_urdf_model', srv.SpawnModel, 'broken', BROKEN, '', Pose(), '')
        self._expect(answer, False, 'an <inertial> without <mass')

    def delete_nobody(self) -> None:
        """Delete what is not there."""
        answer = self._call('delete_model', srv.DeleteModel, 'nobody')
        self._expect(answer, False, 'model does not exist')

    def reset_world(self) -> None:
        """Bring all models home."""
        self._call('reset_world', Empty)

    def reset_simulation(self) -> None:
        """Begin anew at time zero."""
        self._call('reset_simulation', Empty)

    def pause(self) -> None:
        """Stop time for a moment."""
        self._call('pause_physics', Empty)
        time.sleep(self._random.uniform(*PAUSE))
        self._call('unpause_physics', Empty)

    def teleport(self) -> None:
        """Bring a robot somewhere else."""
        answer = self._call('set_model_state', srv.SetModelState, self._somewhere())
        self._expect(answer, True, 'set model state done')

    def teleport_by_topic(self) -> None:
        """Do the same without an answer."""
        self._state_topic.publish(self._somewhere())

    def move_link(self) -> None:
        """Bring a robot somewhere else by one of its links."""
        state = LinkState(f'{self._a_robot()}::base_footprint', self._place(), Twist(), 'world')
        self._expect(self._call('set_link_state', srv.SetLinkState, state), True, 'success')

    def push(self) -> None:
        """Push a robot for a while."""
        wrench = Wrench(Vector3(self._random.uniform(-2.0, 2.0), 0.0, 0.0), Vector3())
        answer = self._call(
            'apply_body_wrench', srv.ApplyBodyWrench, f'{self._a_robot()}::base_footprint', '',
            Point(), wrench, rospy.Time(), rospy.Duration(self._random.uniform(0.0, 0.5)))
        self._expect(answer, True, '')
        if self._random.random() < 0.3:
            self._call('clear_body_wrenches', srv.BodyRequest, f'{self._a_robot()}::base_footprint')

    def push_joint(self) -> None:
        """Push a wheel for a while."""
        answer = self._call(
            'apply_joint_effort', srv.ApplyJointEffort, f'{self._a_robot()}::wheel_left_joint',
            self._random.uniform(-1.0, 1.0), rospy.Time(), rospy.Duration(0.2))
        self._expect(answer, True, 'effort set')

    def set_joint(self) -> None:
        """Change a wheel's damping."""
        request = srv.SetJointPropertiesRequest(joint_name=f'{self._a_robot()}::wheel_left_joint')
        request.ode_joint_config.damping = [self._random.uniform(0.0, 0.01)]
        answer = self._call('set_joint_properties', srv.SetJointProperties, request)
        self._expect(answer, True, 'properties set')

    def set_mass(self) -> None:
        """Change what a robot weighs a little."""
        link = f'{self._a_robot()}::base_footprint'
        now = self._call('get_link_properties', srv.GetLinkProperties, link)
        self._expect(now, True, 'got properties')
        answer = self._call(
            'set_link_properties', srv.SetLinkProperties, link, now.com, True,
            self._random.uniform(0.9, 1.1), now.ixx, now.ixy, now.ixz, now.iyy, now.iyz, now.izz)
        self._expect(answer, True, 'properties set')

    def set_physics(self) -> None:
        """Change gravity, step and solver within reason."""
        now = self._call('get_physics_properties', srv.GetPhysicsProperties)
        now.ode_config.sor_pgs_iters = self._random.randint(30, 70)
        answer = self._call(
            'set_physics_properties', srv.SetPhysicsProperties,
            self._random.choice((0.001, 0.001, 0.002)), 1000.0,
            Vector3(0.0, 0.0, self._random.uniform(-10.0, -9.0)), now.ode_config)
        self._expect(answer, True, 'physics engine updated')

    def ask(self) -> None:
        """Ask about the world and a robot."""
        world = self._call('get_world_properties', srv.GetWorldProperties)
        self._expect(world, set(self._robots) | set(self._own) <= set(world.model_names), '')
        name = self._a_robot()
        self._expect(self._call('get_model_state', srv.GetModelState, name, ''), True, '')
        self._expect(self._call('get_model_properties', srv.GetModelProperties, name), True, '')
        joint = f'{name}::wheel_right_joint'
        self._expect(self._call('get_joint_properties', srv.GetJointProperties, joint), True, '')

    def read_a_topic(self) -> None:
        """Subscribe to a topic and leave again."""
        name, message_class = self._random.choice(sorted(TOPICS.items()))
        subscriber = rospy.Subscriber(name, message_class, lambda _: None)
        time.sleep(self._random.uniform(*LOOK))
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

    def _place(self) -> Pose:
        x, y = (self._random.uniform(0.0, FIELD) for _ in 'xy')
        return Pose(Point(x, y, 0.5), Quaternion(0.0, 0.0, 0.0, 1.0))

    def _somewhere(self) -> ModelState:
        return ModelState(self._a_robot(), self._place(), Twist(), 'world')


def serve(
    number: int, seed: int, robots: list[str], over: Event, reports: Connection
) -> None:
    """Be a client until it is over; this is a process of its own."""
    name = f'client{number}'
    _begin(name)
    client = Client(seed, robots, name, tidies=number == 0)
    reports.send('ready')
    while not over.is_set():
        client.act()
    client.leave()
    reports.send(client.report)
    rospy.signal_shutdown('done')


def kill_clients(
    number: int, seed: int, robots: list[str], over: Event, reports: Connection
) -> None:
    """Start clients and kill each in the middle of what it does; send how many there were."""
    rng, killed = random.Random(seed), number
    reports.send('ready')
    while not over.is_set():
        victim = os.fork()
        if victim == 0:
            _be_a_victim(killed, robots)
        time.sleep(rng.uniform(0.3, 1.0))
        os.kill(victim, signal.SIGKILL)
        os.waitpid(victim, 0)
        killed += 1
    reports.send(Report(Counter(killed_clients=killed - number)))


def _be_a_victim(number: int, robots: list[str]) -> None:
    """Act without a pause, readers included, until the end comes from outside."""
    _begin('victim')  # of the same name, as a program that crashes and is started again
    for name, message_class in TOPICS.items():
        rospy.Subscriber(name, message_class, lambda _: None)
    client = Client(number, robots, f'{VICTIM}{number}')  # its models outlive it
    busy = itertools.cycle((client.spawn, client.teleport, client.teleport_by_topic, client.push))
    while True:
        with contextlib.suppress(ValueError):  # somebody buried the models of this name already
            next(busy)()


def _begin(name: str) -> None:
    logging.getLogger('rosout').setLevel(logging.ERROR)
    rospy.init_node(name, disable_rostime=True, disable_signals=True)
