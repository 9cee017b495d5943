"""Detects name conflicts, so that a second simulator does not end the first one by accident.

The ROS master shuts a node down as soon as another one registers with its name. If that node was
killed, the master shuts down whoever has its address by then.
"""

import contextlib
import socket
from collections.abc import Sequence
from dataclasses import dataclass
from http.client import HTTPConnection
from typing import Any
from urllib.parse import urlsplit
from xmlrpc.client import Error as XmlRpcError
from xmlrpc.client import Fault, ServerProxy, Transport

import rosgraph
from rosgraph.names import get_ros_namespace, load_mappings, ns_join

from ...sim.core import SimError
from .master import NO_MASTER

TIMEOUT = 2.0  # time for a node to answer [s, wall]


class NameTakenError(SimError):
    """A running node already has this node's name."""


@dataclass(frozen=True)
class RunningNode:
    """The running node that has a name."""

    uri: str
    pid: int | None  # None: it does not answer, as a stopped process

    def __str__(self) -> str:
        """Return process and address in words."""
        which = 'a process that does not answer' if self.pid is None else f'process {self.pid}'
        return f'{which} on {urlsplit(self.uri).hostname} ({self.uri})'


def accepts_connections(uri: str) -> bool:
    """Tell whether something listens at the address of a node."""
    where = urlsplit(uri)
    try:
        socket.create_connection((where.hostname, where.port), TIMEOUT).close()
    except OSError:
        return False
    return True


def node_name(name: str, arguments: Sequence[str]) -> str:
    """Return the global name of a node with these ROS arguments, such as `__name:=gazebo`."""
    own = load_mappings(arguments).get('__name', name).strip('/')
    return str(ns_join(get_ros_namespace(argv=arguments), own))


def running_node(name: str) -> RunningNode | None:
    """Return the running node of that name; None if there is none, or a stale entry.

    Raises:
        Exception: one of `NO_MASTER`.
    """
    try:
        uri = rosgraph.Master(name).lookupNode(name)
    except rosgraph.MasterException:
        return None
    if not accepts_connections(uri):
        return None  # stale entry of a killed node
    try:
        node: Any = ServerProxy(uri, transport=_TimeoutTransport())
        with contextlib.suppress(Fault):  # of nodes of other libraries than rospy
            # Of two masters on one machine the port differs, however their addresses are written.
            told = node.getName(name)[2], _port(node.getMasterUri(name)[2])
            if told != (name, _port(rosgraph.get_master_uri())):
                return None  # another node has its port now
        return RunningNode(uri, node.getPid(name)[2])
    except TimeoutError:
        return RunningNode(uri, None)
    except (*NO_MASTER, XmlRpcError, TypeError, ValueError, LookupError):  # no node answers so
        return None


def _port(uri: object) -> int | None:
    return urlsplit(str(uri)).port


def free_name(name: str) -> None:
    """Free a name that a killed node has left registered with the master.

    Else the master would shut down whoever has that address when the name is registered again.

    Raises:
        NameTakenError: a running node has that name.
        Exception: one of `NO_MASTER`.
    """
    if other := running_node(name):
        raise NameTakenError(
            f'a simulator is already running on this ROS master: the node {name}, {other}. Stop it '
            'first, or replace it with the option --replace (extra_gazebo_args:=--replace)'
        )
    with contextlib.suppress(rosgraph.MasterException):  # the master has forgotten it already
        _unregister(name)


def _unregister(name: str) -> None:
    """Remove from the master what a node has registered there.

    Raises:
        MasterException: the master does not know the node, or no longer.
    """
    master = rosgraph.Master(name)
    uri = master.lookupNode(name)
    published, subscribed, services = (
        [what for what, nodes in registered if name in nodes]
        for registered in master.getSystemState()
    )
    for topic in published:
        master.unregisterPublisher(topic, uri)
    for topic in subscribed:
        master.unregisterSubscriber(topic, uri)
    for service in services:
        master.unregisterService(service, master.lookupService(service))


def replacing_node(name: str, uri: str) -> RunningNode | None:
    """Return the running node that has taken the name of the node at `uri`, or None."""
    try:
        other = running_node(name)
    except NO_MASTER:
        return None
    return other if other and other.uri != uri else None


class _TimeoutTransport(Transport):
    """A transport with the timeout `TIMEOUT`."""

    def make_connection(self, host: tuple[str, dict[str, str]] | str) -> HTTPConnection:
        connection = super().make_connection(host)
        connection.timeout = TIMEOUT
        return connection
