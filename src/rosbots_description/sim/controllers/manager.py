"""Loads, starts, stops, switches and unloads the controllers of a robot, as controller_manager."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

from ..core import NotFoundError, reporting_to, suggestion
from ..runtime import Output
from .controller import RUNNING, STOPPED, Controller, ControllerSpec
from .errors import ControllerError, InterfaceError, ResourceError
from .hardware import SimulatedRobot
from .registry import BASE_CLASS, find_type, type_names

if TYPE_CHECKING:
    from ..runtime import World

Controllers = list[Controller]  # `ControllerManager.list` hides the built-in name


class ControllerStatus(NamedTuple):
    """A loaded controller; `state` is initialized, running or stopped; `claimed` by interface."""

    name: str
    state: str
    type: str
    claimed: Sequence[tuple[str, Sequence[str]]]


class ControllerManager:
    """The controllers of one robot, by name in the order in which they were loaded.

    All methods run on the world's thread. `changed` is sent after each change of what is loaded or
    runs.
    """

    def __init__(
        self, world: 'World', robot: SimulatedRobot, namespace: str, wake: Callable[[], None]
    ) -> None:
        """Manage the controllers of `robot`; call `wake()` when they must be updated again."""
        self.world, self.robot, self.namespace = world, robot, namespace
        self.controllers: dict[str, Controller] = {}
        self.changed: Output[None] = Output(lambda: None)
        self._running: tuple[Controller, ...] = ()
        self._wake = wake

    def __repr__(self) -> str:
        """Return its robot, and its controllers with their states."""
        loaded = ', '.join(f'{one.name} ({one.state})' for one in self.controllers.values())
        return (
            f'<{type(self).__name__} of {self.robot.model.name} with {loaded or "no controller"}>'
        )

    @staticmethod
    def types() -> Sequence[tuple[str, str]]:
        """Return the types that can be loaded, each with its base class, sorted."""
        return [(name, BASE_CLASS) for name in type_names()]

    def controller(self, name: str) -> Controller:
        """Return a loaded controller.

        Raises:
            NotFoundError: there is none of that name.
        """
        found = self.controllers.get(name)
        if found is None:
            raise NotFoundError(
                f"no controller '{name}' is loaded{suggestion(name, self.controllers)}"
            )
        return found

    def list(self) -> Sequence[ControllerStatus]:
        """Return the state of all loaded controllers."""
        return [
            ControllerStatus(one.name, one.state, one.type, one.claims)
            for one in self.controllers.values()
        ]

    def load(self, name: str, type_name: str, parameters: Mapping[str, object]) -> None:
        """Load a controller; it does not run yet.

        Args:
            name: of the controller, and of its namespace below that of the manager.
            type_name: one of `types`; '' if it was not specified.
            parameters: those in the controller's namespace, nested as in YAML.
        Raises:
            ControllerError: the name is taken, the type does not exist, or a parameter or joint is
                missing.
        """
        if name in self.controllers:
            raise ControllerError(
                f"A controller named '{name}' was already loaded inside the controller manager"
            )
        if not type_name:
            own = f'/{self.namespace}/{name}'.replace('//', '/')
            raise ControllerError(
                f"Could not load controller '{name}' because the type was not specified. Did you "
                'load the controller configuration on the parameter server (namespace: '
                f"'{own}')?"
            )
        kind = find_type(type_name)
        if kind is None:
            raise ControllerError(
                f"Could not load controller '{name}' because controller type '{type_name}' does "
                'not exist.',
                "Use 'rosservice call controller_manager/list_controller_types' to get the "
                'available types',
            )
        spec = ControllerSpec(name, type_name, kind.interface)
        made = kind.made_by(self.world, self.robot, spec, self.namespace, parameters)
        failed = f"Initializing controller '{name}' failed"
        try:
            with reporting_to(self.world.faults.add, **made.place):
                made.load()
        except ResourceError as error:
            raise ControllerError(
                f"Exception thrown while initializing controller '{name}'.\n{error}",
                failed,
            ) from None
        except InterfaceError as error:
            raise ControllerError(*error.sentences, failed) from None
        except ControllerError as error:
            raise ControllerError(
                *error.sentences, 'Failed to initialize the controller', failed
            ) from None
        made.finish_loading()
        self.controllers[name] = made
        self.changed.send(None)

    def unload(self, name: str) -> None:
        """Unload a controller that does not run.

        Raises:
            ControllerError: it runs, or there is none of that name.
        """
        (found,) = self._find([name], 'unload', strict=True)
        if found.state == RUNNING:
            raise ControllerError(
                f"Could not unload controller with name '{name}' because it is still running"
            )
        del self.controllers[name]
        self.changed.send(None)

    def switch(self, start: Sequence[str], stop: Sequence[str] = (), strict: bool = True) -> None:
        """Stop and start controllers, all between the same two steps.

        Args:
            strict: an unknown name, or a controller that is in that state already, is an error.
        Raises:
            ControllerError: nothing was switched, for the reason that it gives.
        """
        stopping = self._find(stop, 'stop', strict)
        starting = self._find(start, 'start', strict)
        after = []
        for name, one in self.controllers.items():
            runs = one.state == RUNNING
            if one in stopping and not runs:
                if strict:
                    raise ControllerError(
                        f"Could not stop controller '{name}' since it is not running"
                    )
                stopping.remove(one)
            if one in starting and runs and one not in stopping:
                if strict:
                    raise ControllerError(f"Controller '{name}' is already running")
                starting.remove(one)
            if one in starting and one in stopping:
                raise ControllerError(
                    f"Could no start or stop controller '{name}' because of "
                    'conflicting switching command'
                )
            if one in starting or (runs and one not in stopping):
                after.append(one)
        _require_exclusive(after)
        now_ns = self.world.clock.now_ns
        self._wake()
        for one in stopping:
            _stop(one, now_ns)
        for one in starting:
            _start(one, now_ns)
        self._running = tuple(after)
        self.changed.send(None)

    def update(self, now_ns: int, period: float) -> None:
        """Update the running controllers, `period` [s] after the last time."""
        for one in self._running:
            one.update(now_ns, period)

    def restart_running(self, now_ns: int) -> None:
        """Stop and start the running controllers, after an emergency stop."""
        for one in self._running:
            _stop(one, now_ns)
            _start(one, now_ns)

    def time_reset(self, now_ns: int) -> None:
        """Continue after time was set back."""
        for one in self._running:
            one.time_reset(now_ns)

    @property
    def is_running(self) -> bool:
        """Whether any controller runs."""
        return bool(self._running)

    def parts(self) -> Iterable[object]:
        """Return the objects of its state that others refer to."""
        yield self
        for one in self.controllers.values():
            yield one
            yield from one.pids.values()
            yield from one.parts()

    def close(self) -> None:
        """Stop and unload all controllers."""
        for one in self._running:
            _stop(one, self.world.clock.now_ns)
        self._running = ()
        self.controllers.clear()
        self.changed.send(None)

    def _find(self, names: Sequence[str], what: str, strict: bool) -> Controllers:
        found: Controllers = []
        for name in dict.fromkeys(names):
            if name in self.controllers:
                found.append(self.controllers[name])
            elif strict:
                raise ControllerError(
                    f"Could not {what} controller with name '{name}' because no "
                    'controller with this name exists'
                )
        return found


def _start(controller: Controller, now_ns: int) -> None:
    controller.starting(now_ns)
    controller.state = RUNNING


def _stop(controller: Controller, now_ns: int) -> None:
    controller.stopping(now_ns)
    controller.state = STOPPED


def _require_exclusive(running: Sequence[Controller]) -> None:
    """Reject controllers that claim the same joint."""
    claims: dict[str, list[str]] = {}
    for one in running:
        for _, joints in one.claims:
            for joint in joints:
                claims.setdefault(joint, []).append(one.name)
    conflicts = {joint: names for joint, names in claims.items() if len(names) > 1}
    if conflicts:
        raise ControllerError(
            *(
                f'Resource conflict on [{joint}].  Controllers = [{", ".join(names)}, ]'
                for joint, names in sorted(conflicts.items())
            ),
            'Could not switch controllers, due to resource conflict',
        )
