"""Which node a message or a topic comes from."""

import rospy
from genpy import Message


def sender_of(message: Message) -> str:
    """Return the name of the node that a received message comes from."""
    return message._connection_header['callerid']


def publisher_names(subscriber: rospy.Subscriber) -> set[str]:
    """Return the names of the nodes that are connected as publishers of what is subscribed to.

    Raises:
        rospy.ROSInterruptException: the node is shutting down.
    """
    topic = subscriber.impl
    if topic is None:
        raise rospy.ROSInterruptException('the node is shutting down')
    return {connection.callerid_pub for connection in topic.connections}
