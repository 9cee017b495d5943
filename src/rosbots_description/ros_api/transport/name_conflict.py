"""One node per name: a second simulator does not end the first one by accident.

The ROS master shuts a node down as soon as another one registers under its name.
"""

import socket
from collections.abc import Sequence
from dataclasses import dataclass
from http.client import HTTPConnection
from typing import Any
from urllib.parse import urlsplit
from xmlrpc.client import Error as XmlRpcError
from xmlrpc.client import ServerProxy, Transport

import rosgraph
from rosgraph.names import get_ros_namespace, load_mappings, ns_join

from ...sim.core import SimError
from .master import NO_MASTER

PATIENCE = 2.0  # for a node to answer [s, wall]


class NameTakenError(SimError):
    """A living node has the name that this one would get."""


@dataclass(frozen=True)
class Holder:
    """A node that is alive under a name."""

    uri: str
    pid: int | None  # None: it is there but does not answer, as a stopped process

    def __str__(self) -> str:
        """Return which process it is, and where."""
        which = 'a process that does not answer' if self.pid is None else f'process {self.pid}'
        return f'{which} on {urlsplit(self.uri).hostname} ({self.uri})'


def node_name(name: str, arguments: Sequence[str]) -> str:
    """Return the global name of a node with these ROS arguments, such as `__name:=gazebo`."""
    return ns_join(
        get_ros_namespace(argv=arguments), load_mappings(arguments).get('__name', name).strip('/'))


def holder(name: str) -> Holder | None:
    """Return the living node of that name; None where there is none, or only a dead one's entry.

    Raises:
        Exception: one of `NO_MASTER`.
    """
    try:
        uri = rosgraph.Master(name).lookupNode(name)
    except rosgraph.MasterException:
        return None
    where = urlsplit(uri)
    try:
        socket.create_connection((where.hostname, where.port), PATIENCE).close()
    except OSError:
        return None  # killed: it could not unregister
    try:
        node: Any = ServerProxy(uri, transport=_Impatient())
        return Holder(uri, node.getPid(name)[2])
    except TimeoutError:
        return Holder(uri, None)
    except (*NO_MASTER, XmlRpcError):  # its port belongs to another program by now
        return None


def require_free(name: str) -> None:
    """Raise `NameTakenError` if a living node has that name."""
    other = holder(name)
    if other:
        raise NameTakenError(
            f'a simulator is already running on this ROS master: the node {name}, {other}. Stop it '
            'first, or replace it with the option --replace (extra_gazebo_args:=--replace)'
        )


def successor(name: str, uri: str) -> Holder | None:
    """Return the living node that has taken the name from the node at `uri`; None if none has."""
    try:
        other = holder(name)
    except NO_MASTER:
        return None
    return other if other and other.uri != uri else None


class _Impatient(Transport):
    """Waits for an answer for `PATIENCE` at most."""

    def make_connection(self, host: tuple[str, dict[str, str]] | str) -> HTTPConnection:
        connection = super().make_connection(host)
        connection.timeout = PATIENCE
        return connection
