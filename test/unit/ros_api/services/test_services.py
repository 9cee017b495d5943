"""The table of services, and their responses to exceptions; every plugin has its adapter."""

from types import SimpleNamespace

import pytest
from gazebo_msgs.srv import DeleteModel, DeleteModelResponse
from std_srvs.srv import Empty

from rosbots_description.ros_api import adapters, services  # noqa: F401  both register
from rosbots_description.ros_api.adapters.registry import topics_of
from rosbots_description.ros_api.services.models import relative_state
from rosbots_description.ros_api.services.registry import (
    SERVICES,
    CallError,
    Service,
    respond,
    service,
)
from rosbots_description.ros_api.services.spawning import DEEP, warn_overlap
from rosbots_description.sim import plugins  # noqa: F401  registers
from rosbots_description.sim.core.errors import ModelError
from rosbots_description.sim.core.transforms import Pose, Twist, from_rpy
from rosbots_description.sim.plugin_registry.registry import (
    known_filenames,
    plugin_class,
    sensor_plugin_class,
)

CALLS = dict.fromkeys(('call', 'run_in_thread'), lambda command: command())
SERVER, ENDING = (
    SimpleNamespace(loop=SimpleNamespace(**CALLS, stopping=stopping)) for stopping in (False, True)
)
DONE = DeleteModelResponse(True, 'done')


def _echo(_server, value):
    return DeleteModelResponse(True, value)


def _fail(_server, _request):
    raise ModelError('link a is missing')


def _refuse(_server, _request):
    raise CallError('not like this')


def test_service_answers_from_the_prepared_value():
    entry = Service('s', DeleteModel, _echo, lambda _server, request: request.upper())
    assert respond(SERVER, entry, 'text').status_message == 'TEXT'


def test_response_of_the_preparation_is_final():
    entry = Service('s', DeleteModel, _fail, lambda *_: DONE)
    assert respond(SERVER, entry, 'text') is DONE


@pytest.mark.parametrize(('answer', 'prepare'), [(_fail, None), (lambda *_: DONE, _fail)])
def test_exception_becomes_a_failure_with_its_message(answer, prepare):
    response = respond(SERVER, Service('s', DeleteModel, answer, prepare), None)
    assert not response.success
    assert response.status_message == 'DeleteModel: Failure - link a is missing'


@pytest.mark.parametrize(('server', 'level'), [(SERVER, 'ERROR'), (ENDING, 'INFO')])
def test_refusal_is_an_error_but_at_the_end_of_the_simulator(server, level, caplog):
    caplog.set_level('INFO')
    respond(server, Service('s', DeleteModel, _fail), None)
    assert [record.levelname for record in caplog.records] == [level]


def test_exception_in_a_service_without_success_field_fails_the_call():
    with pytest.raises(CallError, match=r'^reset_world: Failure - link a is missing'):
        respond(SERVER, Service('reset_world', Empty, _fail), None)


def test_service_off_the_loop_runs_on_the_callers_thread():
    busy = SimpleNamespace(loop=SimpleNamespace(call=_fail))
    entry = Service('s', DeleteModel, _echo, on_loop=False)
    assert respond(busy, entry, 'text').status_message == 'text'


@pytest.mark.parametrize('registers', [True, False])
def test_response_waits_for_the_registration_of_topics(registers):
    waited = []
    registrar = SimpleNamespace(await_registration=waited.append)
    server = SimpleNamespace(loop=SERVER.loop, registrar=registrar)
    entry = Service('s', DeleteModel, lambda *_: DONE, registers=registers)
    assert respond(server, entry, None) is DONE
    assert waited == ['s'] * registers


def test_call_error_fails_the_call():
    with pytest.raises(CallError, match='not like this'):
        respond(SERVER, Service('s', DeleteModel, _refuse), None)


def test_each_service_has_one_function():
    name = next(iter(SERVICES))
    with pytest.raises(ValueError, match=name):
        service(name, Empty)(lambda *_: None)


@pytest.mark.parametrize('filename', known_filenames())
def test_every_plugin_has_its_topics(filename):
    assert topics_of(plugin_class(filename) or sensor_plugin_class(filename))


def test_relative_velocity_is_rotated_and_ignores_the_frames_rotation_rate():
    frame = Pose((1.0, 0.0, 0.0), from_rpy(0.0, 0.0, 1.5707963267948966))
    pose, twist = relative_state(
        (Pose((1.0, 2.0, 0.0)), Twist((0.0, 1.0, 0.0), (0.0, 0.0, 2.0))),
        (frame, Twist((0.0, 0.25, 0.0), (0.0, 0.0, 0.5))),
    )
    assert pose.position == pytest.approx((2.0, 0.0, 0.0))
    assert twist.linear == pytest.approx((0.75, 0.0, 0.0))
    assert twist.angular == pytest.approx((0.0, 0.0, 1.5))


@pytest.mark.parametrize(
    ('depths', 'named'),
    [
        ({}, None),
        ({'ground_plane': DEEP}, None),  # heights are rounded
        (
            {'ground_plane': 0.2, 'box': 0.034, 'wall': 0.001},
            "inside 'ground_plane' (0.2 m deep) and 'box' (0.034 m deep), which",
        ),
    ],
)
def test_spawn_with_overlap_is_one_line(caplog, depths, named):
    warn_overlap(SimpleNamespace(overlaps=lambda _: depths), SimpleNamespace(name='robot'))
    assert len(caplog.records) == (named is not None)
    if named:
        assert named in caplog.text
        assert "model 'robot' was spawned" in caplog.text
