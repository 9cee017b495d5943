"""The included worlds are at rest; worlds from files move by mechanics."""

import itertools
import logging
import math

import pytest
from support import LIBRARY, SETTLED, SPAWN_POSE, robot_spec

from rosbots_description.sim.core.errors import ModelError
from rosbots_description.sim.core.transforms import Pose, compose, to_rpy
from rosbots_description.sim.description.model_spec import Box
from rosbots_description.sim.formats.sdf.world_file import load_world, open_world
from rosbots_description.sim.resources.search_path import ModelSearch, find_world
from rosbots_description.sim.runtime.population import populate
from rosbots_description.sim.runtime.world import World

STILL = 0.001  # [m] permitted drift at rest in the time below
TURNED = 0.001  # [rad] permitted rotation
SECONDS = 3000  # steps of 1 ms
OWN_WORLDS = {
    'empty': ['ground_plane'],
    'shapes': ['ground_plane', 'box', 'sphere', 'cylinder'],
    'room': [
        'ground_plane',
        'walls',
        'table',
        'bookcase',
        'column',
        'crate_large',
        'crate_small',
        'barrel',
        'ball',
    ],
    'maze': ['ground_plane', 'maze'],
    'line': ['ground_plane', 'line'],
    'rooms': ['ground_plane', 'walls', 'column', 'cupboard', 'crate', 'shelf'],
}


@pytest.fixture(name='world')
def fixture_world():
    world = World()
    yield world
    world.close()


def load(text):
    return load_world(text, 'w.world', find_model=ModelSearch())


def own(name):
    return open_world(find_world(f'worlds/{name}.world', [LIBRARY]), find_model=ModelSearch())


def fill(world, body):
    spec = load(f'<sdf version="1.6"><world name="w">{body}</world></sdf>')
    assert spec.faults == ()
    populate(world, spec)
    return spec


@pytest.mark.parametrize('name', OWN_WORLDS)
def test_included_worlds_are_at_rest(world, name, caplog):
    populate(world, own(name))
    before = {model.name: model.pose for model in world.models.values()}
    world.run(SECONDS)
    assert list(world.models) == OWN_WORLDS[name]
    for model in world.models.values():
        was, now = before[model.name], model.pose
        assert math.dist(was.position, now.position) < STILL, model.name
        turn = 2.0 * math.acos(
            min(1.0, abs(sum(a * b for a, b in zip(was.orientation, now.orientation, strict=True))))
        )
        assert turn < TURNED, model.name
    assert [r.getMessage() for r in caplog.records if r.levelno >= logging.WARNING] == []


@pytest.mark.parametrize('name', OWN_WORLDS)
def test_spawn_pose_of_the_robot_is_free(world, name):
    populate(world, own(name))
    robot = world.spawn(robot_spec(), 'rosbots', SPAWN_POSE)
    world.run(SETTLED)
    assert math.hypot(*robot.pose.position[:2]) < 0.05
    assert abs(to_rpy(robot.pose.orientation)[2]) < 0.05


@pytest.mark.parametrize('name', OWN_WORLDS)
def test_visible_faces_are_not_coplanar(name):
    boxes = []
    for spec, model_pose in own(name).models:
        for link in spec.links:
            for visual in link.visuals:
                pose = compose(compose(model_pose, link.pose), visual.pose)
                if isinstance(visual.geometry, Box) and abs(pose.orientation[3]) == 1.0:
                    sides = zip(pose.position, visual.geometry.size, strict=True)
                    boxes.append([(middle - side / 2, middle + side / 2) for middle, side in sides])
    assert boxes or name == 'empty'
    for one, other in itertools.combinations(boxes, 2):
        overlaps = [
            min(a[1], b[1]) - max(a[0], b[0]) > 1e-9 for a, b in zip(one, other, strict=True)
        ]
        for axis in range(3):
            if not all(overlaps[:axis] + overlaps[axis + 1 :]):
                continue
            for end in (0, 1):
                on_the_floor = axis == 2 and one[2][end] == 0.0
                assert on_the_floor or abs(one[axis][end] - other[axis][end]) > 1e-6, (one, other)


def test_walls_of_the_maze_stop_the_robot(world):
    populate(world, own('maze'))
    robot = world.spawn(robot_spec(), 'rosbots', SPAWN_POSE)
    world.run(SETTLED)
    next(iter(robot.plugins.values())).command(1.0, 0.0)
    world.run(10000)  # far longer than to the first wall, 3 m ahead
    assert 2.0 < robot.pose.position[0] < 3.0


def test_the_line_is_closed_and_bends_gently():
    (_, (line, _)) = own('line').models
    pieces = line.links[0].visuals
    for piece, following in zip(pieces, [*pieces[1:], pieces[0]], strict=True):
        assert line.links[0].collisions == ()
        half, other = piece.geometry.size[0] / 2, following.geometry.size[0] / 2
        end = compose(piece.pose, Pose((half, 0.0, 0.0))).position
        begin = compose(following.pose, Pose((-other, 0.0, 0.0))).position
        assert math.dist(end, begin) < 0.01
        turn = to_rpy(following.pose.orientation)[2] - to_rpy(piece.pose.orientation)[2]
        assert abs(math.remainder(turn, math.tau)) < math.radians(9.1)
        assert piece.pose.position[2] + piece.geometry.size[2] / 2 == pytest.approx(0.005)


def test_physics_of_the_file_is_applied(world):
    fill(
        world,
        """<gravity>0 0 -2</gravity>
      <physics type="ode"><max_step_size>0.002</max_step_size></physics>
      <model name="ball"><pose>0 0 100 0 0 0</pose><link name="link"/></model>""",
    )
    world.run(500)
    assert world.clock.now == pytest.approx(1.0)
    # g t^2 / 2, plus half a step of semi-implicit Euler
    fallen = 100.0 - world.models['ball'].pose.position[2]
    assert fallen == pytest.approx(1.0, rel=0.003)


def test_kinematic_link_is_fixed_and_supports_others(world):
    fill(
        world,
        """<model name="shelf"><pose>0 0 2 0 0 0</pose><link name="link">
      <kinematic>1</kinematic><collision name="c"><geometry><box><size>1 1 0.1</size></box>
      </geometry></collision></link></model>
      <model name="box"><pose>0 0 2.3 0 0 0</pose><link name="link"><collision name="c"><geometry>
      <box><size>0.5 0.5 0.5</size></box></geometry></collision></link></model>""",
    )
    world.run(1000)
    assert world.models['shelf'].pose.position == (0.0, 0.0, 2.0)
    assert world.models['box'].pose.position[2] == pytest.approx(2.3, abs=0.01)


DOORS = """<model name="doors"><pose>0 0 1 0 0 0</pose>{}</model>""".format(
    ''.join(
        f'''<link name="{side}"><pose>0 {y} 0 0 0 0</pose><inertial><mass>5</mass></inertial></link>
    <joint name="{side}_hinge" type="revolute"><parent>world</parent><child>{side}</child>
    <pose>0 {-y / 2} 0 0 0 0</pose><axis><xyz>0 0 1</xyz></axis></joint>'''
        for side, y in (('left', 1.0), ('right', -1.0))
    )
)


def test_doors_hinged_to_the_world_swing(world):
    fill(world, DOORS)
    doors = world.models['doors']
    doors.joints['left_hinge'].set_motor(1.0, 100.0)
    world.run(1000)
    left, right = doors.links['left'].pose, doors.links['right'].pose
    assert to_rpy(left.orientation)[2] == pytest.approx(1.0, abs=0.05)
    # It turns about the hinge, 0.5 m from its centre.
    assert left.position == pytest.approx(
        (-0.5 * math.sin(1.0), 0.5 + 0.5 * math.cos(1.0), 1.0), abs=0.03
    )
    assert right.position == pytest.approx((0.0, -1.0, 1.0), abs=0.001)


def test_wheels_on_a_fixed_stand_turn(world):
    wheels = ''.join(
        f'''<link name="{side}"><pose>0 {y} 0 1.5708 0 0</pose><inertial><mass>1</mass></inertial>
        <collision name="c"><geometry><cylinder><radius>0.1</radius><length>0.05</length></cylinder>
        </geometry></collision></link><joint name="{side}_joint" type="revolute">
        <parent>world</parent><child>{side}</child><axis><xyz>0 0 1</xyz></axis></joint>'''
        for side, y in (('left', 0.2), ('right', -0.2))
    )
    fill(
        world,
        f"""<model name="stand"><pose>0 0 1 0 0 0</pose>{wheels}
      <plugin name="drive" filename="libgazebo_ros_diff_drive.so"><leftJoint>left_joint</leftJoint>
      <rightJoint>right_joint</rightJoint><wheelSeparation>0.4</wheelSeparation>
      <wheelDiameter>0.2</wheelDiameter><wheelTorque>100</wheelTorque></plugin></model>""",
    )
    stand = world.models['stand']
    next(iter(stand.plugins.values())).command(0.5, 0.0)
    world.run(1000)
    for joint in stand.joints.values():
        assert abs(joint.velocity) == pytest.approx(5.0, rel=0.1)


def test_saved_state_restores_models_and_joints(world):
    y, x = 0.5 + 0.5 * math.cos(0.8), -0.5 * math.sin(0.8)
    fill(
        world,
        DOORS
        + f"""<state world_name="w"><sim_time>3 250000000</sim_time>
      <model name="doors"><pose>10 0 1 0 0 0</pose>
      <link name="left"><pose>{10 + x} {y} 1 0 0 0.8</pose></link>
      <link name="right"><pose>10 -1 1 0 0 0</pose></link></model></state>""",
    )
    doors = world.models['doors']
    assert world.clock.now == 3.25
    assert doors.joints['left_hinge'].position == pytest.approx(0.8)
    assert doors.links['left'].pose.position == pytest.approx((10 + x, y, 1.0))
    assert doors.links['right'].pose.position == pytest.approx((10.0, -1.0, 1.0))
    assert doors.initial_pose.position == (0.0, 0.0, 1.0)


def test_saved_state_restores_links_of_a_static_model(world):
    fill(
        world,
        """<model name="posts"><static>1</static><link name="a"/><link name="b"/></model>
      <state world_name="w"><model name="posts"><pose>1 0 0 0 0 0</pose>
      <link name="a"><pose>1 0 0 0 0 0</pose></link><link name="b"><pose>1 5 0 0 0 0</pose></link>
      </model></state>""",
    )
    links = world.models['posts'].links
    assert [link.pose.position for link in links.values()] == [(1.0, 0.0, 0.0), (1.0, 5.0, 0.0)]


def test_fixed_joints_of_an_sdf_are_rigid(world):
    fill(
        world,
        """<model name="pair"><pose>0 0 9 0 0 0</pose><link name="a"/>
      <link name="b"><pose>1 0 0 0 0 0</pose></link>
      <joint name="j" type="fixed"><parent>a</parent><child>b</child></joint></model>""",
    )
    pair = world.models['pair']
    world.run(300)
    a, b = (link.pose.position for link in pair.links.values())
    assert a[2] < 9.0
    assert (b[0] - a[0], b[1] - a[1], b[2] - a[2]) == pytest.approx((1.0, 0.0, 0.0), abs=1e-6)


@pytest.mark.parametrize(
    ('world_name', 'place', 'overlaps'),
    [
        ('empty', (0.0, 0.0, 0.5), {}),
        ('empty', (0.0, 0.0, -0.12), {}),  # at rest
        ('empty', (0.0, 0.0, -0.2), {'ground_plane': 0.08}),
        ('shapes', (0.0, 0.0, 0.5), {}),
        ('shapes', (2.5, 0.0, 0.5), {'box': 0.29}),
        ('maze', (0.0, 0.0, 0.0), {}),
    ],
)
def test_overlaps_of_a_spawned_model_are_found(world, world_name, place, overlaps):
    populate(world, own(world_name))
    robot = world.spawn(robot_spec(), 'rosbots', Pose(place))
    found = world.overlaps(robot)
    assert found == pytest.approx(overlaps, abs=0.001)


def test_search_for_overlaps_does_not_change_the_motion():
    ends = []
    for looks in (False, True):
        world = World()
        populate(world, own('shapes'))
        robot = world.spawn(robot_spec(), 'rosbots', Pose((2.0, 0.0, 0.6)))
        if looks:
            assert world.overlaps(robot)
        world.run(500)
        ends.append([model.pose for model in world.models.values()])
        world.close()
    assert ends[0] == ends[1]


def test_world_is_loaded_without_a_model_that_the_engine_rejects(world, monkeypatch, caplog):
    spawn = world.spawn

    def refuse_one(spec, name, pose):
        if name == 'bad':
            raise ModelError('no room')
        return spawn(spec, name, pose)

    monkeypatch.setattr(world, 'spawn', refuse_one)
    model = '<model name="{}"><static>1</static><link name="l"/></model>'
    populate(
        world,
        load(
            '<sdf version="1.6"><world name="w">'
            f'{model.format("bad")}{model.format("good")}</world></sdf>'
        ),
    )
    assert list(world.models) == ['good']
    assert caplog.messages == ["model 'bad': no room; this model is left out"]


def test_names_that_a_terminal_would_obey_are_not_logged_as_they_are(world, caplog):
    populate(
        world,
        load(
            '<sdf version="1.6"><world name="w"><plugin name="\u202ea" filename="b.so"/>'
            '<state world_name="w"><model name="\u202e\x7f"/></state></world></sdf>'
        ),
    )
    assert len(caplog.messages) == 2
    assert all(message.isprintable() for message in caplog.messages)
