"""Controllers that forward commands to joints: of position, velocity or effort."""

from collections.abc import Iterable, Mapping

from .controller import Controller, require_finite
from .errors import ControllerError, ResourceError
from .hardware import EFFORT, POSITION, VELOCITY, JointHandle
from .registry import register_controller


class ForwardCommand(Controller):
    """Forward one command per joint; it starts with the joints at rest where they are."""

    topic_names: Mapping[str, str] = {'command': 'command'}
    joints: tuple[JointHandle, ...]

    def starting(self, now_ns: int) -> None:
        """Hold the position; or command no velocity, or no effort."""
        self.commands = tuple(
            one.position if self.interface == POSITION else 0.0 for one in self.joints
        )

    def update(self, now_ns: int, period: float) -> None:
        """Forward the commands."""
        for joint, command in zip(self.joints, self.commands, strict=True):
            joint.command = command


@register_controller('effort_controllers/JointEffortController', EFFORT)
@register_controller('position_controllers/JointPositionController', POSITION)
@register_controller('velocity_controllers/JointVelocityController', VELOCITY)
class JointCommandController(ForwardCommand):
    """Forward a command to one joint. Parameter: joint."""

    def load(self) -> None:
        """Find the joint."""
        self.joints = (self.joint(required_joint(self)),)

    def command(self, value: float) -> None:
        """Set the command [rad or m, rad/s or m/s, N m or N]; it holds until the next one.

        Raises:
            ValueError: it is not finite.
        """
        require_finite((value,))
        self.commands = (float(value),)


@register_controller('effort_controllers/JointGroupEffortController', EFFORT)
@register_controller('position_controllers/JointGroupPositionController', POSITION)
@register_controller('velocity_controllers/JointGroupVelocityController', VELOCITY)
class JointGroupCommandController(ForwardCommand):
    """Forward one command to each of some joints. Parameter: joints."""

    def load(self) -> None:
        """Find the joints."""
        self.joints = find_group(self)

    def command(self, values: Iterable[float]) -> None:
        """Set the commands of all joints, in the order of `joints`; see `JointCommandController`.

        Raises:
            ValueError: a number is not finite, or there is not one per joint.
        """
        self.commands = checked_group(values, len(self.joints))


def required_joint(controller: Controller) -> str:
    """Return the name of the controller's joint.

    Raises:
        ControllerError: it is not given.
    """
    name = controller.params.string('joint')
    if name is None:
        raise ControllerError(f'No joint given (namespace: {controller.params.namespace})')
    return name


def find_group(controller: Controller) -> tuple[JointHandle, ...]:
    """Return the joints of a controller of several.

    Raises:
        ControllerError: none are given, or the interface does not have one.
    """
    try:
        return tuple(controller.joint(name) for name in controller.listed_joints())
    except ResourceError as error:
        raise ControllerError(f'Exception thrown: {error}') from None


def checked_group(values: Iterable[float], count: int) -> tuple[float, ...]:
    """Return `count` commands.

    Raises:
        ValueError: there are more or fewer, or one is not finite.
    """
    numbers = tuple(map(float, values))
    if len(numbers) != count:
        raise ValueError(
            f'Dimension of command ({len(numbers)}) does not match number of joints '
            f'({count})! Not executing!'
        )
    require_finite(numbers)
    return numbers
