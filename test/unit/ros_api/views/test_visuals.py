"""The markers of a world: content, and that each is sent once."""

from concurrent.futures import Future

import pytest
from support.fake_engine import FakeEngine
from visualization_msgs.msg import Marker

from rosbots_description.ros_api.views.markers import PLANE_DEPTH, visual_marker
from rosbots_description.ros_api.views.visuals import REFRESH, ShownMarkers, SunlitMarkers
from rosbots_description.sim.core.transforms import IDENTITY, Pose
from rosbots_description.sim.description.model_spec import (
    Box,
    Cylinder,
    LinkSpec,
    Material,
    Mesh,
    ModelSpec,
    Plane,
    Sphere,
    Visual,
)
from rosbots_description.sim.runtime.world import World

RED = Material((1.0, 0.0, 0.0, 0.5))


def _spawn(world, name, geometry, visual='v'):
    link = LinkSpec('link', visuals=(Visual(visual, geometry),))
    return world.spawn(ModelSpec(name, (link,)), name, IDENTITY)


@pytest.fixture
def empty():
    return World(make_engine=FakeEngine)


@pytest.fixture
def world(empty):
    _spawn(empty, 'box', Box((1.0, 2.0, 3.0)))
    return empty


@pytest.mark.parametrize(
    ('geometry', 'kind', 'scale'),
    [
        (Box((1.0, 2.0, 3.0)), Marker.CUBE, (1.0, 2.0, 3.0)),
        (Sphere(0.5), Marker.SPHERE, (1.0, 1.0, 1.0)),
        (Cylinder(0.5, 2.0), Marker.CYLINDER, (1.0, 1.0, 2.0)),
        (Plane(size=(10.0, 20.0)), Marker.TRIANGLE_LIST, (10.0, 20.0, 1.0)),
        (Mesh('/a b/c.dae', (2.0, 2.0, 2.0)), Marker.MESH_RESOURCE, (2.0, 2.0, 2.0)),
    ],
)
def test_shape_has_a_marker_of_its_type_and_scale(geometry, kind, scale):
    marker = visual_marker('m::l', 3, Visual('v', geometry, material=RED))
    assert (marker.type, marker.ns, marker.id) == (kind, 'm::l', 3)
    assert (marker.scale.x, marker.scale.y, marker.scale.z) == scale
    assert (marker.color.r, marker.color.a) == (1.0, 0.5)
    assert marker.header.frame_id == 'world'


def test_a_mesh_without_material_keeps_its_own_colours():
    marker = visual_marker('m::l', 0, Visual('v', Mesh('/a b/c.dae')))
    assert marker.mesh_resource == 'file:///a%20b/c.dae'
    assert marker.mesh_use_embedded_materials
    assert marker.color.a == 0.0


def test_plane_has_vertex_colours_and_lies_below_the_grid(empty):
    _spawn(empty, 'ground', Plane())
    _, marker = ShownMarkers(empty).changes()
    assert len(marker.colors) == len(marker.points) == 6
    assert marker.pose.position.z == -PLANE_DEPTH


def test_moved_model_is_updated(world):
    view = ShownMarkers(world)
    view.changes()
    world.models['box'].set_pose(Pose((1.0, 2.0, 3.0)))
    (marker,) = view.changes()
    assert (marker.pose.position.x, marker.pose.position.z) == (1.0, 3.0)


def test_new_model_of_the_same_name_replaces_the_deleted_one(world):
    view = ShownMarkers(world)
    view.changes()
    world.delete('box')
    _spawn(world, 'box', Sphere(1.0))
    gone, came = view.changes()
    assert (gone.action, gone.ns, gone.id) == (Marker.DELETE, 'box::link', 0)
    assert (came.action, came.type) == (Marker.ADD, Marker.SPHERE)
    world.delete('box')
    assert [m.action for m in view.changes()] == [Marker.DELETE]


def test_all_markers_are_repeated_periodically_and_for_new_subscribers(world):
    view = ShownMarkers(world)
    for _ in range(2):
        assert [m.action for m in view.changes()] == [Marker.DELETEALL, Marker.ADD]
        assert [len(view.changes()) for _ in range(REFRESH)] == [0] * (REFRESH - 1) + [1]
        view.reset()


class FakeThread:
    """Records submitted work until a test runs it."""

    def __init__(self):
        self.jobs = []

    def submit(self, work, *arguments):
        future = Future()
        self.jobs.append(lambda: future.set_result(work(*arguments)))
        return future


class FakeMeshes:
    """Returns a file for everything but planes."""

    def file(self, visual):
        return None if isinstance(visual.geometry, Plane) else f'/made/{visual.name}.mesh'


@pytest.fixture
def thread():
    return FakeThread()


@pytest.fixture
def view(world, thread):
    return SunlitMarkers(world, FakeMeshes(), thread)


def test_model_is_sent_to_the_window_when_its_files_exist(thread, view):
    assert [m.action for m in view.changes()] == [Marker.DELETEALL]
    assert view.changes() == []
    (job,) = thread.jobs
    job()
    (marker,) = view.changes()
    assert (marker.type, marker.mesh_resource) == (Marker.MESH_RESOURCE, 'file:///made/v.mesh')
    assert (marker.scale.x, marker.scale.y, marker.scale.z) == (1.0, 2.0, 3.0)
    assert marker.mesh_use_embedded_materials
    assert marker.color.a == 0.0


def test_shape_without_a_file_uses_the_standard_marker(world, thread, view):
    world.delete('box')
    _spawn(world, 'box', Plane())
    view.changes()
    thread.jobs.pop()()
    (marker,) = view.changes()
    assert marker.type == Marker.TRIANGLE_LIST


def test_files_of_a_deleted_model_are_not_sent(world, thread, view):
    view.changes()
    first = thread.jobs.pop()
    world.delete('box')
    _spawn(world, 'box', Sphere(1.0), 'other')
    first()
    assert view.changes() == []
    thread.jobs.pop()()
    (marker,) = view.changes()
    assert marker.mesh_resource == 'file:///made/other.mesh'
    world.delete('box')
    assert [m.action for m in view.changes()] == [Marker.DELETE]
