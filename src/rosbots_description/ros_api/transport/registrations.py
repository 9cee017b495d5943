"""What this node has registered, told again to a ROS master that was started anew.

A ROS node registers once; when its master dies, the next one knows nothing of it. Gazebo has to be
started again then. Here the simulation goes on meanwhile, and who is connected stays so.
"""

import logging
import threading
from collections.abc import Callable, Iterable
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
from .registrar import Registrar

logger = logging.getLogger(__name__)

PERIOD = 1.0  # time between two looks for the master [s, wall]
PATIENCE = 30.0  # how long a registration may take before it is begun again [s, wall]


def published_types() -> dict[str, str]:
    """Return the type of each topic that this node publishes, by its resolved name."""
    return dict(get_topic_manager().get_publications())


def subscribed_types() -> dict[str, str]:
    """Return the type of each topic that this node subscribes to, by its resolved name."""
    return dict(get_topic_manager().get_subscriptions())


def watch_master(registrar: Registrar, parameters: Iterable[Callable[[], None]]) -> None:
    """Look after the master from now on, on a thread of its own.

    Args:
        registrar: registers everything again with a new master.
        parameters: what sets our parameters there again; it may grow meanwhile.
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
        if rospy.core.is_shutdown_requested():  # who is shutting down has unregistered on purpose
            return
        if known is None and not gone:
            logger.warning('the ROS master is gone; the simulation goes on and waits for it')
        if known is False:
            registrar.post(lambda: _introduce(parameters))
            registrar.wait(PATIENCE)
        gone = known is None
        if ended.wait(PERIOD):
            return


def _is_known(master: rosgraph.Master) -> bool | None:
    """Tell whether we were introduced to the master; None if there is no master."""
    try:
        master.lookupService(_first_service())
    except rosgraph.MasterError:
        return False
    except (*NO_MASTER, XmlRpcError, rosgraph.MasterException):
        return None
    return True


def _introduce(parameters: Iterable[Callable[[], None]]) -> None:
    """Tell the master everything that was told to the one before; rospy has no public way."""
    listeners, topics = get_registration_listeners(), get_topic_manager()
    services = dict(get_service_manager().get_services())
    first = _first_service()
    listeners.notify_added(first, services.pop(first), Registration.SRV)
    for kind, entries in (
        (Registration.PUB, topics.get_publications()),
        (Registration.SUB, topics.get_subscriptions()),
        (Registration.SRV, services.items()),
    ):
        for name, told in entries:
            listeners.notify_added(name, told, kind)
    for write in parameters:
        write()
    logger.info('registered with a new ROS master')


def _first_service() -> str:
    """Return the name of what a master is told first when we are introduced, and only then.

    A master that knows it has been told the rest, too, or is being told. What else it may know
    was registered by a model that came before we noticed the new master.
    """
    return rospy.resolve_name('~get_loggers')  # rospy offers it before anything else
