"""What is inserted, where, and how it is undone."""

import pytest
from support.browser import Browser
from support.window import model, selection

from rosbots_description.sim.core import Pose
from rosbots_description.sim.description import Box, Cylinder, SceneChange, Sphere
from rosbots_description.web.editing.shapes import point_light, shape
from rosbots_description.web.scene.ground_clicks import on_ground
from rosbots_description.web.site import uploads

UPLOAD = 'Upload URDF, xacro or SDF'


def inserted(simulator):
    """Return what the simulator was told to insert."""
    return [text for _, text, *_ in simulator.done('insert')]


@pytest.fixture
def ready(browser):
    """A browser whose camera looks at (1, 2, 3)."""
    browser.wait_until(lambda: browser.control(UPLOAD))
    browser.look_at([1.0, 2.0, 3.0])
    return browser


def test_shape_is_inserted_on_the_ground_where_the_camera_looks(ready, simulator):
    ready.choose('Kind', 'cylinder')
    ready.choose('Size [m]', [0.4, 0.0, 2.0])
    ready.choose('Shape mass [kg]', 3.0)
    ready.choose('Colour', [255, 0, 51])
    ready.choose('Static', True)
    ready.click('Insert shape')
    ready.wait_until(lambda: inserted(simulator))
    ((_, text, *placed),) = simulator.told
    assert placed == [True, True]  # on the ground, beside others
    assert text.pose == Pose((1.0, 2.0, 0.0))
    assert text.xml.static
    (link,) = text.xml.links
    assert link.collisions[0].geometry == link.visuals[0].geometry == Cylinder(0.2, 2.0)
    assert link.visuals[0].material.rgba == (1.0, 0.0, 0.2, 1.0)
    assert link.inertial.mass == 3.0
    ready.click("Undo: insert 'new cylinder'")
    ready.wait_until(lambda: simulator.told[-1] == ('delete', 'new cylinder'))


def test_lamp_is_above_the_place(ready, simulator):
    ready.click('Insert light')
    ready.wait_until(lambda: inserted(simulator))
    (text,) = inserted(simulator)
    assert text.xml.pose == Pose((1.0, 2.0, 2.0))


def test_light_is_deleted_and_comes_back(ready, simulator):
    ready.click('Delete light')
    ready.wait_until(lambda: 'there is no light' in ready.notes())
    light = point_light((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    simulator.change(SceneChange(True, lights={'lamp': light}))
    ready.wait_until(lambda: ready.value('Light') == 'lamp')
    ready.click('Delete light')
    ready.click("Undo: delete 'lamp'")
    ready.wait_until(lambda: inserted(simulator))
    assert simulator.told[0] == ('delete', 'lamp')
    assert inserted(simulator)[0].xml == light


def test_models_of_the_model_path_are_offered(ready, simulator, page):
    ready.click('Insert model')
    ready.wait_until(lambda: 'there is no model on the model path' in ready.notes())
    simulator.names = ['table', 'ground_plane', 'chair']
    ready.wait_until(
        lambda: page.poll() or ready.props('Model path')['options'] == ['table', 'chair']
    )
    ready.choose('Model path', 'chair')
    ready.click('Insert model')
    ready.wait_until(lambda: inserted(simulator))
    assert inserted(simulator)[0].xml == 'model chair'


def test_file_is_uploaded_and_what_it_becomes_is_selected(ready, simulator, page):
    ready.upload(UPLOAD, '../../a.urdf', 1500 * b'x')
    ready.wait_until(lambda: ready.control("Undo: insert 'new '"))
    simulator.change(SceneChange(True, (model('new ', 1),)))
    assert selection(page).model == 'new '
    assert inserted(simulator)[0].xml == '../../a.urdf: ' + 1500 * 'x'


def test_refusal_is_shown_and_nothing_can_be_undone(ready, simulator):
    simulator.fault = 'InsertModel: Failure - because'
    ready.upload(UPLOAD, 'a.urdf', b'<robot')
    ready.wait_until(lambda: simulator.fault in ready.notes())
    assert ready.control('Undo')


@pytest.mark.parametrize('claimed', [uploads.MAX_BYTES + 1, 2999, 3001])
def test_file_that_is_too_large_or_not_as_large_as_claimed_is_dropped(ready, simulator, claimed):
    ready.upload(UPLOAD, 'large.urdf', 3000 * b'x', claimed=claimed)
    ready.wait_until(lambda: ready.noted("'large.urdf' has"))
    ready.upload(UPLOAD, 'b.urdf', b'b')
    ready.wait_until(lambda: inserted(simulator))
    assert [text.xml for text in inserted(simulator)] == ['b.urdf: b']


def test_empty_file_is_handed_over(ready, simulator):
    ready.upload(UPLOAD, 'empty.urdf', b'')
    ready.wait_until(lambda: inserted(simulator))
    assert inserted(simulator)[0].xml == 'empty.urdf: '


def test_files_of_two_browsers_at_once_are_not_confused(ready, simulator, site):
    with Browser(site.address) as other:
        other.wait_until(lambda: other.control(UPLOAD))
        for browser, name in ((ready, 'one'), (other, 'two')):
            browser.upload(UPLOAD, name, name.encode())
        ready.wait_until(lambda: len(inserted(simulator)) == 2)
    assert {text.xml for text in inserted(simulator)} == {'one: one', 'two: two'}


def test_what_a_model_was_spawned_without_is_shown(ready, simulator):
    simulator.missing = [f"plugin '{number}'" for number in range(6)]
    ready.upload(UPLOAD, 'a.urdf', b'a')
    ready.wait_until(
        lambda: ready.noted(
            "was spawned without plugin '0', plugin '1', plugin '2', plugin '3' and 2 more"
        )
    )


def test_place_is_where_one_clicks_once(ready, simulator, site):
    ready.click('Choose the place')
    ready.wait_until(lambda: ready.noted('Click on the ground'))
    with Browser(site.address) as other:  # its clicks are its own
        other.wait_until(lambda: len(site.get_clients()) == 2)
        other.click_ray([9.0, 9.0, 9.0], [0.0, 0.0, -1.0])
        ready.click_ray([0.0, 0.0, 4.0], [0.0, 0.0, 1.0])  # the sky
        ready.wait_until(lambda: ready.noted('not on the ground'))
        ready.click_ray([0.0, 0.0, 4.0], [0.5, 0.0, -1.0])
        ready.wait_until(lambda: any(node.startswith('/clicked/') for node in ready.nodes))
    for _ in range(2):
        ready.click('Insert shape')
    ready.wait_until(lambda: len(inserted(simulator)) == 2)
    assert {text.pose.position for text in inserted(simulator)} == {
        (2.0, 0.0, 0.0),
        (1.0, 2.0, 0.0),
    }
    ready.wait_until(lambda: not any(node.startswith('/clicked/') for node in ready.nodes))


def test_ray_meets_the_ground_or_not():
    assert on_ground((1.0, 0.0, 2.0), (0.0, 1.0, -1.0)) == (1.0, 2.0, 0.0)
    assert on_ground((0.0, 0.0, 2.0), (1.0, 0.0, 0.0)) is None
    assert on_ground((0.0, 0.0, 2.0), (1.0, 0.0, -0.001)) is None  # 2 km away


@pytest.mark.parametrize(
    ('kind', 'geometry', 'moments'),
    [
        ('box', Box((1.0, 2.0, 3.0)), (13.0, 10.0, 5.0)),
        ('sphere', Sphere(0.5), (1.2, 1.2, 1.2)),
        ('cylinder', Cylinder(0.5, 3.0), (9.75, 9.75, 1.5)),
    ],
)
def test_inertia_is_that_of_a_solid(kind, geometry, moments):
    (link,) = shape(kind, (1.0, 2.0, 3.0), 12.0, (1.0, 1.0, 1.0), False).links
    inertial = link.inertial
    assert link.collisions[0].geometry == geometry
    assert (inertial.ixx, inertial.iyy, inertial.izz) == pytest.approx(moments)
