"""Internals of rospy that transport relies on."""

import inspect
from unittest.mock import Mock

import pytest
import rospy
import rospy.core
import rospy.exceptions
import rospy.impl.init
import rospy.topics
from rospy.impl import registration, tcpros_base, tcpros_service
from rospy.impl.tcpros_pubsub import TCPROSSub
from rospy.rostime import _set_rostime

from rosbots_description.ros_api.transport import registrations

CALLED = {  # by us, or by rospy where we replace a function
    rospy.topics.QueuedConnection: 'connection queue_size',
    rospy.topics.QueuedConnection.write_data: 'self data',
    rospy.topics._TopicImpl.close: 'self',
    rospy.topics.Poller: '',
    tcpros_base.TCPServer.run: 'self',
    tcpros_base.recv_buff: 'sock b buff_size',
    tcpros_service.ServiceImpl.handle: 'self transport header',
    tcpros_service.ServiceImpl.error_handler: 'self e exc_type exc_value tb',
    tcpros_service.ServiceImpl._handle_request: 'self transport request',
    tcpros_service.ServiceImpl._write_service_error: 'self transport err_msg',
    registration.RegistrationListeners.notify_added: 'self resolved_name data_type reg_type',
    registration.get_registration_listeners: '',
    registration.get_service_manager: '',
    registration.get_topic_manager: '',
    rospy.core.add_shutdown_hook: 'h',
    rospy.core.is_initialized: '',
    rospy.core.is_shutdown_requested: '',
    _set_rostime: 't',
}


def connection():
    return tcpros_base.TCPROSTransport(TCPROSSub('/t', rospy.AnyMsg), '/t')


def server():
    server = tcpros_base.TCPServer(Mock())
    server.shutdown()
    return server


HELD = {  # what makes an object, and the attributes that we read or set
    connection: 'done socket stat_bytes stat_num_msg endpoint_id callerid_pub header close '
    'write_data',
    lambda: rospy.topics._PublisherImpl(
        '/t', rospy.AnyMsg
    ): 'connections subscriber_listeners seq message_data_sent',
    lambda: rospy.topics._SubscriberImpl('/t', rospy.AnyMsg): 'connections connection_poll',
    rospy.topics.Poller: 'add_fd remove_fd error_iter',
    server: 'server_sock is_shutdown inbound_handler',
    registration.get_registration_listeners: 'listeners',
    registration.get_service_manager: 'get_services',
    registration.get_topic_manager: 'pubs subs',
    lambda: registration.Registration: 'PUB SUB SRV',
    lambda: rospy.exceptions: 'TransportException TransportTerminated',
}


@pytest.mark.parametrize('function', CALLED, ids=lambda function: function.__qualname__)
def test_signature_of_a_called_or_replaced_function_is_unchanged(function):
    assert list(inspect.signature(function).parameters) == CALLED[function].split()


@pytest.mark.parametrize(('make', 'names'), HELD.items(), ids=HELD.values())
def test_attributes_that_we_use_exist(make, names):
    thing = make()
    assert [name for name in names.split() if not hasattr(thing, name)] == []


@pytest.mark.parametrize(
    ('function', 'name'),
    [
        (rospy.topics._PublisherImpl.add_connection, 'QueuedConnection'),
        (rospy.topics._TopicImpl.__init__, 'Poller'),
        (tcpros_base.TCPROSTransport.receive_once, 'recv_buff'),
        (rospy.impl.init.start_node, 'time'),
        (registration.RegManager.reg_added, 'is_shutdown'),
        (registration.RegManager.start, 'is_shutdown'),
    ],
)
def test_rospy_looks_up_replaced_functions_at_each_call(function, name):
    assert name in function.__globals__
    assert name in function.__code__.co_names


@pytest.mark.parametrize(
    ('function', 'name'),
    [
        (rospy.impl.init.start_node, 'sleep'),
        (tcpros_base.TCPROSTransport.receive_once, '_connection_header'),
        (registration.RegManager.__init__, 'cond'),
    ],
)
def test_names_that_we_use_exist_in_rospy(function, name):
    assert name in function.__code__.co_names


def test_a_topic_is_listed_with_its_type(monkeypatch):
    manager = type(registration.get_topic_manager())()
    monkeypatch.setattr(registrations, 'get_topic_manager', lambda: manager)
    manager.pubs['/t'] = rospy.topics._PublisherImpl('/t', rospy.AnyMsg)
    assert registrations.published_types() == {'/t': rospy.AnyMsg._type}
    assert registrations.subscribed_types() == {}
