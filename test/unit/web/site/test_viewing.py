"""The token for viewing: whoever has it sees everything, and changes nothing but the own view."""

import io

import pytest
from PIL import Image
from support.browser import Browser
from support.patience import wait_until
from support.window import FakeSimulator, clock, model, selection, serving
from websockets.exceptions import ConnectionClosed, InvalidHandshake, InvalidStatus

from rosbots_description.sim.core import Pose
from rosbots_description.sim.description import CommandTopic, SceneChange
from rosbots_description.web import Page, Site, WindowError
from rosbots_description.web.editing.gizmo import NODE
from rosbots_description.web.scene.overlays import OVERLAYS
from rosbots_description.web.site.access import Pass
from rosbots_description.web.site.client_messages import KINDS
from rosbots_description.web.site.message_gate import LOOKS, OF_VIEWERS

BOX = '/models/box/link'
UPLOAD = 'Upload URDF, xacro or SDF'
SECRET, VIEWING = 'the-token-of-this-test', 'the-token-for-viewing'


@pytest.fixture(scope='module')
def served():
    simulator = FakeSimulator()
    simulator.topics = ('/cmd_vel',)
    simulator.joints.topics = (CommandTopic('/position'),)
    with serving('127.0.0.1', SECRET, viewing_token=VIEWING, most_viewers=3) as site:
        yield site, simulator, Page(site, simulator)


@pytest.fixture
def site(served):
    return served[0]


@pytest.fixture
def viewer(served):
    """A browser that may only look and has selected a model, beside one that controls."""
    site, simulator, page = served
    wait_until(lambda: not page.browsers, 'the end of those of other tests')
    with Browser(site.address) as owner:
        owner.wait_until(lambda: page.browsers)
        simulator.change(SceneChange(True, (model('box', 1), model('other', 2))))
        page.poll()
        selection(page).choose('other')
        owner.wait_until(lambda: NODE in owner.nodes)
        with Browser(site.viewing_address) as browser:
            browser.wait_until(lambda: browser.control(UPLOAD) and browser.control('Forward'))
            browser.wait_until(lambda: LOOKS in browser.notes())  # as it came in
            browser.click_node(f'{BOX}/0 v')
            browser.wait_until(lambda: f'{BOX}/selected' in browser.nodes)
            browser.messages.clear()
            simulator.told.clear()
            simulator.joints.told.clear()
            browser.owner = owner
            yield browser


# Everything that a page can send, but what is in OF_VIEWERS.
ACTS = {
    'GuiUpdateMessage': [
        lambda b, label=label: b.click(label) for label in ('Pause', 'Delete', 'World')
    ],
    'GuiButtonHoldMessage': [lambda b: b.hold('Forward')],
    'CommandTriggerMessage': [
        lambda b, key=key: b.press(key) for key in ('space', 'I', 'delete', 'D')
    ],
    'SceneNodeDragMessage': [lambda b: b.drag_node('/models/box', 'start', [0.0] * 3)],
    'ScenePointerMessage': [lambda b: b.click_ray([0.0, 0.0, 5.0], [0.0, 0.0, -1.0])],
    'TransformControlsDragStartMessage': [lambda b: b.grab(NODE)],
    'TransformControlsUpdateMessage': [lambda b: b.drag(NODE, [9.0, 0.0, 0.0])],
    'TransformControlsDragEndMessage': [lambda b: b.let_go(NODE)],
    'FileTransferStartUpload': [lambda b: b.upload(UPLOAD, 'x.urdf', b'<robot/>')],
}
EXPECTED = [(kind, act) for kind, acts in ACTS.items() for act in acts]


def test_each_kind_of_message_is_allowed_or_tried():
    assert set(KINDS) == set(ACTS) | OF_VIEWERS


@pytest.mark.parametrize(
    ('_kind', 'act'), EXPECTED, ids=[f'{kind}-{n}' for n, (kind, _) in enumerate(EXPECTED)]
)
def test_what_changes_anything_is_refused_with_one_notice(viewer, served, _kind, act):
    _, simulator, page = served
    act(viewer)
    viewer.wait_until(lambda: LOOKS in viewer.notes())
    viewer.look_at([1.0, 2.0, 3.0])  # read after it
    viewer.read(0.1)
    assert viewer.notes() == [LOOKS]
    assert simulator.done('state') == simulator.told
    assert simulator.joints.told == []
    assert [one.selection.model for one in page.browsers.values()] == ['other', 'box']


def test_a_value_that_was_changed_is_shown_as_it_is_again(viewer):
    before = viewer.value('Speed')
    viewer.choose('Speed', '10x')
    viewer.wait_until(
        lambda: {'value': before} in [m['updates'] for m in viewer.received('GuiUpdateMessage')]
    )


# What acts on a viewer's own browser only.
ALLOWED = {
    'Home',
    'Top',
    'Front',
    'Fit all',
    'Go to selection',
    'Follow the selection',
    'W A S D and arrows drive',
    'Find',
    'box',
    '\u2514 link',
    'other',
    'Only of what is selected',
    *OVERLAYS,
    'Picture',
}
ALLOWED_KEYS = {'escape', '?', 'H', 'T', 'F', 'X', 'G', 'V'}


def test_only_controls_of_the_own_view_and_selection_are_allowed(viewer, site):
    allowed = site._gate._for_viewers

    def labels():
        return {
            props['label']
            for number, (_, props) in viewer.controls.items()
            if number in allowed and props['visible']
        }

    viewer.wait_until(lambda: labels() >= ALLOWED)
    assert labels() == ALLOWED
    assert {key for key, number in viewer.keys.items() if number in allowed} == ALLOWED_KEYS


def test_a_viewer_selects_for_itself(viewer, served):
    _, simulator, page = served
    viewer.click('other')
    viewer.wait_until(lambda: '/models/other/link/selected' in viewer.nodes)
    viewer.wait_until(lambda: '<b>other</b>' in viewer.tables())
    viewer.choose('Frames', True)
    viewer.wait_until(lambda: f'{BOX}/Frames' in viewer.nodes)
    viewer.press('escape')
    viewer.wait_until(lambda: '/models/other/link/selected' not in viewer.nodes)
    assert NODE not in viewer.nodes  # which would move the model
    owner = viewer.owner
    owner.wait_until(lambda: NODE in owner.nodes)
    assert f'{BOX}/Frames' not in owner.nodes
    assert f'{BOX}/selected' not in owner.nodes
    assert selection(page).model == 'other'
    assert simulator.done('state') == simulator.told
    assert viewer.notes() == []


def test_what_a_viewer_may_use_is_forgotten_when_it_leaves(viewer, site):
    wait_until(lambda: len(site.get_clients()) == 2)
    before = set(site._gate._for_viewers)
    with Browser(site.viewing_address) as another:
        another.wait_until(lambda: another.control('Find'))
        assert len(site._gate._for_viewers) > len(before)
        assert len(site._gate._receivers) == 3
    wait_until(lambda: set(site._gate._for_viewers) == before and len(site._gate._receivers) == 2)


def test_the_own_camera_moves_by_hand_and_by_the_buttons_of_the_view(viewer, site):
    viewer.look_at([1.0, 2.0, 3.0])
    clients = site.get_clients().values()
    viewer.wait_until(
        lambda: any(list(client.camera.look_at) == [1.0, 2.0, 3.0] for client in clients)
    )
    for act in (lambda: viewer.click('Top'), lambda: viewer.press('F')):
        viewer.messages.clear()
        act()
        viewer.wait_until(lambda: viewer.received('SetCameraPositionMessage'))
        assert viewer.notes() == []


def test_a_picture_of_the_own_view_is_given(viewer):
    made = io.BytesIO()
    Image.new('RGB', (100, 100)).save(made, 'PNG')
    viewer.click('Picture')
    viewer.wait_until(lambda: viewer.answer_render(made.getvalue()))
    viewer.wait_until(viewer.download)
    assert viewer.download()[0] == 'picture.png'
    assert viewer.notes() == []


def test_the_scene_and_its_motion_are_seen(viewer, served):
    served[1].motion(clock(1.0, 1.0, _1=Pose((4.0, 5.0, 6.0))))
    viewer.wait_until(lambda: viewer.nodes['/models/box/link'][1] == [4.0, 5.0, 6.0])


def test_the_two_addresses_have_two_tokens_two_paths_and_two_cookies(site):
    assert site.address.endswith(f'?token={SECRET}')
    assert site.viewing_address.endswith(f'?token={VIEWING}')
    control, viewing = site_passes(site)
    assert control.path != viewing.path
    assert control.cookie != viewing.cookie
    root = site.address.partition('?')[0]
    with Browser(f'{root}{viewing.path}', {'Cookie': f'{viewing.cookie}={VIEWING}'}) as browser:
        browser.wait_until(lambda: LOOKS in browser.notes())
    with Browser(f'{root}{control.path}', {'Cookie': f'{control.cookie}={SECRET}'}) as browser:
        browser.wait_until(lambda: browser.control('Pause'))
        assert browser.notes() == []


def site_passes(site):
    """Return the passes of those that have access."""
    control = Pass(SECRET, True, f'rosbots_window_{site.get_port()}')
    return control, Pass(VIEWING, False, f'rosbots_viewing_{site.get_port()}')


@pytest.mark.parametrize(
    'cookie',
    [
        'rosbots_window_PORT={viewing}',
        'rosbots_viewing_PORT={secret}',
        'may_control=True',
        'rosbots_window_PORT=; rosbots_viewing_PORT=',
    ],
)
@pytest.mark.parametrize('inside', [0, 1])
def test_no_cookie_of_one_address_opens_the_other(site, cookie, inside):
    port = site.get_port()
    given = cookie.replace('PORT', str(port)).format(viewing=VIEWING, secret=SECRET)
    root = site.address.partition('?')[0]
    with pytest.raises(InvalidStatus, match='403'):
        Browser(f'{root}{site_passes(site)[inside].path}', {'Cookie': given})


def test_the_token_for_viewing_in_any_place_gives_no_control(site):
    root = site.address.partition('?')[0]
    control, _ = site_passes(site)
    for address in (
        f'{root}{control.path}?token={VIEWING}',
        f'{root}?a=b&token={VIEWING}',
        f'{root}?token=x&token={VIEWING}&may_control=1',
    ):
        with Browser(address) as browser:
            browser.wait_until(lambda: LOOKS in browser.notes())


def test_viewers_take_no_room_of_those_who_control(site):
    browsers = []
    try:
        with pytest.raises((ConnectionClosed, InvalidHandshake)):
            for _ in range(4):
                browsers.append(Browser(site.viewing_address))
                browsers[-1].wait_until(lambda: browsers[-1].messages)
        assert len(browsers) in (3, 4)
        with Browser(site.address) as owner:
            owner.wait_until(lambda: owner.control('Pause'))
    finally:
        for browser in browsers:
            browser._connection.close()
    wait_until(lambda: not site._gate._visitors, 'the end of the connections')


@pytest.mark.parametrize('viewing', ['short', SECRET])
def test_a_token_for_viewing_that_cannot_be_is_refused(viewing):
    with pytest.raises(WindowError, match='token'):
        Site('127.0.0.1', 0, SECRET, viewing_token=viewing)


def test_without_tokens_everybody_controls():
    with serving(is_open=True) as site:
        assert site.viewing_address == ''
        Page(site, FakeSimulator())
        with Browser(site.address) as browser:
            browser.wait_until(lambda: browser.control('Pause'))
            assert browser.notes() == []
