"""From where pictures are taken: what parameters may say, and that no picture waits for them."""

import math

import pytest
import rospy

from rosbots_description.ros_api.messages.validity import RequestError
from rosbots_description.ros_api.views.overview_picture import Viewpoint, line_of_sight
from rosbots_description.sim.rendering.camera import EYE, TARGET


class FakeRegistrar:
    """Keeps what is posted."""

    def __init__(self):
        self.jobs = []

    def post(self, job):
        self.jobs.append(job)


@pytest.fixture
def parameters(monkeypatch):
    """Stand in for the ROS master's parameters."""
    values = {}
    monkeypatch.setattr(rospy, 'get_param', values.get)
    return values


def test_three_numbers_are_a_point():
    assert line_of_sight([1, 2, 3], (0.0, 0.5, 0.0)) == ((1.0, 2.0, 3.0), (0.0, 0.5, 0.0))


@pytest.mark.parametrize('value', [
    '123', 5, None, [1.0, 2.0], [1.0, 2.0, 3.0, 4.0], [1.0, 2.0, '3'], [1.0, 2.0, math.nan],
    [math.inf, 0.0, 0.0], {1: 2, 3: 4, 5: 6},
])
def test_anything_else_is_none(value):
    with pytest.raises(RequestError, match=r'eye is .* a list of three finite numbers'):
        line_of_sight(value, [0.0, 0.0, 0.0])
    with pytest.raises(RequestError, match='target is'):
        line_of_sight([0.0, 0.0, 0.0], value)


def test_an_eye_in_its_target_sees_nothing():
    with pytest.raises(RequestError, match='they must differ'):
        line_of_sight([1, 2, 3], [1.0, 2.0, 3.0])


def test_bad_parameters_leave_the_camera_where_it_was(parameters, caplog):
    viewpoint = Viewpoint()
    viewpoint.read()
    assert viewpoint.sight == (EYE, TARGET)
    parameters['~view/eye'] = [3, 0, 1]
    viewpoint.read()
    assert viewpoint.sight == ((3.0, 0.0, 1.0), TARGET)
    parameters['~view/eye'] = 'here'
    viewpoint.read()
    viewpoint.read()
    assert viewpoint.sight == ((3.0, 0.0, 1.0), TARGET)
    assert caplog.text.count("eye is 'here'") == 1


def test_without_a_master_the_camera_stays_where_it_was(monkeypatch):
    def refused(*_):
        raise ConnectionRefusedError

    monkeypatch.setattr('rospy.get_param', refused)
    viewpoint, registrar = Viewpoint(), FakeRegistrar()
    viewpoint.read_soon(registrar)
    registrar.jobs.pop()()
    assert viewpoint.sight == (EYE, TARGET)
    viewpoint.read_soon(registrar)
    assert len(registrar.jobs) == 1


def test_the_registrar_reads_and_is_asked_once_at_a_time(parameters):
    parameters['~view/target'] = [0, 0, 9]
    viewpoint, registrar = Viewpoint(), FakeRegistrar()
    viewpoint.read_soon(registrar)
    viewpoint.read_soon(registrar)
    assert viewpoint.sight == (EYE, TARGET)
    assert len(registrar.jobs) == 1
    registrar.jobs.pop()()
    assert viewpoint.sight == (EYE, (0.0, 0.0, 9.0))
    viewpoint.read_soon(registrar)
    assert len(registrar.jobs) == 1


def test_what_was_set_before_someone_looks_counts_for_the_first_picture(parameters):
    viewpoint, registrar = Viewpoint(), FakeRegistrar()
    viewpoint.read()
    viewpoint.rest()
    parameters['~view/eye'] = [3, 0, 1]
    viewpoint.read_soon(registrar)
    assert not viewpoint.ready
    registrar.jobs.pop()()
    assert viewpoint.ready
    assert viewpoint.sight == ((3.0, 0.0, 1.0), TARGET)


def test_pictures_come_also_without_a_master(monkeypatch):
    def gone(*_arguments):
        raise ConnectionRefusedError

    monkeypatch.setattr(rospy, 'get_param', gone)
    viewpoint = Viewpoint()
    viewpoint.read()
    assert viewpoint.ready
    assert viewpoint.sight == (EYE, TARGET)
