"""Property tests: invariants hold for any sequence of spawns, deletions, moves and resets."""

import math

import pytest
from gazebo_msgs.msg import LinkState, ModelState
from gazebo_msgs.srv import (
    DeleteModelRequest,
    GetJointPropertiesRequest,
    GetModelStateRequest,
    SetLinkStateRequest,
    SetModelConfigurationRequest,
    SetModelStateRequest,
    SpawnModelRequest,
)
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule
from rosbots_msgs.srv import StepRequest
from std_srvs.srv import EmptyRequest
from support import empty_world, robot_urdf
from support.bench import BOX, NESTED, Bench
from support.invariants import numbers_in
from support.isolation import Child

STEP_NS = 1_000_000
POSITIONS = st.floats(-20.0, 20.0)  # [m]
HEIGHTS = st.floats(1.0, 5.0)  # [m]
SPEEDS = st.floats(-5.0, 5.0)  # [m/s]
# None is the name of a link: as in Gazebo, it would hide later models of that name.
NAMES = ('a', 'b', 'c', 'd', 'ground_plane', 'nobody')
DESCRIPTIONS = {'box': BOX, 'nested': NESTED, 'robot': robot_urdf()}


@pytest.fixture(scope='module', autouse=True)
def _world():
    """Return the open world of all examples; each uses a copy in a child process."""
    with empty_world() as world:
        for name, text in DESCRIPTIONS.items():  # children inherit the converted meshes
            spawn = SpawnModelRequest(model_name=name, model_xml=text)
            assert Bench(world).call('spawn_sdf_model', spawn).success
            world.delete(name)
        WorldInvariants.world = world
        yield


class Simulator(Bench):
    """Operations of the child process."""

    def state(self):
        """Return names, time [ns], whether paused, and whether every model's state is finite."""
        states = [model.state() for model in self.world.models.values()]
        finite = all(map(math.isfinite, numbers_in(states)))
        return self.names(), self.world.clock.now_ns, self.world.paused, finite

    def run_unless_paused(self, steps):
        """Run steps unless paused, like the loop."""
        if not self.world.paused:
            self.world.run(steps)


class WorldInvariants(RuleBasedStateMachine):
    """Compares the simulator with a simple model of its state."""

    world = None

    def __init__(self):
        super().__init__()
        self.child = Child(lambda: Simulator(self.world))
        _, self.now_ns, self.paused, _ = self.child.call('state')
        self.homes = {'ground_plane': (0.0, 0.0, 0.0)}  # spawn position by model, in order

    def teardown(self):
        self.child.__exit__()

    def call(self, service, request=None):
        """Call a service."""
        return self.child.call('call', service, request or EmptyRequest())

    def position(self, name):
        position = self.call('get_model_state', GetModelStateRequest(model_name=name)).pose.position
        return position.x, position.y, position.z

    @rule(
        name=st.sampled_from(NAMES),
        kind=st.sampled_from(sorted(DESCRIPTIONS)),
        x=POSITIONS,
        y=POSITIONS,
        z=HEIGHTS,
    )
    def spawn(self, name, kind, x, y, z):
        request = SpawnModelRequest(model_name=name, model_xml=DESCRIPTIONS[kind])
        position = request.initial_pose.position
        position.x, position.y, position.z = x, y, z
        success = self.call('spawn_sdf_model', request).success
        assert success == (name not in self.homes)
        if success:
            self.homes[name] = (x, y, z)

    @rule(name=st.sampled_from(NAMES))
    def delete(self, name):
        assert self.call('delete_model', DeleteModelRequest(name)).success == (name in self.homes)
        self.homes.pop(name, None)

    @rule(name=st.sampled_from(NAMES), x=POSITIONS, y=POSITIONS, z=HEIGHTS, speed=SPEEDS)
    def teleport(self, name, x, y, z, speed):
        state = ModelState(model_name=name)
        state.pose.position.x, state.pose.position.y, state.pose.position.z = x, y, z
        state.twist.linear.x = speed
        response = self.call('set_model_state', SetModelStateRequest(state))
        if name in self.homes:
            assert response.success
            assert self.position(name) == pytest.approx((x, y, z))

    @rule(name=st.sampled_from(('box', 'a::box', 'base_footprint', 'arm', 'inner::arm')), z=HEIGHTS)
    def lift_a_link(self, name, z):
        state = LinkState(link_name=name)
        state.pose.position.z = z
        self.call('set_link_state', SetLinkStateRequest(state))

    @rule(name=st.sampled_from(NAMES), angle=st.floats(-3.0, 3.0))
    def turn_a_wheel(self, name, angle):
        joint = f'{name}::wheel_left_joint'
        request = SetModelConfigurationRequest(name, '', [joint], [angle])
        assert self.call('set_model_configuration', request).success == (name in self.homes)
        state = self.call('get_joint_properties', GetJointPropertiesRequest(joint))
        if state.success:
            assert state.position[0] == pytest.approx(angle)

    @rule()
    def pause(self):
        self.call('pause_physics')
        self.paused = True

    @rule()
    def unpause(self):
        self.call('unpause_physics')
        self.paused = False

    @rule(steps=st.integers(0, 60))
    def step(self, steps):
        assert self.call('step', StepRequest(steps)).success == self.paused
        self.now_ns += steps * STEP_NS if self.paused else 0

    @rule(steps=st.integers(1, 150))
    def time_passes(self, steps):
        self.child.call('run_unless_paused', steps)
        self.now_ns += 0 if self.paused else steps * STEP_NS

    @rule()
    def reset_world(self):
        self.call('reset_world')
        self.models_are_at_their_spawn_poses()

    @rule()
    def reset_simulation(self):
        self.call('reset_simulation')
        self.now_ns = 0
        self.models_are_at_their_spawn_poses()

    def models_are_at_their_spawn_poses(self):
        for name, home in self.homes.items():
            assert self.position(name) == pytest.approx(home, abs=1e-6)

    @invariant()
    def names_time_and_states_are_as_expected(self):
        names, now_ns, paused, finite = self.child.call('state')
        assert (names, now_ns, paused) == (list(self.homes), self.now_ns, self.paused)
        assert finite


WorldInvariants.TestCase.settings = settings(
    max_examples=1 + settings.default.max_examples // 3, stateful_step_count=30
)
TestWorldInvariants = WorldInvariants.TestCase
