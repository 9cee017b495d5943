"""Nodes of client programs."""

import pytest
import rospy

from rosbots_description.ros_api.transport import is_running


@pytest.mark.parametrize('begun', [False, True])
def test_a_node_whose_topics_are_being_closed_does_not_run(monkeypatch, begun):
    monkeypatch.setattr(rospy.core, '_in_shutdown', begun)
    monkeypatch.setattr(rospy.core, '_shutdown_flag', False)  # comes true when all are closed
    assert is_running() is not begun
