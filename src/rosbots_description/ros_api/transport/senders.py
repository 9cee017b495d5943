"""Names of the nodes that publish a message or topic."""

import rospy
from genpy import Message


def sender_of(message: Message) -> str:
    """Return the name of the node that sent a received message."""
    return str(message._connection_header['callerid'])


def publisher_names(subscriber: rospy.Subscriber) -> set[str]:
    """Return the names of the publishers that a subscriber is connected to.

    Raises:
        rospy.ROSInterruptException: the node is shutting down.
    """
    topic = subscriber.impl
    if topic is None:
        raise rospy.ROSInterruptException('the node is shutting down')
    return {connection.callerid_pub for connection in topic.connections}
