"""Models inserted where there is room, under names that are free; and models copied."""

import math

import pytest
from geometry_msgs.msg import Point, Pose, Quaternion
from rosbots_msgs.srv import GetModelDescriptionRequest, InsertModelRequest
from support import robot_spec
from support.bench import ALL, BOX, DOOR, LAMP, Bench, empty_world

from rosbots_description.sim.core.transforms import IDENTITY, from_rpy

WALL = """<sdf version="1.6"><model name="wall"><static>1</static><link name="link">
  <collision name="c"><geometry><box><size>{}</size></box></geometry></collision></link>
</model></sdf>"""


@pytest.fixture
def world():
    with empty_world() as world:
        yield world


@pytest.fixture
def bench(world):
    return Bench(world)


def pose(x=0.0, y=0.0, z=0.0, **angles):
    turn = from_rpy(angles.get('roll', 0.0), 0.0, angles.get('yaw', 0.0))
    return Pose(Point(x, y, z), Quaternion(*turn))


def insert(bench, text, **request):
    """Insert on the ground beside the others; return the model."""
    response = bench.call(
        'insert_model',
        InsertModelRequest(
            **{
                'model_xml': text,
                'initial_pose': pose(),
                'on_ground': True,
                'beside': True,
                **request,
            }
        ),
    )
    assert response.success, response.status_message
    return bench.world.models[response.model_name]


def test_names_are_free(bench, world):
    assert [insert(bench, BOX).name for _ in range(3)] == ['b', 'b_0', 'b_1']
    assert insert(bench, BOX, model_name='mine').name == 'mine'
    lamps = [
        bench.call('insert_model', InsertModelRequest(model_xml=LAMP)).model_name for _ in range(2)
    ]
    assert lamps == ['lamp', 'lamp_0']
    assert list(world.lights) == ['sun', 'lamp', 'lamp_0']


@pytest.mark.parametrize(('text', 'names'), [(BOX, ['b', 'b_0']), (LAMP, ['lamp', 'lamp_0'])])
def test_two_that_are_prepared_at_once_get_different_names(bench, text, names):
    service = ALL['insert_model']
    prepared = [service.prepare(bench.server, InsertModelRequest(model_xml=text)) for _ in range(2)]
    responses = [service.answer(bench.server, one) for one in prepared]
    assert [one.model_name for one in responses] == names
    assert all(one.success for one in responses)


def test_model_stands_on_the_ground_however_it_is_turned(bench):
    box = insert(bench, BOX, initial_pose=pose(3.0, 4.0, 0.5, roll=math.pi / 4.0))
    assert box.pose.position == pytest.approx((3.0, 4.0, 0.5 + math.sqrt(0.5)))


def test_robot_stands_on_its_wheels(bench, world):
    robot = world.spawn(robot_spec(), 'robot', IDENTITY)
    spec = robot.spec
    text = bench.call('get_model_description', GetModelDescriptionRequest('robot')).model_xml
    world.delete('robot')
    robot = insert(bench, text)
    assert robot.spec.links == spec.links
    assert robot.spec.reduced == spec.reduced  # plugins may name these links
    height = robot.pose.position[2]
    world.run(500)
    # It has neither fallen nor risen.
    assert robot.pose.position[2] == pytest.approx(height, abs=2e-3)


def test_models_come_beside_each_other(bench, world):
    boxes = [insert(bench, BOX) for _ in range(12)]
    assert boxes[0].pose.position == (0.0, 0.0, 0.5)
    assert all(world.overlaps(box).keys() <= {'ground_plane'} for box in boxes)
    assert all(box.pose.position[2] == 0.5 for box in boxes)
    assert all(math.hypot(*box.pose.position[:2]) < 3.5 for box in boxes)  # close together


def test_within_a_room_there_is_room(bench):
    insert(bench, WALL.format('0.1 8 2'), initial_pose=pose(4.0))
    insert(bench, WALL.format('0.1 8 2'), initial_pose=pose(-4.0))
    assert insert(bench, BOX, initial_pose=pose()).pose.position == (0.0, 0.0, 0.5)


def test_on_a_floor_there_is_room_and_above_what_fills_all_places_too(bench):
    floor = insert(bench, WALL.format('50 50 1'), initial_pose=pose(z=-1.0))
    assert floor.pose.position[2] == -0.5
    assert insert(bench, BOX).pose.position == (0.0, 0.0, 0.5)
    insert(bench, WALL.format('80 80 1'), initial_pose=pose(z=3.0), beside=False)
    assert insert(bench, BOX, initial_pose=pose(z=3.0)).pose.position == (0.0, 0.0, 4.5)


def test_within_a_building_of_one_mesh_there_is_room(bench, tmp_path):
    walls = tmp_path / 'walls.obj'  # two triangles, 8 m apart
    walls.write_text(
        'v -4 -4 0\nv -4 4 0\nv -4 0 3\nv 4 -4 0\nv 4 4 0\nv 4 0 3\nf 1 2 3\nf 4 5 6\n'
    )
    building = WALL.replace('<box><size>{}</size></box>', f'<mesh><uri>file://{walls}</uri></mesh>')
    insert(bench, building)
    assert insert(bench, BOX).pose.position == (0.0, 0.0, 0.5)


def test_without_on_ground_and_beside_the_pose_is_as_given(bench):
    insert(bench, BOX)
    box = insert(bench, BOX, initial_pose=pose(0.1, 0.0, 0.2), on_ground=False, beside=False)
    assert box.pose.position == (0.1, 0.0, 0.2)


def test_copy_is_as_the_model_is_now(bench, world):
    door = insert(bench, DOOR, initial_pose=pose(1.0, 2.0, 3.0, yaw=1.0), on_ground=False)
    door.joints['hinge'].set_position(0.5)
    found = bench.call('get_model_description', GetModelDescriptionRequest('door'))
    assert found.joint_names == ['hinge']
    copy = insert(
        bench,
        found.model_xml,
        initial_pose=found.pose,
        on_ground=False,
        beside=False,
        joint_names=found.joint_names,
        joint_positions=found.joint_positions,
    )
    assert copy.name == 'door_0'
    assert copy.joints['hinge'].position == pytest.approx(0.5)
    assert copy.pose.position == pytest.approx(door.pose.position)
    assert copy.links['box'].pose.position == pytest.approx(door.links['box'].pose.position)
    assert copy.spec.joints == door.spec.joints


@pytest.mark.parametrize(
    ('request_of', 'sentence'),
    [
        ({'model_xml': ''}, 'empty'),
        ({'model_xml': '<robot><link name="a"/></robot>'}, 'gives the model no name'),
        ({'model_xml': BOX.replace('</robot>', '')}, 'model_xml, line'),
        ({'model_xml': '<html name="a"/>', 'model_name': 'a'}, 'not SDF or URDF'),
        ({'model_xml': BOX, 'joint_names': ['a']}, 'different lengths'),
        ({'model_xml': BOX, 'initial_pose': pose(math.nan)}, 'initial_pose.position.x is nan'),
    ],
)
def test_bad_requests_are_refused_in_a_sentence(bench, world, request_of, sentence):
    response = bench.call('insert_model', InsertModelRequest(**request_of))
    assert not response.success
    assert sentence in response.status_message
    assert list(world.models) == ['ground_plane']


def test_description_of_what_is_not_there_is_refused(bench):
    assert not bench.call('get_model_description', GetModelDescriptionRequest('x')).success
