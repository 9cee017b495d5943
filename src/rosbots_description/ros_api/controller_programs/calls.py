"""Calls of a controller manager's services, which print what comes of them.

Names, arguments, texts and results are those of the module
``controller_manager.controller_manager_interface``, from which scripts import these functions. The
services are those of `controller_manager` in the node's namespace; each call waits for its service.
All raise `rospy.ROSInterruptException` if the node is shut down, and `rospy.ServiceException` if
the call itself fails.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Any

import rospy
from controller_manager_msgs import srv
from genpy import Message

from ..clients.gazebo_interface import interruptibly

RUNNING = 'running'
STRICT, BEST_EFFORT = srv.SwitchControllerRequest.STRICT, srv.SwitchControllerRequest.BEST_EFFORT
MANAGER = 'controller_manager'


def list_controller_types() -> None:
    """Print the types of controllers that can be loaded."""
    for name in call('list_controller_types', srv.ListControllerTypes).types:
        _print(name)


def list_controllers() -> None:
    """Print the loaded controllers with their hardware interfaces and states."""
    controllers = call('list_controllers', srv.ListControllers).controller
    if not controllers:
        _print('No controllers are loaded in mechanism control')
    for one in controllers:
        interfaces = dict.fromkeys(claim.hardware_interface for claim in one.claimed_resources)
        _print(f"'{one.name}' - '{'+'.join(interfaces)}' ( {one.state} )")


def load_controller(name: str) -> bool:
    """Load a controller; tell whether it worked."""
    loaded = bool(call('load_controller', srv.LoadController, name=name).ok)
    _print(f"Loaded '{name}'" if loaded else f"Error when loading '{name}'")
    return loaded


def unload_controller(name: str) -> bool:
    """Unload a controller; tell whether it worked."""
    unloaded = bool(call('unload_controller', srv.UnloadController, name=name).ok)
    _print(f"Unloaded '{name}' successfully" if unloaded else f"Error when unloading '{name}'")
    return unloaded


def start_controller(name: str) -> bool:
    """Start a controller; tell whether it worked."""
    return start_stop_controllers(start_controllers=[name])


def start_controllers(names: Sequence[str]) -> bool:
    """Start controllers, all in the same step; tell whether it worked."""
    return start_stop_controllers(start_controllers=names)


def stop_controller(name: str) -> bool:
    """Stop a controller; tell whether it worked."""
    return start_stop_controllers(stop_controllers=[name])


def stop_controllers(names: Sequence[str]) -> bool:
    """Stop controllers, all in the same step; tell whether it worked."""
    return start_stop_controllers(stop_controllers=names)


def start_stop_controllers(
    start_controllers: Sequence[str] = (), stop_controllers: Sequence[str] = ()
) -> bool:
    """Start some controllers and stop others, all in the same step; tell whether it worked."""
    starting, stopping = list(start_controllers), list(stop_controllers)
    if not switch(starting, stopping, STRICT):
        _print(f'Error when starting {starting} and stopping {stopping}')
        return False
    if starting:
        _print(f'Started {starting} successfully')
    if stopping:
        _print(f'Stopped {stopping} successfully')
    return True


def reload_libraries(force_kill: bool, restore: bool = False) -> bool:
    """Call the service by which upstream loads the code of controllers anew; ours keeps it.

    Args:
        force_kill: stop and unload all controllers first; otherwise it fails if there are any.
        restore: load and start again what was loaded and running.
    """
    _print(f'Restore: {restore}')
    before = call('list_controllers', srv.ListControllers).controller if restore else []
    answer = call(
        'reload_controller_libraries', srv.ReloadControllerLibraries, force_kill=force_kill
    )
    _print(
        'Successfully reloaded libraries'
        if answer.ok
        else 'Failed to reload libraries. Do you still have controllers loaded?'
    )
    if restore:
        for one in before:
            call('load_controller', srv.LoadController, name=one.name)
        switch([one.name for one in before if one.state == RUNNING], [], BEST_EFFORT)
        _print('Controllers restored to original state')
    return bool(answer.ok)


def switch(starting: Sequence[str], stopping: Sequence[str], strictness: int) -> bool:
    """Start and stop controllers without printing; tell whether it worked."""
    return bool(
        call(
            'switch_controller',
            srv.SwitchController,
            start_controllers=list(starting),
            stop_controllers=list(stopping),
            strictness=strictness,
        ).ok
    )


def call(service: str, service_class: type[Any], **request: object) -> Message:
    """Wait for a service of the controller manager without limit, and return its response."""
    name = f'{MANAGER}/{service}'
    interruptibly(lambda: rospy.wait_for_service(name))
    return interruptibly(lambda: rospy.ServiceProxy(name, service_class)(**request))


def _print(text: str) -> None:
    sys.stdout.write(f'{text}\n')
