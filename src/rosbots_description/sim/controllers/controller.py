"""The base class of controllers."""

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from ..core import NANOSECONDS, FaultPlace
from ..runtime import Output
from .errors import ControllerError
from .hardware import JointHandle, SimulatedRobot
from .parameters import ControllerParameters
from .pid import Pid

if TYPE_CHECKING:
    from ..runtime import Model, World

_LEAST_RATE = 1e-9  # [Hz]
_LONGEST = 1e9  # [s]
INITIALIZED, RUNNING, STOPPED = 'initialized', 'running', 'stopped'


class ControllerSpec(NamedTuple):
    """Name and type of a controller, and the hardware interface that its type works on."""

    name: str
    type: str
    interface: str


class Controller:
    """Commands joints while it runs: `load`, then `starting`, `update` and `stopping` in turns.

    A subclass reads `params` and finds its joints in `load`. `outputs` maps names to its outputs,
    which have `topic_names` in its namespace. `pids` are those with adjustable gains, by their path
    in the namespace.

    Attributes:
        namespace: of its topics; that of its parameters, if `in_root_namespace` is false.
        claims: the interfaces and joints that no other running controller may use.
    """

    in_root_namespace = False
    topic_names: Mapping[str, str] = {}

    def __init__(
        self,
        world: 'World',
        robot: SimulatedRobot,
        spec: ControllerSpec,
        root: str,
        parameters: Mapping[str, object],
    ) -> None:
        """Prepare for `load`; `root` is the namespace of the controller manager."""
        self.world, self.robot, self.spec = world, robot, spec
        self.name, self.type, self.interface = spec
        own = f'{root}/{self.name}'.replace('//', '/')
        self.namespace = root if self.in_root_namespace else own
        self.log_prefix = ''
        self.params = ControllerParameters(parameters, f'/{own}'.replace('//', '/'))
        self.state = INITIALIZED
        self.outputs: dict[str, Output[Any]] = {}
        self.pids: dict[str, Pid] = {}
        self.claims: tuple[tuple[str, tuple[str, ...]], ...] = ()
        self._claimed: dict[str, list[str]] = {spec.interface: []}
        self.is_read = False

    def __repr__(self) -> str:
        """Return its kind and name."""
        return f'<{type(self).__name__} {self.name}>'

    @property
    def model(self) -> 'Model':
        """Return the robot."""
        return self.robot.model

    @property
    def place(self) -> FaultPlace:
        """Return where this is, for its faults."""
        return {'model': self.model.name, 'element': f"controller '{self.name}'"}

    def load(self) -> None:
        """Read the parameters and find the joints.

        Raises:
            ControllerError: something is missing or wrong.
        """

    def starting(self, now_ns: int) -> None:
        """Prepare for the first `update`."""

    def update(self, now_ns: int, period: float) -> None:
        """Set commands; `period` [s] is the time since the last update."""

    def stopping(self, now_ns: int) -> None:
        """Handle that no update follows."""

    def time_reset(self, now_ns: int) -> None:
        """Continue after time was set back, while it runs."""

    def parts(self) -> Iterable[object]:
        """Return objects of its state that others refer to, besides itself and its PIDs."""
        return ()

    def shared(self) -> Iterable[object]:
        """Return referenced objects that are not part of its state: descriptions and outputs."""
        return (self.spec, self.params, *self.outputs.values())

    def require_running(self) -> None:
        """Reject a command while it does not run.

        Raises:
            ControllerError: it does not.
        """
        if self.state != RUNNING:
            raise ControllerError("Can't accept new commands. Controller is not running.")

    def joint(self, name: str, interface: str = '') -> JointHandle:
        """Return a joint, which it claims.

        Args:
            interface: of the joint; '' for that of the controller.
        Raises:
            ResourceError: the interface does not have it.
        """
        interface = interface or self.interface
        handle = self.robot.handle(interface, name)
        self._claimed.setdefault(interface, []).append(name)
        return handle

    def pid(self, path: str) -> Pid:
        """Return a PID with the gains at a path.

        Raises:
            ControllerError: there are none.
        """
        pid = self.pids[path] = Pid.from_parameters(self.params.section(path))
        return pid

    def listed_joints(self, path: str = 'joints') -> list[str]:
        """Return the joints that a parameter lists.

        Raises:
            ControllerError: it lists none.
        """
        names = self.params.strings(path)
        if names is None:
            raise ControllerError(
                f"Failed to getParam '{path}' (namespace: {self.params.namespace})."
            )
        if not names:
            raise ControllerError('List of joint names is empty.')
        return names

    def output(self, name: str) -> Output[Any]:
        """Return a new output."""
        made = self.outputs[name] = Output(self.count_readers)
        return made

    def count_readers(self) -> None:
        """Determine whether its outputs have readers."""
        self.is_read = any(output.wanted for output in self.outputs.values())

    def finish_loading(self) -> None:
        """Freeze what it claims."""
        self.claims = tuple(
            (interface, tuple(sorted(set(names)))) for interface, names in self._claimed.items()
        )


class RateGate:
    """Opens at a rate, whose mean is exact."""

    def __init__(self, rate: float) -> None:
        """Open at `rate` [Hz]; <= 0, or less than once in 30 years: never."""
        self._period_ns = round(NANOSECONDS / rate) if rate > _LEAST_RATE else 0
        self._last_ns: int | None = None

    def restart(self, now_ns: int, at_once: bool = False) -> None:
        """Begin a period; `at_once`: it has just ended."""
        self._last_ns = now_ns - self._period_ns - 1 if at_once else now_ns

    def start(self, now_ns: int) -> None:
        """Begin a period that has just ended, unless it was started before."""
        if self._last_ns is None:
            self.restart(now_ns, at_once=True)

    def opens(self, now_ns: int) -> bool:
        """Tell whether a period has ended before `now_ns`; if so, begin the next."""
        if not self._period_ns or self._last_ns is None:
            return False
        if now_ns - self._last_ns <= self._period_ns:
            return False
        self._last_ns += self._period_ns
        return True


def nanoseconds(seconds: float) -> int:
    """Return a duration of at most 30 years [ns]."""
    return round(max(-_LONGEST, min(seconds, _LONGEST)) * NANOSECONDS)


def require_finite(values: Sequence[float]) -> None:
    """Reject a command that is not finite.

    Raises:
        ValueError: a number is not finite.
    """
    if not all(map(math.isfinite, values)):
        raise ValueError(f'a command takes finite numbers; it got {", ".join(map(str, values))}')
