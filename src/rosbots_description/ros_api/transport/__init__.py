"""Connections, the master, logging and processes: all that touches rospy's internals."""

from .client_node import is_running, own_parameters, start_node
from .delivery import subscribed_connections, wait_for_delivery
from .handshake import guard_handshakes
from .incoming import caller_waits, guard_messages, wait_for_answers
from .log_bridge import FaultLog, connect_logging, set_level
from .master import (
    NO_MASTER,
    AddressError,
    has_service,
    is_master_running,
    node_address,
    require_address,
    subscribers,
    topics_of,
    use_simulated_time,
    write_parameters,
)
from .name_conflict import (
    accepts_connections,
    free_name,
    node_name,
    replacing_node,
    running_node,
)
from .names import (
    find_tf_prefix,
    frame_name,
    is_valid_name,
    read_parameter,
    search_parameter,
    topic_name,
)
from .process import init_anonymous_node, init_node, is_node
from .registrar import Registrar
from .registrations import published_types, subscribed_types, watch_master
from .senders import publisher_names, sender_of
from .sending import (
    BatchedPublishing,
    SubscriberWatch,
    has_subscribers,
    next_number,
    publish_serialized,
    stop_publishing,
    subscriber_names,
)

__all__ = [
    'NO_MASTER',
    'AddressError',
    'BatchedPublishing',
    'FaultLog',
    'Registrar',
    'SubscriberWatch',
    'accepts_connections',
    'caller_waits',
    'connect_logging',
    'find_tf_prefix',
    'frame_name',
    'free_name',
    'guard_handshakes',
    'guard_messages',
    'has_service',
    'has_subscribers',
    'init_anonymous_node',
    'init_node',
    'is_master_running',
    'is_node',
    'is_running',
    'is_valid_name',
    'next_number',
    'node_address',
    'node_name',
    'own_parameters',
    'publish_serialized',
    'published_types',
    'publisher_names',
    'read_parameter',
    'replacing_node',
    'require_address',
    'running_node',
    'search_parameter',
    'sender_of',
    'set_level',
    'start_node',
    'stop_publishing',
    'subscribed_connections',
    'subscribed_types',
    'subscriber_names',
    'subscribers',
    'topic_name',
    'topics_of',
    'use_simulated_time',
    'wait_for_answers',
    'wait_for_delivery',
    'watch_master',
    'write_parameters',
]
