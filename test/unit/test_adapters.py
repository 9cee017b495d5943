"""Topics of plugins: those that cannot be are left out with a sentence, and the rest works."""

from types import SimpleNamespace

import pytest
import rospy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from support.fake_drive import make

from rosbots_description.ros_api.adapters.drives import DiffDriveAdapter
from rosbots_description.ros_api.adapters.registry import Adapters


def _model(plugin):
    return SimpleNamespace(name=plugin.model.name, plugins=[plugin])


@pytest.fixture
def server():
    jobs = []
    return SimpleNamespace(registrar=SimpleNamespace(post=jobs.append), jobs=jobs)


@pytest.fixture
def adapter(server):
    made = DiffDriveAdapter(server, make())
    yield made
    made.close()


@pytest.mark.parametrize('tags', [
    {'robotNamespace': 'a b'},
    {'robotNamespace': 'a b', 'commandTopic': '/cmd_vel', 'odometryTopic': '/odom'},
    {'commandTopic': ''},
    {'odometryTopic': '~odom'},
])
def test_a_plugin_whose_topics_have_no_ros_name_has_none(server, caplog, tags):
    model, adapters = _model(make(**tags)), Adapters(server)
    caplog.clear()
    adapters.model_spawned(model)
    (record,) = caplog.records
    assert record.message.startswith("model 'robot', plugin 'drive': '/")
    assert 'is no name for a topic' in record.message
    adapters.model_deleted(model)
    assert not server.jobs


def test_a_topic_that_the_node_has_with_another_type_is_left_out(adapter, caplog):
    there = rospy.Publisher('/clock', Clock, queue_size=1)
    caplog.clear()
    assert adapter.advertise('/clock', Odometry, 1) is None
    assert 'this node has it as rosgraph_msgs/Clock' in caplog.text
    assert adapter.advertise('/clock', Clock, 1) is not None  # as two robots share /tf
    adapter.close()
    assert there.impl.data_class is Clock
    there.unregister()


def test_messages_of_another_type_never_come_as_commands(adapter, caplog):
    there = rospy.Subscriber('/commands', Clock, queue_size=1)
    caplog.clear()
    assert adapter.subscribe('/commands', Twist, pytest.fail, 1) is None
    assert 'this node has it as rosgraph_msgs/Clock' in caplog.text
    there.unregister()
