"""How the example nodes end when something is missing."""

import pytest
import rospy
from support.refusals import exit_code

from rosbots_description.ros_api.clients import node_program
from rosbots_description.ros_api.clients.node_program import run_node


def failing(error):
    """Return a function that raises an error."""

    def main():
        raise error

    return main


@pytest.fixture
def master(monkeypatch):
    """Let it seem that a master answers, and that the node runs."""
    monkeypatch.setattr(node_program, 'require_master', lambda _name: None)
    monkeypatch.setattr(node_program, 'is_running', lambda: True)
    monkeypatch.setattr('sys.argv', ['/somewhere/wander.py'])


@pytest.mark.parametrize(
    ('error', 'sentence'),
    [
        (rospy.ServiceException('no response'), 'wander: no response'),
        (ConnectionRefusedError(), 'wander: the ROS master has ended'),
    ],
)
def test_an_error_ends_with_one_sentence(master, error, sentence):
    assert exit_code(run_node, failing(error)) == sentence


@pytest.mark.parametrize('error', [rospy.ROSInterruptException(), KeyboardInterrupt()])
def test_ctrl_c_ends_silently(master, error):
    run_node(failing(error))


def test_a_call_that_the_end_of_the_node_interrupts_is_no_error(master, monkeypatch):
    monkeypatch.setattr(node_program, 'is_running', lambda: False)
    run_node(failing(rospy.ServiceException('interrupted')))


def test_a_wrong_address_is_named_before_anything_is_started(monkeypatch):
    monkeypatch.setenv('ROS_MASTER_URI', 'nonsense')
    with pytest.raises(SystemExit, match="ROS_MASTER_URI is 'nonsense'"):
        run_node(failing(AssertionError()))
