"""Viewpoint of the overview image: its parameters, which never delay an image."""

import math
from types import SimpleNamespace
from unittest.mock import Mock

import pytest
import rospy

from rosbots_description.ros_api.messages.validity import RequestError
from rosbots_description.ros_api.views.overview_picture import Viewpoint, line_of_sight
from rosbots_description.sim.rendering.camera import EYE, TARGET


@pytest.fixture
def registrar():
    """Return a registrar that keeps its jobs, in `jobs`."""
    jobs = []
    return SimpleNamespace(post=jobs.append, jobs=jobs)


@pytest.fixture
def parameters(monkeypatch):
    """Replace the ROS master's parameters."""
    values = {}
    monkeypatch.setattr(rospy, 'get_param', values.get)
    return values


def test_three_numbers_are_a_point():
    assert line_of_sight([1, 2, 3], (0.0, 0.5, 0.0)) == ((1.0, 2.0, 3.0), (0.0, 0.5, 0.0))


@pytest.mark.parametrize(
    'value',
    [
        '123',
        5,
        None,
        [1.0, 2.0],
        [1.0, 2.0, 3.0, 4.0],
        [1.0, 2.0, '3'],
        [1.0, 2.0, math.nan],
        [math.inf, 0.0, 0.0],
        {1: 2, 3: 4, 5: 6},
    ],
)
def test_other_values_are_rejected(value):
    with pytest.raises(RequestError, match=r'eye is .* a list of three finite numbers'):
        line_of_sight(value, [0.0, 0.0, 0.0])
    with pytest.raises(RequestError, match='target is'):
        line_of_sight([0.0, 0.0, 0.0], value)


def test_eye_at_its_target_is_rejected():
    with pytest.raises(RequestError, match='they must differ'):
        line_of_sight([1, 2, 3], [1.0, 2.0, 3.0])


def test_invalid_parameters_keep_the_viewpoint(parameters, caplog):
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


def test_without_a_master_the_viewpoint_stays_and_images_are_published(monkeypatch, registrar):
    monkeypatch.setattr(rospy, 'get_param', Mock(side_effect=ConnectionRefusedError))
    viewpoint = Viewpoint()
    viewpoint.read_soon(registrar)
    registrar.jobs.pop()()
    assert viewpoint.ready
    assert viewpoint.sight == (EYE, TARGET)
    viewpoint.read_soon(registrar)
    assert len(registrar.jobs) == 1


def test_parameters_are_read_once_by_the_registrar_before_the_first_image(parameters, registrar):
    viewpoint = Viewpoint()
    viewpoint.read()
    viewpoint.rest()
    parameters |= {'~view/eye': [3, 0, 1], '~view/target': [0, 0, 9]}
    viewpoint.read_soon(registrar)
    viewpoint.read_soon(registrar)
    assert not viewpoint.ready
    assert viewpoint.sight == (EYE, TARGET)
    (job,) = registrar.jobs
    job()
    assert viewpoint.ready
    assert viewpoint.sight == ((3.0, 0.0, 1.0), (0.0, 0.0, 9.0))
    viewpoint.read_soon(registrar)
    assert len(registrar.jobs) == 2
