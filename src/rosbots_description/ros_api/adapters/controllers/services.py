"""The services of a controller manager.

Services:
    <ns>/controller_manager/list_controller_types, list_controllers, load_controller,
        unload_controller, switch_controller, reload_controller_libraries (controller_manager_msgs)
Parameters:
    <ns>/<controller>/...: read when the controller is loaded

A failure is logged in upstream's words, and answered by ok: false. Upstream answers when the next
update is done; here services are answered while the world is paused, too.
"""

import logging
import threading
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

import rospy
from controller_manager_msgs import srv
from controller_manager_msgs.msg import ControllerState, HardwareInterfaceResources

from ....sim.controllers import ControllerError, ControllerManager, RosControl
from ....sim.core import SimError
from ...server import Server
from ...transport import is_valid_name, read_parameter, topic_name

logger = logging.getLogger(__name__)

STRICT, BEST_EFFORT = srv.SwitchControllerRequest.STRICT, srv.SwitchControllerRequest.BEST_EFFORT
BASE = 'controller_interface::ControllerBase'

Result = TypeVar('Result')
Handler = Callable[[Any], object]  # of requests of one service


class ManagerServices:
    """The services of one robot, answered one at a time, as upstream."""

    def __init__(self, server: Server, plugin: RosControl) -> None:
        """Offer them.

        Raises:
            rospy.ServiceException: this node offers services of these names.
        """
        self._server, self._plugin = server, plugin
        self._namespace = plugin.namespace
        self._one_at_a_time = threading.Lock()
        self._services: list[rospy.Service] = []
        handlers: dict[str, tuple[type, Handler]] = {
            'list_controllers': (srv.ListControllers, self._list),
            'list_controller_types': (srv.ListControllerTypes, self._types),
            'load_controller': (srv.LoadController, self._load),
            'unload_controller': (srv.UnloadController, self._unload),
            'switch_controller': (srv.SwitchController, self._switch),
            'reload_controller_libraries': (srv.ReloadControllerLibraries, self._reload),
        }
        try:
            for name, (kind, handler) in handlers.items():
                path = topic_name(self._namespace, f'controller_manager/{name}')
                self._services.append(rospy.Service(path, kind, self._guarded(handler)))
        except rospy.ServiceException:
            self.close()
            raise

    def close(self) -> None:
        """Unregister the services."""
        for service in self._services:
            service.shutdown()

    def _guarded(self, handler: Handler) -> Handler:
        def handle(request: object) -> object:
            with self._one_at_a_time:
                try:
                    return handler(request)
                except SimError as error:  # the simulator ends, or the robot has been deleted
                    raise rospy.ServiceException(str(error)) from None

        return handle

    def _call(self, command: Callable[[ControllerManager], Result]) -> Result:
        """Return `command(manager)`, called on the world's thread."""
        return self._server.loop.call(lambda: command(self._plugin.manager))

    def _try(self, command: Callable[[ControllerManager], object]) -> bool:
        """Call `command(manager)`; log why it cannot be done, and tell whether it was.

        Topics are registered when this returns.
        """
        try:
            self._call(command)
        except ControllerError as error:
            for sentence in error.sentences:
                logger.error('%s', sentence)
            return False
        self._server.registrar.await_registration('controller_manager')
        return True

    def _list(self, _request: srv.ListControllersRequest) -> srv.ListControllersResponse:
        return srv.ListControllersResponse(
            [
                ControllerState(
                    one.name,
                    one.state,
                    one.type,
                    [
                        HardwareInterfaceResources(interface, list(joints))
                        for interface, joints in one.claimed
                    ],
                )
                for one in self._call(lambda manager: manager.list())
            ]
        )

    def _types(self, _request: srv.ListControllerTypesRequest) -> srv.ListControllerTypesResponse:
        types = self._call(lambda manager: manager.types())
        return srv.ListControllerTypesResponse(*map(list, zip(*types, strict=True)))

    def _load(self, request: srv.LoadControllerRequest) -> srv.LoadControllerResponse:
        name = request.name
        own = topic_name(self._namespace, name)
        if not is_valid_name(own):
            logger.error(
                'Exception thrown while constructing nodehandle for controller with name '
                "'%s':\n%s is not a valid name",
                name,
                own,
            )
            return srv.LoadControllerResponse(False)
        found = read_parameter(own, {})
        parameters = found if isinstance(found, Mapping) else {}
        kind = parameters.get('type')
        type_name = kind if isinstance(kind, str) else ''
        return srv.LoadControllerResponse(
            self._try(lambda manager: manager.load(name, type_name, parameters))
        )

    def _unload(self, request: srv.UnloadControllerRequest) -> srv.UnloadControllerResponse:
        return srv.UnloadControllerResponse(self._try(lambda manager: manager.unload(request.name)))

    def _switch(self, request: srv.SwitchControllerRequest) -> srv.SwitchControllerResponse:
        strictness = request.strictness
        if strictness == 0:
            logger.warning(
                'Controller Manager: To switch controllers you need to specify a strictness level '
                'of controller_manager_msgs::SwitchController::STRICT (%d) or ::BEST_EFFORT (%d). '
                'Defaulting to ::BEST_EFFORT.',
                STRICT,
                BEST_EFFORT,
            )
        return srv.SwitchControllerResponse(
            self._try(
                lambda manager: manager.switch(
                    request.start_controllers, request.stop_controllers, strictness == STRICT
                )
            )
        )

    def _reload(
        self, request: srv.ReloadControllerLibrariesRequest
    ) -> srv.ReloadControllerLibrariesResponse:
        """Unload all controllers if asked to; the code of controllers itself stays as it is."""
        names = [one.name for one in self._call(lambda manager: manager.list())]
        if names and not request.force_kill:
            logger.error(
                'Controller manager: Cannot reload controller libraries because there '
                'are still %d controllers running',
                len(names),
            )
            return srv.ReloadControllerLibrariesResponse(False)

        def kill(manager: ControllerManager) -> None:
            manager.switch([], names, strict=False)
            for name in names:
                manager.unload(name)

        if names:
            logger.info('Controller manager: Killing all running controllers')
        done = not names or self._try(kill)
        if done:
            logger.info("Controller manager: reloaded controller libraries for '%s'", BASE)
        return srv.ReloadControllerLibrariesResponse(done)
