"""Programs that act by the simulator's services, and say in one sentence why they cannot."""

from __future__ import annotations

import select
import sys
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import rosgraph
import rospy
from genpy import Message

from ...sim.core import SimError, printable
from ..transport import (
    NO_MASTER,
    has_service,
    init_anonymous_node,
    is_master_running,
    require_address,
)
from .model_source import SourceError

DONE, FAILED = 0, 1  # exit codes
_STDOUT = 1  # the descriptor
LAYOUT = '\n\t'  # all that names and texts of models may do to a terminal
NODE = 'gazebo'  # the simulator, relative to this program's namespace
START = 'start one with: roslaunch gazebo_ros empty_world.launch'

Call = Callable[..., Message]  # (service, type, **request) -> response
Lines = Iterator[str]  # what a command prints


class CommandError(Exception):
    """A command cannot be done; the message says why."""


def run(program: str, act: Callable[[Call], Lines], ros_arguments: Sequence[str]) -> int:
    """Act on the running simulator, print what comes of it, and return the exit code.

    Args:
        program: its name, with which errors begin; the first word is that of its node.
        act: makes the calls, and yields lines.
        ros_arguments: ROS remappings.
    """
    node = program.split(maxsplit=1)[0]
    try:
        _connect(node, ros_arguments)
        for line in act(_call):
            sys.stdout.write(f'{printable(line, LAYOUT)}\n')
            if not _has_reader(_STDOUT):  # as of gz stats | head
                break
    except (CommandError, SourceError, SimError) as error:
        sys.stderr.write(f'{program}: {printable(str(error), LAYOUT)}\n')
        return FAILED
    except NO_MASTER:
        sys.stderr.write(f'{program}: the ROS master has ended\n')
        return FAILED
    finally:
        rospy.signal_shutdown(f'{node} ends')
    return DONE


def require_master(node: str) -> None:
    """Return if a ROS master answers the node, which need not be registered.

    Raises:
        CommandError: there is none.
        SimError: its address is not valid, or something else answers there.
    """
    require_address()
    if not is_master_running(f'/{node}'):
        raise CommandError(
            f'there is no ROS master at {rosgraph.get_master_uri()}, and so no simulator; {START}'
        )


def _has_reader(descriptor: int) -> bool:
    """Tell whether what is written there can be read: the other end of a pipe may be closed."""
    watch = select.poll()
    watch.register(descriptor, 0)
    return not watch.poll(0)


def _connect(node: str, ros_arguments: Sequence[str]) -> None:
    """Become a node, at once or not at all; the errors are those of `require_master`."""
    require_master(node)
    init_anonymous_node(node, ros_arguments)


def _call(service: str, service_type: type[Any], **request: object) -> Message:
    """Return the response of a service of the simulator.

    Raises:
        CommandError: the service is not there, or reports a failure.
    """
    name = rospy.resolve_name(f'{NODE}/{service}')
    if not has_service(name):
        raise CommandError(f'there is no simulator with the service {name}; {START}')
    try:
        response = rospy.ServiceProxy(name, service_type)(**request)
    except rospy.ServiceException as error:
        raise CommandError(f'the call of {name} failed: {error}') from None
    if not getattr(response, 'success', True):
        raise CommandError(response.status_message)
    return response
