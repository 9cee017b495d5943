"""Calls to the ROS master, which may be unavailable for a while."""

import contextlib
import time
from collections.abc import Callable, Iterable, Mapping
from http.client import HTTPConnection, HTTPException
from typing import TypeVar
from xml.parsers.expat import ExpatError
from xmlrpc.client import Error as XmlRpcError
from xmlrpc.client import MultiCall, ProtocolError, dumps, loads

import rosgraph
import rospy
from rosgraph.network import parse_http_host_and_port

from ...sim.core import SimError

# Errors of a call if nothing answers, or something other than a ROS master.
NO_MASTER = (OSError, HTTPException, ProtocolError, ExpatError)
_PERIOD = 0.2  # between calls to an unavailable master, as in rospy [s, wall]

_PATIENCE = 20.0  # for an answer of what listens at the address [s, wall]
_LONGEST = 10_000  # bytes of an answer that are read

Answer = TypeVar('Answer')


class AddressError(SimError, ValueError):
    """ROS_MASTER_URI is not a valid address."""


def require_address() -> None:
    """Raise `AddressError` if ROS_MASTER_URI is not a valid address."""
    address = rosgraph.get_master_uri()
    try:
        parse_http_host_and_port(address)
    except ValueError:
        raise AddressError(
            f"ROS_MASTER_URI is '{address}'; it must be the address of a ROS master, "
            'such as http://localhost:11311'
        ) from None


def is_master_running(name: str) -> bool:
    """Tell whether a master answers the node `name`, which need not be registered.

    Raises:
        AddressError: what listens at ROS_MASTER_URI is no ROS master, or does not answer.
    """
    address = rosgraph.get_master_uri()
    host, port = parse_http_host_and_port(address)
    connection = HTTPConnection(host, port, timeout=_PATIENCE)
    with contextlib.closing(connection):
        try:
            connection.connect()
        except OSError:
            return False
        try:
            connection.request(
                'POST', '/RPC2', dumps((name,), 'getUri'), {'Content-Type': 'text/xml'}
            )
            loads(connection.getresponse().read(_LONGEST).decode(errors='replace'))
        except ConnectionError:  # it is ending
            return False
        except TimeoutError:
            raise AddressError(
                f'what listens at ROS_MASTER_URI, {address}, has not answered for '
                f'{_PATIENCE:.0f} s; is it a ROS master?'
            ) from None
        except (OSError, HTTPException, XmlRpcError, ExpatError, ValueError, TypeError):
            raise AddressError(
                f'what answers at ROS_MASTER_URI, {address}, is not a ROS master; '
                'roscore starts one at http://localhost:11311'
            ) from None
    return True


def node_address(node: str, asking: str) -> str | None:
    """Return the XML-RPC address of a node; None if it is not registered or no master answers.

    Args:
        node: its global name.
        asking: global name of the caller.
    """
    try:
        return str(rosgraph.Master(asking).lookupNode(node))
    except (*NO_MASTER, rosgraph.MasterException):
        return None


def has_service(name: str) -> bool:
    """Tell whether a service is registered with the master, by its resolved name.

    Raises:
        Exception: one of `NO_MASTER`.
    """
    try:
        rosgraph.Master(rospy.get_name()).lookupService(name)
    except rosgraph.MasterException:
        return False
    return True


def retry_call(call: Callable[[], Answer]) -> Answer:
    """Return `call()`, a call to the master; retry while it is unavailable, as rospy does.

    Raises:
        rospy.ROSInterruptException: the node is shutting down.
    """
    while not rospy.is_shutdown():
        try:
            return call()
        except NO_MASTER:
            time.sleep(_PERIOD)
    raise rospy.ROSInterruptException('the node is shutting down')


def subscribers(topic: str, publishing: str) -> tuple[set[str], set[str]]:
    """Return the names of a topic's subscribers; wait while the master is unavailable.

    Args:
        publishing: another topic, whose publishers are returned as the second set.
    """
    publishers, readers, _ = retry_call(lambda: rosgraph.Master(rospy.get_name()).getSystemState())
    return _nodes(readers, topic), _nodes(publishers, publishing)


def use_simulated_time(caller: str) -> None:
    """Set /use_sim_time if it is not set and a master answers; this process need not be a node."""
    # ValueError: the address of the master is not valid.
    with contextlib.suppress(*NO_MASTER, rosgraph.MasterException, ValueError):
        master = rosgraph.Master(caller)
        if not master.hasParam('/use_sim_time'):
            master.setParam('/use_sim_time', True)


def topics_of(node: str) -> list[str]:
    """Return the topics that a node publishes or subscribes to, sorted.

    Args:
        node: its global name.

    Raises:
        Exception: one of `NO_MASTER`.
    """
    published, subscribed, _ = rosgraph.Master(rospy.get_name()).getSystemState()
    return sorted({topic for topic, nodes in published + subscribed if node in nodes})


def _nodes(topics: Iterable[tuple[str, list[str]]], wanted: str) -> set[str]:
    return {node for topic, nodes in topics if topic == wanted for node in nodes}


def write_parameters(values: Mapping[str, str | float | bool]) -> None:
    """Write private parameters of this node in a single call, which takes no longer than one.

    Raises:
        Exception: one of `NO_MASTER`; or the master's error for a value.
    """
    calls = MultiCall(rosgraph.Master(rospy.get_name()).handle)
    for name, value in values.items():
        calls.setParam(rospy.get_name(), rospy.resolve_name(f'~{name}'), value)
    results = calls()
    for number in range(len(values)):
        results[number]  # raises the error of this call, if any
