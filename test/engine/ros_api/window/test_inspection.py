"""What the window reads and changes by services, on a real world without connections."""

import pytest
from support import box_urdf, empty_world, urdf_spec
from support.bench import Bench

from rosbots_description.ros_api.window import inspection
from rosbots_description.sim.core import Pose, SimError, Twist, from_rpy

TWO = box_urdf('1 1 1', 2.0) + (
    '<link name="arm"><inertial><mass value="1"/><inertia ixx="1" iyy="2" izz="2.5" ixy="0" '
    'ixz="0" iyz="0"/></inertial></link><joint name="j" type="continuous"><parent link="box"/>'
    '<child link="arm"/><origin xyz="0 0 1"/><axis xyz="0 0 1"/></joint>'
)
PLACE = Pose((1.0, 2.0, 3.0), from_rpy(0.0, 0.0, 1.0))
MOTION = Twist((0.5, 0.0, 0.0), (0.0, 0.0, 0.25))


@pytest.fixture
def world():
    with empty_world() as world:
        world.spawn(urdf_spec(TWO), 'robot', Pose((0.0, 0.0, 5.0)))
        yield world


@pytest.fixture
def robot(world, monkeypatch):
    bench = Bench(world)

    def call(name, kind, _timeout=0.0, /, **request):
        answer = bench.call(name, kind._request_class(**request))
        if not answer.success:
            raise SimError(answer.status_message)
        return answer

    monkeypatch.setattr(inspection, 'call', call)
    return inspection.RosInspection()


@pytest.mark.parametrize('link', [None, 'box', 'arm'])
def test_a_state_that_was_set_is_read(world, robot, link):
    robot.set_state('robot', link, PLACE, MOTION)
    pose, twist = robot.state('robot', link)
    assert pose.position == pytest.approx(PLACE.position, abs=1e-9)
    assert pose.orientation == pytest.approx(PLACE.orientation, abs=1e-9)
    assert twist.linear == pytest.approx(MOTION.linear, abs=1e-9)
    assert twist.angular == pytest.approx(MOTION.angular, abs=1e-9)
    height = world.models['robot'].pose.position[2]
    assert height == pytest.approx(2.0 if link == 'arm' else 3.0)


def test_inertia_changes_with_the_mass_and_gravity_can_be_switched(world, robot):
    robot.set_mass('robot', 'arm', 3.0, False)
    inertial = world.models['robot'].links['arm'].spec.inertial
    assert (inertial.mass, inertial.ixx, inertial.iyy, inertial.izz) == (3.0, 3.0, 6.0, 7.5)
    assert not world.models['robot'].links['arm'].spec.gravity


def test_friction_is_set_by_the_name_of_model_link_or_collision(world, robot):
    surface = world.models['robot'].links['box'].collisions['box_collision']
    for mu, name in enumerate(('robot', 'robot::box', 'robot::box::box_collision'), 2):
        robot.set_friction(name, float(mu), 0.5)
        assert (surface.spec.surface.mu, surface.spec.surface.mu2) == (float(mu), 0.5)


def test_refusals_are_the_servers_sentences(robot):
    with pytest.raises(SimError, match='model does not exist'):
        robot.state('nobody', None)
    with pytest.raises(SimError, match=r"mass is -1\.0; link 'robot::arm' moves"):
        robot.set_mass('robot', 'arm', -1.0, True)
    with pytest.raises(SimError, match="named 'robot::leg'"):
        robot.set_friction('robot::leg', 1.0, 1.0)
