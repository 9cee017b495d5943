"""Connections, the master, logging and processes: all that touches rospy's internals."""

from .client_node import is_running, own_parameters, start_node
from .handshake import guard_handshakes
from .incoming import caller_waits, guard_messages, wait_for_answers
from .log_bridge import connect_logging, leave_rosout, set_level
from .master import (
    NO_MASTER,
    AddressError,
    has_service,
    is_master_there,
    node_address,
    require_address,
    subscribers,
    write_parameters,
)
from .name_conflict import holder, node_name, require_free, successor
from .names import find_tf_prefix, frame_name, is_for_all, topic_name
from .process import init_node, is_node
from .registrar import Registrar
from .registrations import published_types, subscribed_types, watch_master
from .senders import publisher_names, sender_of
from .sending import (
    Outlets,
    ReaderWatch,
    has_readers,
    next_number,
    publish_serialized,
    reader_names,
    stop_publishing,
)

__all__ = [
    'NO_MASTER', 'AddressError', 'Outlets', 'ReaderWatch', 'Registrar', 'caller_waits',
    'connect_logging', 'find_tf_prefix', 'frame_name', 'guard_handshakes', 'guard_messages',
    'has_readers', 'has_service', 'holder', 'init_node', 'is_for_all', 'is_master_there', 'is_node',
    'is_running', 'leave_rosout', 'next_number', 'node_address', 'node_name', 'own_parameters',
    'publish_serialized', 'published_types', 'publisher_names', 'reader_names', 'require_address',
    'require_free', 'sender_of', 'set_level', 'start_node', 'stop_publishing', 'subscribed_types',
    'subscribers', 'successor', 'topic_name', 'wait_for_answers', 'watch_master',
    'write_parameters',
]
