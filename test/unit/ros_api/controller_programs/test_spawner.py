"""The spawner of controllers waits for a topic, and leaves nothing behind."""

from types import SimpleNamespace
from unittest.mock import Mock

from std_msgs.msg import Bool

from rosbots_description.ros_api.controller_programs import spawner


def test_the_topic_that_is_waited_for_is_unsubscribed_once_it_says_true(monkeypatch):
    unregister = Mock()

    def subscribe(_topic, _type, receive):
        receive(Bool(True))
        return SimpleNamespace(unregister=unregister)

    monkeypatch.setattr(spawner.rospy, 'Subscriber', subscribe)
    assert spawner._wait_for_topic('/ready', None)
    unregister.assert_called_once_with()
