"""The plugin of ros_control on the wire: what is left out when its tags are wrong."""

from unittest.mock import Mock

from rosbots_description.ros_api.adapters.controllers.ros_control import ControlEndpoint


def test_an_emergency_stop_whose_name_ros_rejects_is_reported_and_left_out(monkeypatch, caplog):
    monkeypatch.setattr(ControlEndpoint, '_configure', lambda _: None)
    adapter = Mock(plugin=Mock(namespace='/arm', e_stop_topic='a b'), text=str)
    ControlEndpoint(adapter).open()
    assert "<eStopTopic> is 'a b', which is no name of a topic" in caplog.text
    adapter.subscribe.assert_not_called()
