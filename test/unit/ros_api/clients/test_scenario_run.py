"""What one run of a scenario asks of a simulator, and when."""

from unittest.mock import Mock

import pytest
import rospy
from support.batches import pushed_ball

from rosbots_description.batch import ScenarioError, ScenarioFile
from rosbots_description.ros_api.clients import scenario_run, scenario_services


def test_a_command_is_sent_at_its_time_and_not_at_the_next_tick(monkeypatch):
    now, sent = [5.0], []
    commands = [{'at': at, 'topic': '/push'} for at in (0.7, 0.2, 0.0)]
    file = ScenarioFile(
        pushed_ball(duration=1.0, period=0.5, commands=commands, record={}, conditions=[])
    )
    monkeypatch.setattr(rospy, 'get_time', lambda: now[0])
    monkeypatch.setattr(rospy, 'sleep', lambda seconds: now.append(now.pop() + seconds))
    parameters = file.parameters.run(0)
    run = scenario_run._Run(file, parameters, file.scenario(parameters))
    monkeypatch.setattr(run, '_send', lambda _topic, _message: sent.append(now[0] - 5.0))
    run._advance()
    assert sent == pytest.approx([0.0, 0.2, 0.7], abs=2e-3)


@pytest.mark.parametrize(
    ('raised', 'said'),
    [
        (rospy.ROSException(), 'there is no service /gazebo/pause_physics; start the simulator'),
        (rospy.ServiceException('gone'), 'the call of /gazebo/pause_physics failed: gone'),
    ],
)
def test_a_service_that_does_not_answer_is_told_in_one_sentence(monkeypatch, raised, said):
    monkeypatch.setattr(rospy, 'wait_for_service', Mock(side_effect=raised))
    with pytest.raises(ScenarioError, match=said), scenario_services.paused():
        pass


def test_an_interrupted_call_is_no_error(monkeypatch):
    monkeypatch.setattr(rospy, 'wait_for_service', Mock(side_effect=rospy.ROSInterruptException))
    with pytest.raises(KeyboardInterrupt), scenario_services.paused():
        pass
