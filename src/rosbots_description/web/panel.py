"""What every panel of the page is told of."""

from ..sim.description import SceneChange, ShownMotion


class Panel:
    """A part of the page that shows or controls something; it overrides what it needs."""

    def open(self) -> None:
        """Begin: somebody looks at the page."""

    def close(self) -> None:
        """End what costs the simulator anything: nobody looks any more."""

    def apply(self, change: SceneChange) -> None:
        """Take in a change of the scene."""

    def move(self, motion: ShownMotion) -> None:
        """Take in the clock and new poses, up to 30 times a second."""

    def refresh(self) -> None:
        """Look again at what nobody tells of; about twice a second."""
