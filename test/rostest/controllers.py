"""Shared code of the tests of controllers: robots with ros_control's plugin, and their managers."""

import json
import subprocess
from itertools import pairwise

import rosgraph
import rospy
import rosservice
from controller_manager_msgs.srv import (
    ListControllers,
    LoadController,
    SwitchController,
    UnloadController,
)
from programs import find_program
from rosgraph_msgs.msg import Log
from simulator import DATA, SimulatorTest, hears, recorded, wait_until

RECORDED = json.loads((DATA / 'gazebo' / 'controller_interfaces.json').read_text())
ARM, BURGER = recorded('twolink'), recorded('burger_ros_control')
MANAGER = (
    'list_controller_types',
    'list_controllers',
    'load_controller',
    'reload_controller_libraries',
    'switch_controller',
    'unload_controller',
)
STRICT, BEST_EFFORT = 2, 1
JSC = 'joint_state_controller'


class ControllersTest(SimulatorTest):
    """Spawns robots and calls their controller managers; `errors` are the simulator's."""

    def setUp(self):
        super().setUp()
        self.errors = []
        log = rospy.Subscriber('/rosout', Log, self._hear)
        self._connections.append(log)
        wait_until(lambda: hears(log), 'the log of the simulator')
        self.parameters = set()

    def tearDown(self):
        super().tearDown()
        for name in self.parameters:
            rospy.delete_param(name)
        wait_until(lambda: not managers(), 'the services of deleted robots to go')

    def _hear(self, message):
        if message.level >= Log.WARN and message.name == '/gazebo':
            self.errors.append(message.msg)

    def set_parameter(self, name, value):
        rospy.set_param(name, value)
        self.parameters.add(name)

    def spawn_robot(self, text=ARM, namespace='/arm', parameters=None):
        """Spawn a robot with the parameters of its controllers, and wait for its manager."""
        self.set_parameter('/robot_description', text)
        for name, value in (parameters or {}).items():
            self.set_parameter(f'{namespace}/{name}', value)
        self.assertTrue(self.spawn('robot', text).success)
        wait_until(
            lambda: managers() >= {f'{namespace}/controller_manager/{name}' for name in MANAGER},
            'the controller manager',
        )
        self.manager = f'{namespace}/controller_manager'

    def call(self, service, kind, *arguments, **named):
        return rospy.ServiceProxy(f'{self.manager}/{service}', kind)(*arguments, **named)

    def load(self, name):
        return self.call('load_controller', LoadController, name).ok

    def unload(self, name):
        return self.call('unload_controller', UnloadController, name).ok

    def switch(self, start=(), stop=(), strictness=STRICT):
        return self.call(
            'switch_controller',
            SwitchController,
            start_controllers=list(start),
            stop_controllers=list(stop),
            strictness=strictness,
        ).ok

    def states(self):
        return {
            one.name: one.state for one in self.call('list_controllers', ListControllers).controller
        }

    def run_controllers(self, names):
        """Load and start controllers."""
        for name in names:
            self.assertTrue(self.load(name), self.errors)
        self.assertTrue(self.switch(start=names), self.errors)

    def start(self, name, *arguments):
        """Return the process of a program of controller_manager, which prints to a pipe."""
        process = subprocess.Popen(
            [find_program('controller_manager', name), *arguments, '__ns:=/arm'],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self.addCleanup(process.kill)  # unless it has ended
        return process

    def heard_errors(self, *texts):
        wait_until(
            lambda: all(any(text in error for error in self.errors) for text in texts),
            f'{texts} in {self.errors}',
        )


def managers():
    """Return the services of controller managers."""
    return {name for name in rosservice.get_service_list() if '/controller_manager/' in name}


def graph():
    """Return what the simulator publishes, subscribes to and serves, with types."""
    master = rosgraph.Master(rospy.get_name())
    published, subscribed, services = master.getSystemState()
    types = dict(master.getTopicTypes())

    def of_simulator(entries):
        return [name for name, nodes in entries if '/gazebo' in nodes]

    return {
        'publishes': {name: types[name] for name in of_simulator(published)},
        'subscribes': {name: types[name] for name in of_simulator(subscribed)},
        'services': {name: rosservice.get_service_type(name) for name in of_simulator(services)},
    }


def added(before):
    """Return what has come since."""
    return {
        kind: {name: entry for name, entry in entries.items() if name not in before[kind]}
        for kind, entries in graph().items()
    }


def periods(messages):
    """Return the times between messages [s]."""
    return {
        round((after.header.stamp - before.header.stamp).to_sec(), 6)
        for before, after in pairwise(messages)
    }
