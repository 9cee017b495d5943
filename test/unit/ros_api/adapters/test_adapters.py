"""Topics of plugins: invalid ones are left out with an error message, the others work."""

from types import SimpleNamespace

import pytest
import rospy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Range
from std_msgs.msg import Float64
from support.fake_drive import fake_model, make, make_drive, run
from support.wire import Wire, transforms

from rosbots_description.ros_api.adapters import adapter as adapter_module
from rosbots_description.ros_api.adapters import registry
from rosbots_description.ros_api.adapters.adapter import Adapter
from rosbots_description.ros_api.adapters.declarations import Offers, Publishes
from rosbots_description.ros_api.adapters.registry import Adapters, topics_of
from rosbots_description.ros_api.server.static_frames import StaticFrames
from rosbots_description.sim.core import IDENTITY
from rosbots_description.sim.plugins.base import PeriodicPlugin
from rosbots_description.sim.plugins.drive.diff_drive import DiffDrive


def _model(plugin):
    return SimpleNamespace(name=plugin.model.name, plugins={plugin.name: plugin})


@pytest.fixture
def server():
    jobs = []
    return SimpleNamespace(
        registrar=SimpleNamespace(post=jobs.append), jobs=jobs, static_frames=StaticFrames()
    )


@pytest.fixture
def adapter(server):
    made = Adapter(server, make(), topics_of(DiffDrive))
    yield made
    made.close()


@pytest.mark.parametrize(
    ('tags', 'left'),
    [
        ({'robotNamespace': 'a b'}, {'/tf', '/joint_states'}),
        ({'commandTopic': ''}, {'/odom'}),
        ({'commandTopic': '/-1'}, {'/odom'}),
        ({'commandTopic': '/../../../etc/passwd'}, {'/odom'}),
        ({'odometryTopic': '~odom'}, {'/cmd_vel'}),
        ({'odometryTopic': 'o d'}, {'/cmd_vel'}),
    ],
)
def test_plugin_is_without_topics_whose_names_ros_rejects(server, caplog, tags, left):
    model, adapters = _model(make(**tags)), Adapters(server)
    caplog.clear()
    adapters.model_spawned(model)
    (record,) = caplog.records
    assert record.message.startswith(
        "model 'robot', plugin 'drive': not opened, since ROS has no such names: '/"
    )
    (made,) = adapters._adapters._open.values()
    names = {one.name for one in made.endpoints}
    assert names & left
    assert all(one in record.message for tag, one in tags.items() if tag != 'robotNamespace')
    adapters.model_deleted(model)
    assert not adapters._adapters._open


def test_topic_with_a_conflicting_type_is_left_out(adapter, caplog):
    there = rospy.Publisher('/clock', Clock, queue_size=1)
    caplog.clear()
    assert adapter.advertise('/clock', Odometry, 1) is None
    assert 'this node uses it as rosgraph_msgs/Clock' in caplog.text
    assert adapter.advertise('/clock', Clock, 1) is not None  # as two robots share /tf
    adapter.close()
    assert there.impl.data_class is Clock
    there.unregister()


def test_topic_with_a_conflicting_type_is_not_subscribed(adapter, caplog):
    there = rospy.Subscriber('/commands', Clock, queue_size=1)
    caplog.clear()
    assert adapter.subscribe('/commands', Twist, pytest.fail, 1) is None
    assert 'this node uses it as rosgraph_msgs/Clock' in caplog.text
    there.unregister()


class Sonar(PeriodicPlugin):
    """Measures 0.5 m at 100 Hz; its other output is optional."""

    def load(self):
        self.params.read('frameName', 'sonar')
        self.set_rate(100.0)
        self.range, self.raw = self.output('range'), self.output('raw', requested=False)

    def report(self):
        self.range.send(0.5)


@pytest.fixture
def sonar(monkeypatch):
    closed = []
    monkeypatch.setattr(
        registry,
        '_TOPICS',
        {
            Sonar: (
                Publishes(
                    'range',
                    Range,
                    'range',
                    convert=lambda reading: Range(range=reading),
                    frame='<frameName>',
                    queue=3,
                    latch=True,
                ),
                Publishes('raw', Float64, '<frameName>/raw', convert=Float64),
                Offers('calibrate', lambda _adapter, name: lambda: closed.append(name)),
            )
        },
    )
    wire = Wire(monkeypatch)
    monkeypatch.setattr(adapter_module, 'find_tf_prefix', lambda _: 'r1')
    plugin = make_drive(Sonar, fake_model(), robotNamespace='front')
    return plugin, wire, wire.join(plugin), closed


def test_topic_has_header_queue_and_latch_and_optional_ones_are_off(sonar):
    plugin, wire, _, _ = sonar
    assert list(wire.publishers) == ['/front/range']
    topic = wire.publishers['/front/range']
    assert topic.options == {'queue_size': 3, 'latch': True}
    topic.read()
    run(plugin, 12)
    (message,) = topic.sent
    assert message.range == 0.5
    assert message.header.frame_id == 'r1/sonar'
    assert message.header.stamp.to_nsec() == 11_000_000


def test_output_has_a_reader_while_its_topic_has_a_subscriber(sonar):
    plugin, wire, adapter, _ = sonar
    topic = wire.publishers['/front/range']
    for _ in range(2):
        assert not plugin.range.wanted
        topic.read()
        assert plugin.range.wanted
        topic.unsubscribe()
    topic.read()
    adapter.disconnect()
    assert not plugin.range.wanted
    topic.read('/another')  # too late
    assert not plugin.range.wanted


def test_closing_unregisters_all_topics(sonar):
    _, wire, adapter, closed = sonar
    assert not closed
    adapter.close()
    assert closed == ['/front/calibrate']
    assert wire.publishers['/front/range'].impl is None


def test_closed_adapter_is_not_notified_of_subscribers_of_a_shared_topic(server):
    watched = [Adapter(server, make()) for _ in range(2)]
    publishers = [one.advertise('/shared', Clock, 1) for one in watched]
    listeners = publishers[0].impl.subscriber_listeners
    assert len(listeners) == 2
    watched[0].close()
    assert publishers[1].impl.subscriber_listeners == listeners[1:]
    watched[1].close()


def test_published_transforms_move_external_static_frames(monkeypatch):
    wire = Wire(monkeypatch)
    plugin = make()
    adapter = wire.join(plugin)
    monkeypatch.setattr(adapter_module, 'find_tf_prefix', lambda _: 'must not be looked up again')
    wire.publishers['/tf'].read()
    run(plugin, 11)
    held = transforms(('root', 'base_footprint', IDENTITY))
    adapter.server.static_frames.add('/rsp', held)
    run(plugin, 10)
    edges = [edge for message in wire.publishers['/tf'].sent for edge in message.transforms]
    assert [(edge.header.frame_id, edge.child_frame_id) for edge in edges] == [
        ('odom', 'base_footprint'),
        ('odom', 'root'),
    ]
