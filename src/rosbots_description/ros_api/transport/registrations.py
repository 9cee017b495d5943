"""Registers this node again after a restart of the ROS master.

A ROS node registers once; a restarted master does not know it. Gazebo has to be restarted, too.
Here the simulation and its windows continue, and existing connections are kept.
"""

import logging
import threading
from collections.abc import Callable, Iterable
from typing import Any
from xmlrpc.client import Error as XmlRpcError

import rosgraph
import rospy
from rospy.impl.registration import (
    Registration,
    get_registration_listeners,
    get_service_manager,
    get_topic_manager,
)

from .master import NO_MASTER
from .name_conflict import replacing_node
from .registrar import Registrar

logger = logging.getLogger(__name__)

PERIOD = 1.0  # between checks of the master [s, wall]
TIMEOUT = 30.0  # time for a registration before it is retried [s, wall]


def published_types() -> dict[str, str]:
    """Return the type of each topic that this node publishes, by its resolved name."""
    return _types(get_topic_manager().pubs)


def subscribed_types() -> dict[str, str]:
    """Return the type of each topic that this node subscribes to, by its resolved name."""
    return _types(get_topic_manager().subs)


def _types(topics: dict[str, Any]) -> dict[str, str]:
    """Return the types of rospy's own topics; its other threads may add some meanwhile."""
    return {name: topic.type for name, topic in tuple(topics.items())}


def watch_master(registrar: Registrar, parameters: Iterable[Callable[[], None]]) -> None:
    """Start a thread that monitors the master.

    Args:
        registrar: runs the registrations with a new master.
        parameters: functions that set our parameters again; more may be added later.
    """
    threading.Thread(
        target=_watch, args=(registrar, parameters), name='master_watch', daemon=True
    ).start()


def _watch(registrar: Registrar, parameters: Iterable[Callable[[], None]]) -> None:
    master = rosgraph.Master(rospy.get_name())
    gone, ended = False, threading.Event()
    rospy.on_shutdown(ended.set)
    while True:
        known = _is_known(master)
        if rospy.core.is_shutdown_requested():  # unregistered on purpose
            return
        if known is None and not gone:
            logger.warning('the ROS master is gone; %s goes on and waits for it', rospy.get_name())
        if known is False:
            registrar.post(lambda: _register_again(parameters))
            registrar.wait(TIMEOUT)
        gone = known is None
        if ended.wait(PERIOD):
            return


def _is_known(master: rosgraph.Master) -> bool | None:
    """Tell whether this node is registered with the master; None if there is no master."""
    try:
        master.lookupService(_first_service())
    except rosgraph.MasterError:
        return False
    except (*NO_MASTER, XmlRpcError, rosgraph.MasterException):
        return None
    return True


def _register_again(parameters: Iterable[Callable[[], None]]) -> None:
    """Register everything with a new master; rospy has no public API for this.

    To a node that has just been replaced, its master looks like a new one: nothing of it is
    registered any more. To register again would take the name back, and end both.
    """
    if replacing_node(rospy.get_name(), rospy.get_node_uri()):
        return
    listeners = get_registration_listeners()
    services = dict(get_service_manager().get_services())
    first = _first_service()
    listeners.notify_added(first, services.pop(first), Registration.SRV)
    for kind, entries in (
        (Registration.PUB, published_types().items()),
        (Registration.SUB, subscribed_types().items()),
        (Registration.SRV, services.items()),
    ):
        for name, told in entries:
            listeners.notify_added(name, told, kind)
    for write in parameters:
        write()
    logger.info('registered with a new ROS master')


def _first_service() -> str:
    """Return the service that is registered first with a master, and only by `_register_again`.

    A master that knows it has the other registrations, too, or is about to get them. Other topics
    may have been registered by a model spawned before the new master was noticed.
    """
    return str(rospy.resolve_name('~get_loggers'))  # rospy registers it before anything else
