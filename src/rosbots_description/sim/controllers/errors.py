"""Errors about controllers, in upstream's words."""

from ..core import SimError


class ControllerError(SimError):
    """A controller cannot be loaded, unloaded or switched.

    `sentences` are upstream's lines of log, in order; `str()` joins them.
    """

    def __init__(self, *sentences: str) -> None:
        super().__init__('; '.join(sentences))
        self.sentences = sentences


class InterfaceError(ControllerError):
    """A hardware interface that the robot does not have."""

    def __init__(self, interface: str) -> None:
        super().__init__(
            f"This controller requires a hardware interface of type '{interface}'. Make sure this "
            'is registered in the hardware_interface::RobotHW class.'
        )


class ResourceError(ControllerError):
    """A joint or sensor that the hardware interface does not have."""
