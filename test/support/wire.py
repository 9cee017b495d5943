"""Topics without a ROS master: adapters advertise and subscribe, tests read and write."""

import struct
from types import SimpleNamespace

from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

from rosbots_description.ros_api.adapters import adapter as adapter_module
from rosbots_description.ros_api.adapters import drives
from rosbots_description.ros_api.adapters.adapter import Adapter
from rosbots_description.ros_api.adapters.registry import topics_of
from rosbots_description.ros_api.messages import fill_transform
from rosbots_description.ros_api.server.static_frames import StaticFrames


def transforms(*edges):
    """Return a message of TF with edges: parent, child, and the child's pose in it."""
    message = TFMessage([TransformStamped(child_frame_id=child) for _, child, _ in edges])
    for made, (parent, _, pose) in zip(message.transforms, edges, strict=True):
        made.header.frame_id = parent
        fill_transform(made.transform, pose)
    return message


class Wire:
    """Replaces rospy in the adapters' modules; `publishers` and `subscribers` are by topic name."""

    def __init__(self, monkeypatch):
        self.publishers, self.subscribers = {}, {}
        for module in (adapter_module, drives):
            monkeypatch.setattr(module, 'rospy', self)
        monkeypatch.setattr(adapter_module, 'find_tf_prefix', lambda _: '')
        monkeypatch.setattr(drives, 'subscribers', lambda *_: (set(), set()))
        self.resolve_name, self.get_name = str, lambda: '/gazebo'

    def Publisher(self, name, message_class, subscriber_listener, **options):  # noqa: N802
        made = self.publishers.setdefault(name, Topic(message_class, options))
        made.impl.subscriber_listeners.append(subscriber_listener)
        return made

    def Subscriber(self, name, _message_class, callback, **_options):  # noqa: N802
        self.subscribers[name] = callback
        return SimpleNamespace(unregister=lambda: self.subscribers.pop(name))

    def join(self, plugin):
        """Return the adapter of a plugin, open and connected; its loop runs commands at once."""
        loop = SimpleNamespace(post=lambda command: command())
        server = SimpleNamespace(world=plugin.world, loop=loop, static_frames=StaticFrames())
        made = Adapter(server, plugin, topics_of(type(plugin)))
        server.static_frames.listeners.append(made.refresh)
        made.open()
        made.connect()
        return made


class Topic:
    """A topic; `sent` is a list of its messages since it has a reader."""

    def __init__(self, message_class, options):
        self.options, self.sent, self.message_class = options, [], message_class
        self.impl = SimpleNamespace(
            connections=[], subscriber_listeners=[], seq=0, message_data_sent=0
        )

    def read(self, name='/reader'):
        """Subscribe as a node."""
        self.impl.connections.append(SimpleNamespace(endpoint_id=name, write_data=self._take))
        for listener in self.impl.subscriber_listeners:
            listener.peer_subscribe('', None, None)

    def unsubscribe(self):
        """Unsubscribe all nodes."""
        self.impl.connections.clear()
        for listener in self.impl.subscriber_listeners:
            listener.peer_unsubscribe('', 0)

    def publish(self, message):
        self.sent.append(message)

    def unregister(self):
        self.impl = None

    def _take(self, data):
        (size,) = struct.unpack_from('<I', data)
        assert len(data) == size + 4
        self.sent.append(self.message_class().deserialize(data[4:]))
