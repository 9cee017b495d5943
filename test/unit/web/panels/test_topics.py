"""Topics with boxes: what is checked is read and shown, and nothing else."""

import numpy as np
import pytest
from support.window import FakeTopics, clock, model, models_with

from rosbots_description.sim.core import Pose
from rosbots_description.sim.description import ShownReading
from rosbots_description.web.panels.topics import TopicPanel

NONE = 'No sensor publishes.'
SCAN, EYE = '/scan', '/r2/eye/image'
POINTS = np.float32([[1.0, 0.0, 0.0]])


@pytest.fixture
def sensors():
    return FakeTopics({SCAN: 'sensor_msgs/LaserScan', EYE: 'sensor_msgs/Image'})


@pytest.fixture
def models():
    return models_with(
        model('r1', 1, position=(1.0, 0.0, 0.0), links=('base',)),
        model('r2', 2, position=(2.0, 0.0, 0.0), links=('base',)),
    )


@pytest.fixture
def panel(site, sensors, models):
    panel = TopicPanel(site, sensors, models, 'sensors', NONE)
    panel.open()
    panel.refresh()
    yield panel
    panel.close()


def check(browser, sensors, *topics):
    for topic in topics:
        browser.choose(topic, True)
    browser.wait_until(lambda: sensors.open_topics == set(topics))


def test_only_what_is_checked_is_read(browser, sensors):
    assert sensors.open_topics == set()
    check(browser, sensors, SCAN)
    browser.choose(SCAN, False)
    browser.wait_until(lambda: sensors.open_topics == set())


def test_nothing_is_read_while_nobody_looks(browser, sensors, panel):
    check(browser, sensors, SCAN)
    panel.close()
    assert sensors.open_topics == set()
    panel.refresh()  # it was late
    browser.choose(EYE, True)  # so was this
    browser.wait_until(lambda: EYE in panel._checked)
    assert sensors.open_topics == set()
    panel.open()
    assert sensors.open_topics == {SCAN, EYE}


def test_a_sensor_that_returns_is_read_again(browser, sensors, panel):
    check(browser, sensors, SCAN)
    topics, sensors.published = sensors.published, {}
    panel.refresh()
    assert sensors.open_topics == set()
    browser.wait_until(lambda: NONE in browser.texts())
    sensors.published = topics
    panel.refresh()
    assert sensors.open_topics == {SCAN}
    browser.wait_until(lambda: browser.control(EYE) and NONE not in browser.texts())


def test_boxes_stay_in_order_when_other_sensors_come_and_go(browser, sensors, panel):
    check(browser, sensors, SCAN)
    box = browser.control(SCAN)
    sensors.readings[SCAN] = ShownReading(words='one ray')
    browser.wait_until(lambda: 'one ray' in browser.texts())
    sensors.published = {'/imu': 'sensor_msgs/Imu', SCAN: sensors.published[SCAN]}
    panel.refresh()
    browser.wait_until(lambda: browser.control('/imu') and not browser.control(EYE))

    def place(topic):
        return browser.props(topic)['order']

    browser.wait_until(lambda: place('/imu') < place(SCAN))
    assert browser.control(SCAN) == box
    assert 'one ray' in browser.texts()
    assert sensors.open_topics == {SCAN}


def test_shapes_are_where_the_robot_is(browser, sensors, models):
    models.move(clock(_1=Pose((5.0, 0.0, 0.0))))
    check(browser, sensors, SCAN)
    sensors.readings[SCAN] = ShownReading(
        'laser', points=POINTS, words='one ray', lines=np.zeros((1, 2, 3), np.float32)
    )
    frame = '/readings/\u2215scan'
    browser.wait_until(lambda: browser.nodes[frame][1] == [5.0, 0.0, 0.5])
    browser.wait_until(lambda: {f'{frame}/points', f'{frame}/lines'} <= browser.nodes.keys())
    browser.wait_until(lambda: 'one ray' in browser.texts())
    assert set(sensors.links) == {'base', 'r1/base', 'r2/base'}
    browser.choose(SCAN, False)
    browser.wait_until(lambda: frame not in browser.nodes)


def test_newer_shapes_take_the_place_of_older_ones(browser, sensors, site):
    check(browser, sensors, SCAN)
    name = '/readings/\u2215scan/points'

    def made():
        return sum(m['name'] == name for m in browser.received('PointCloudMessage'))

    def updated():
        updates = browser.received('SceneNodeUpdateMessage')
        return sum(m['name'] == name and 'points' in m['updates'] for m in updates)

    sensors.readings[SCAN] = ShownReading('laser', points=POINTS)
    browser.wait_until(lambda: made() == 1)
    sensors.readings[SCAN] = ShownReading('laser', points=np.repeat(POINTS, 3, 0))
    browser.wait_until(lambda: updated() == 1)
    assert site.scene.get_handle_by_name(name).points.shape == (3, 3)
    sensors.readings[SCAN] = ShownReading('laser', points=POINTS, colours=np.uint8([[1, 2, 3]]))
    browser.wait_until(lambda: made() == 2)
    assert site.scene.get_handle_by_name(name).colors.tolist() == [[1, 2, 3]]


def test_of_links_of_one_name_that_of_the_topics_robot_is_meant(browser, sensors):
    check(browser, sensors, EYE)
    sensors.readings[EYE] = ShownReading('eye', points=POINTS)
    frame = '/readings/\u2215r2\u2215eye\u2215image'
    browser.wait_until(lambda: browser.nodes[frame][1] == [2.0, 0.0, 0.5])


def test_shapes_in_the_world_need_no_link(browser, sensors):
    check(browser, sensors, SCAN)
    sensors.place = None
    sensors.readings[SCAN] = ShownReading('world', points=POINTS)
    browser.wait_until(lambda: '/readings/\u2215scan/points' in browser.nodes)


def test_a_frame_that_nobody_knows_is_told_of(browser, sensors):
    check(browser, sensors, SCAN)
    sensors.place = None
    sensors.readings[SCAN] = ShownReading('moon', points=POINTS, words='one ray')
    browser.wait_until(
        lambda: browser.shows(
            "one ray\nIt is not in the scene: TF does not connect its frame 'moon' with a link."
        )
    )
    assert '/readings/\u2215scan' not in browser.nodes
    sensors.place = ('base', Pose())  # TF was only late
    browser.wait_until(lambda: '/readings/\u2215scan' in browser.nodes)
    browser.wait_until(lambda: 'one ray' in browser.texts())


def test_pictures_are_shown_below_their_box(browser, sensors):
    check(browser, sensors, EYE)
    sensors.readings[EYE] = ShownReading(picture=np.full((4, 6, 3), 10, np.uint8))
    browser.wait_until(lambda: 'GuiImageMessage' in {kind for kind, _ in browser.controls.values()})
    sensors.readings[EYE] = ShownReading(picture=np.full((4, 6, 3), 200, np.uint8))
    browser.wait_until(
        lambda: any('_data' in m['updates'] for m in browser.received('GuiUpdateMessage'))
    )


def test_what_cannot_be_shown_is_told(browser, sensors):
    check(browser, sensors, EYE)
    sensors.readings[EYE] = 'A message of it is not shown: because.'
    browser.wait_until(lambda: 'A message of it is not shown: because.' in browser.texts())
    sensors.readings[EYE] = ShownReading(words='better')  # it goes on
    browser.wait_until(lambda: 'better' in browser.texts())
