"""The plugin that gives a robot its controllers.

Tags and behaviour are those of libgazebo_ros_control.so in gazebo_ros_pkgs 2.9.2. The description
is the one that the model was spawned from, unless another one is given; upstream stops the world
until the parameter server has it.
"""

import logging
from collections.abc import Iterable, Mapping

from ..core import NANOSECONDS, Fault, PluginError, parse_number, report, reporting_to
from ..description import RobotControl
from ..plugin_registry import register
from ..plugins import ModelPlugin
from ..runtime import NEVER
from .controller import Controller
from .errors import ControllerError
from .hardware import SimulatedRobot
from .manager import ControllerManager
from .parameters import ControllerParameters

logger = logging.getLogger(__name__)

DEFAULT_SIMULATION = 'gazebo_ros_control/DefaultRobotHWSim'


@register('libgazebo_ros_control.so')
class RosControl(ModelPlugin):
    """Simulate the hardware of a robot, and run its controllers.

    The hardware is built by `configure`, at the latest in the first step after loading; whoever has
    another description to come calls `postpone` before that. `emergency_stop` may be set at any
    time: joints get no effort, and keep their positions.

    Attributes:
        robot_param: name of the parameter that holds the description, from <robotParam>.
        e_stop_topic: relative name of a topic, from <eStopTopic>; '' for none.
    """

    absent_namespace = '{}'
    missing_level = logging.DEBUG
    topic_names: Mapping[str, str] = {'stop': '<eStopTopic>'}
    _updated_ns = _written_ns = 0

    def load(self) -> None:
        """Read the tags."""
        params = self.params
        self.robot_param = params.read('robotParam', 'robot_description')
        kind = params.read('robotSimType', DEFAULT_SIMULATION)
        self.e_stop_topic = params.read('eStopTopic', '')
        if kind != DEFAULT_SIMULATION:
            raise PluginError(
                f'<robotSimType> is {kind}, a library that is not available here; '
                f'remove the tag for {DEFAULT_SIMULATION}'
            )
        self._period_ns = self._read_period()
        self.emergency_stop = False
        self._was_stopped = self._is_postponed = self._failed = False
        self._manager: ControllerManager | None = None
        logger.info('Starting gazebo_ros_control plugin in namespace: %s', self.namespace)

    def _read_period(self) -> int:
        """Return the period of controllers [ns]; 0 for every step."""
        text = self.params.text('controlPeriod')
        if text is None:
            return 0
        period, step = parse_number(text), self.world.physics.step_size
        if period is None or period < 0.0:
            raise PluginError(f"<controlPeriod> is '{text}'; it takes a period in seconds")
        if period != step:
            severity, word = (
                (logging.ERROR, 'faster') if period < step else (logging.WARNING, 'slower')
            )
            what = (
                f'Desired controller update period ({period:.9f} s) is {word} than the gazebo '
                f'simulation period ({step:.9f} s).'
            )
            report(Fault(what, severity))
        return round(period * NANOSECONDS)

    def postpone(self) -> None:
        """Wait for `configure` with a description that is still to come."""
        self._is_postponed = self._manager is None
        self._set_due()

    def configure(
        self,
        control: RobotControl | None = None,
        parameters: Mapping[str, object] | None = None,
    ) -> None:
        """Build the hardware and the controller manager; once only.

        Args:
            control: read from another description than that of the model.
            parameters: those in the robot's namespace, nested as in YAML: `joint_limits` and
                `gazebo_ros_control/pid_gains`, each by joint.
        Raises:
            PluginError: it was configured before; or a joint or interface does not exist, and the
                robot has no controllers.
        """
        if self._manager is not None:
            raise PluginError(
                f'{self._who}: the controller manager is running already; configure '
                'it before the first step, or spawn the model again'
            )
        self._is_postponed, self._failed = False, True
        described = control or self.model.spec.control
        if described is None:
            described = RobotControl()
            what = f'{self._who}: SDF has no transmissions, so that no joint is controlled'
            cure = "pass the robot's URDF to configure()"
            self.world.faults.report(what, cure=cure, **self.place)
        own = f'/{self.namespace}'.replace('//', '/').rstrip('/')
        given = ControllerParameters(parameters or {}, own)
        with reporting_to(self.world.faults.add, **self.place):
            robot = SimulatedRobot(self.model, described, given)
        self._failed = False
        self._manager = ControllerManager(self.world, robot, self.namespace, self._wake)
        self._begin_period()
        self._wake()
        logger.info('Loaded gazebo_ros_control.')

    def start_all(self, parameters: Mapping[str, object]) -> None:
        """Load and start controllers, and configure the hardware; before the first step.

        Args:
            parameters: all those in the robot's namespace, nested as in YAML. What has a `type` is
                a controller; the others are those of `configure`.
        Raises:
            ControllerError: a controller cannot be loaded or started.
            PluginError: as `configure`.
        """
        kinds = {
            name: one['type']
            for name, one in parameters.items()
            if isinstance(one, Mapping) and 'type' in one
        }
        self.configure(parameters=parameters)
        for name, kind in kinds.items():
            self.manager.load(name, str(kind), parameters[name])  # type: ignore[arg-type]
        self.manager.switch(list(kinds))

    @property
    def manager(self) -> ControllerManager:
        """Return the controller manager; configure it from the model's description if need be.

        Raises:
            ControllerError: it waits for a description, or the hardware could not be built.
        """
        if self._manager is None:
            if self._is_postponed:
                raise ControllerError(
                    f'{self._who} waits for the robot description {self.robot_param}'
                )
            if self._failed:
                raise ControllerError(f'{self._who} is not active; the log says why')
            self.configure()
            assert self._manager is not None
        return self._manager

    @property
    def is_configured(self) -> bool:
        """Whether there is a controller manager."""
        return self._manager is not None

    @property
    def controllers(self) -> Mapping[str, Controller]:
        """Return the loaded controllers by name."""
        return self.manager.controllers

    @property
    def _who(self) -> str:
        return f"model '{self.model.name}', plugin '{self.spec.name}'"

    def before_step(self) -> None:
        """Update the controllers when their period has ended, and apply their commands."""
        manager = self._manager
        if manager is None:
            self._configure_late()
            return
        clock, robot = self.world.clock, manager.robot
        now_ns, stopped = clock.now_ns, self.emergency_stop
        if now_ns - self._updated_ns >= self._period_ns:
            robot.read()
            if self._was_stopped and not stopped:
                manager.restart_running(now_ns)
            self._was_stopped = stopped
            manager.update(now_ns, (now_ns - self._updated_ns) / NANOSECONDS)
            self._updated_ns = now_ns
        robot.write((now_ns - self._written_ns) / NANOSECONDS, clock.step_ns / NANOSECONDS, stopped)
        self._written_ns = now_ns
        self._set_due()

    def _configure_late(self) -> None:
        """Configure in the first step, unless the description is still to come."""
        if not (self._is_postponed or self._failed):
            try:
                self.configure()
            except PluginError as error:
                what = f'{error}; Could not initialize robot simulation interface'
                self.world.faults.report(what, logging.CRITICAL, **self.place)
        self._set_due()

    def restart(self) -> None:
        """Continue at time zero, or after the joints were made anew."""
        if self._manager is not None:
            self._begin_period()
            self._wake()
            self._manager.time_reset(self.world.clock.now_ns)
        self._set_due()

    def reset(self) -> None:
        """Go on: time was not set back, and joints have not moved."""

    def _begin_period(self) -> None:
        self._updated_ns = self._written_ns = self.world.clock.now_ns

    def _wake(self) -> None:
        """Read the joints, and run in the next step."""
        assert self._manager is not None
        self._manager.robot.read()
        if self.due == NEVER:
            self._begin_period()
        self.due = self.world.clock.steps + 1

    def _set_due(self) -> None:
        """Sleep while no controller runs and no joint is commanded."""
        manager = self._manager
        sleeps = (
            self._is_postponed or self._failed
            if manager is None
            else not manager.is_running and manager.robot.is_idle
        )
        self.due = NEVER if sleeps else self.world.clock.steps + 1

    def count_readers(self) -> None:
        """Determine which outputs of controllers have readers."""
        for controller in self._loaded():
            controller.count_readers()

    def _loaded(self) -> Iterable[Controller]:
        return self._manager.controllers.values() if self._manager is not None else ()

    def shared(self) -> Iterable[object]:
        """Return description, tags, and outputs of the manager and of controllers."""
        yield from super().shared()
        if self._manager is not None:
            yield self._manager.changed
            for controller in self._loaded():
                yield from controller.shared()

    def components(self) -> Iterable[object]:
        """Return the hardware, the manager and the controllers."""
        if self._manager is not None:
            yield from self._manager.robot.parts()
            yield from self._manager.parts()

    def unload(self) -> None:
        """Unload all controllers."""
        if self._manager is not None:
            self._manager.close()
