"""The topics that set states of models and links, as the services of the same names.

Subscribes:
    ~set_link_state (gazebo_msgs/LinkState): see the service ~set_link_state.
    ~set_model_state (gazebo_msgs/ModelState): see the service ~set_model_state.
Errors are only logged.
"""

from functools import partial

import rospy
from gazebo_msgs.msg import LinkState, ModelState
from gazebo_msgs.srv import SetLinkStateRequest, SetModelStateRequest
from genpy import Message

from ..server import Server
from ..services import SERVICES, respond

QUEUE = 10  # messages that may wait, as upstream


def subscribe_states(server: Server) -> None:
    """Subscribe to both topics."""
    for name, message, request in (
        ('set_link_state', LinkState, SetLinkStateRequest),
        ('set_model_state', ModelState, SetModelStateRequest),
    ):
        carry_out = partial(_carry_out, server, name, request)
        rospy.Subscriber(f'~{name}', message, carry_out, queue_size=QUEUE)


def _carry_out(server: Server, name: str, request: type, message: Message) -> None:
    respond(server, SERVICES[name], request(message))
