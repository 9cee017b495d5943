"""The executable spawner: loads and starts controllers, and takes them down when it ends.

Texts, order of the calls and exit codes are those of controller_manager's spawner, on whose log
people's launch files and eyes rely.

Services (called):
    <namespace>/controller_manager/{load,switch,unload}_controller
Subscribes:
    the topic of --wait-for (std_msgs/Bool)
"""

from __future__ import annotations

import argparse
import os
import threading
import time
from collections.abc import Sequence
from typing import Any

import rosparam
import rospy
import yaml
from controller_manager_msgs.srv import (
    LoadController,
    SwitchController,
    SwitchControllerRequest,
    UnloadController,
)
from genpy import Message
from std_msgs.msg import Bool

from ..clients.gazebo_interface import interruptibly
from ..transport import is_running, start_node

DONE, FAILED = 0, 1  # exit codes

_POLL = 0.01  # [s] wall time between two looks at the topic of --wait-for
_HINT = 1.0  # [s] wall time before a failure is reported, for the manager's own error to come first
_LAST_LOAD = 5.0  # [s] wall time to let a call that loads a controller finish at the end


def run(options: argparse.Namespace, arguments: Sequence[str]) -> int:
    """Bring the controllers up, wait, and take them down again.

    Args:
        options: those of the command line, see `cli.controller_manager.spawner_parser`.
        arguments: the whole command line, for ROS remappings.

    Returns:
        Exit code: 0; 1 if a file of parameters cannot be read or the manager ends meanwhile.
    """
    start_node('spawner', arguments, anonymous=True)
    if options.shutdown_timeout is not None:
        rospy.logwarn('DEPRECATION warning: --shutdown-timeout has no effect.')
    timeout = None if options.no_timeout or options.timeout <= 0.0 else options.timeout
    spawner = Spawner(options.namespace or '')
    if not spawner.wait_for_manager(timeout):
        return DONE
    if options.wait_for and not _wait_for_topic(options.wait_for, timeout):
        return DONE
    rospy.on_shutdown(spawner.take_down)
    try:
        spawner.bring_up(_controllers(options.controllers), start=not options.stopped)
    except rospy.ROSInterruptException:
        pass
    except (OSError, yaml.YAMLError, rosparam.RosParamException, rospy.ServiceException) as error:
        if is_running():
            rospy.logerr('Controller Spawner: %s', error)
            rospy.signal_shutdown('failed')
            return FAILED
    rospy.spin()
    return DONE


class Spawner:
    """Controllers of one manager, from loading to unloading."""

    def __init__(self, namespace: str) -> None:
        self._manager = f'{namespace.rstrip("/")}/' if namespace else ''
        self._manager += 'controller_manager/'
        self._loaded: list[str] = []
        self._ending = False
        self._loading = threading.Lock()

    def wait_for_manager(self, timeout: float | None) -> bool:
        """Wait until all services are there; log why not, and return False.

        Args:
            timeout: longest time for each service [s, wall]; None: no limit. While the simulated
                time has not begun, the wait begins again.
        """
        while True:
            try:
                for service in ('load_controller', 'switch_controller', 'unload_controller'):
                    name = self._manager + service
                    rospy.loginfo(f'Controller Spawner: Waiting for service {name}')
                    rospy.wait_for_service(name, timeout=timeout)
                return True
            except rospy.ROSException:
                if is_running() and rospy.get_param('/use_sim_time', False) and _is_before_time():
                    rospy.loginfo('Waiting for /clock to be available...')
                    continue
            rospy.logwarn(
                "Controller Spawner couldn't find the expected controller_manager ROS interface."
            )
            return False

    def bring_up(self, names: Sequence[str], start: bool) -> None:
        """Load controllers, and start those that could be loaded.

        Raises:
            rospy.ServiceException: a call failed.
            rospy.ROSInterruptException: the node is shutting down.
        """
        for name in names:
            self._load(name)
        rospy.loginfo(f'Controller Spawner: Loaded controllers: {", ".join(self._loaded)}')
        if not start:
            return
        if self._switch(start=self._loaded):
            rospy.loginfo(f'Started controllers: {", ".join(self._loaded)}')
        else:
            rospy.logerr(f'Failed to start controllers: {", ".join(self._loaded)}')

    def take_down(self) -> None:
        """Stop and unload the controllers, while the node is shutting down."""
        rospy.loginfo('Shutting down spawner. Stopping and unloading controllers...')
        # What is being loaded just now is unloaded, too, unless that takes too long.
        self._ending = True
        self._loading.acquire(timeout=_LAST_LOAD)
        try:
            rospy.loginfo('Stopping all controllers...')
            self._switch(stop=self._loaded)
            rospy.loginfo('Unloading all loaded controllers...')
            for name in reversed(self._loaded):
                rospy.loginfo(f'Trying to unload {name}')
                self._call('unload_controller', UnloadController, name=name)
                rospy.loginfo(f'Succeeded in unloading {name}')
        except (rospy.ServiceException, rospy.ROSException) as error:
            rospy.logwarn(f'Controller Spawner error while taking down controllers: {error}')

    def _load(self, name: str) -> None:
        with self._loading:
            if self._ending:
                raise rospy.ROSInterruptException('shut down while loading')
            rospy.loginfo(f'Loading controller: {name}')
            loaded = self._call('load_controller', LoadController, name=name).ok
            if loaded:
                self._loaded.append(name)
        if not loaded:
            time.sleep(_HINT)
            rospy.logerr(f'Failed to load {name}')

    def _switch(self, start: Sequence[str] = (), stop: Sequence[str] = ()) -> bool:
        return bool(
            self._call(
                'switch_controller',
                SwitchController,
                start_controllers=list(start),
                stop_controllers=list(stop),
                strictness=SwitchControllerRequest.STRICT,
            ).ok
        )

    def _call(self, service: str, service_class: type[Any], **request: object) -> Message:
        proxy = rospy.ServiceProxy(self._manager + service, service_class)
        return interruptibly(lambda: proxy(**request))


def _is_before_time() -> bool:
    return bool(rospy.get_rostime() == rospy.Time(0))


def _wait_for_topic(topic: str, timeout: float | None) -> bool:
    """Wait for True on a topic; return False if the node is shut down first."""
    heard: list[bool] = []
    subscriber = rospy.Subscriber(topic, Bool, lambda message: heard.append(message.data))
    patience = None if timeout is None else time.monotonic() + timeout
    while not (heard and heard[-1]):
        if not is_running():
            return False
        if patience is not None and not heard and time.monotonic() > patience:
            patience = None
            rospy.logwarn(
                f'Controller Spawner hasn\'t heard anything from its "wait for" topic ({topic})'
            )
        time.sleep(_POLL)
    subscriber.unregister()
    return True


def _controllers(arguments: Sequence[str]) -> list[str]:
    """Return the names of the controllers; one that is a file gives those in it.

    The parameters in such a file are set, below the root namespace.

    Raises:
        OSError, yaml.YAMLError, rosparam.RosParamException: the file cannot be read.
    """
    names = []
    for argument in arguments:
        if not os.path.exists(argument):
            names.append(argument)
            continue
        with open(argument, encoding='utf-8') as file:
            text = file.read()
        parameters = yaml.safe_load(text)
        if not isinstance(parameters, dict):
            raise rosparam.RosParamException(f'{argument} does not list controllers by name')
        rosparam.set_param('', text)
        names += parameters
    return names
