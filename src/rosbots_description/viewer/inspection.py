"""State and properties of the models of a world."""

from dataclasses import replace

from ..sim import Link, Model, Pose, SimError, Twist, World
from ..sim.description import Inertial
from ..sim.runtime import set_friction, set_inertial
from .commands import PATIENCE, WorldCommands


class WorldInspection:
    """Reads and changes a model, or one of its links; each raises SimError if it is refused."""

    def __init__(self, world: World, commands: WorldCommands) -> None:
        self._world, self._commands = world, commands

    def state(
        self, model: str, link: str | None, patience: float | None = None
    ) -> tuple[Pose, Twist]:
        """Return pose and velocity in the world; `patience` is for the answer [s, wall]."""
        return self._commands.call(
            lambda: self._part(model, link).state(), PATIENCE if patience is None else patience
        )

    def omissions(self, model: str) -> list[str]:
        """Return the parts that a model was spawned without; [] of a light."""
        found = self._world.models.get(model)
        return list(found.left_out) if found is not None else []

    def set_state(self, model: str, link: str | None, pose: Pose, twist: Twist) -> None:
        """Set pose and velocity in the world."""

        def change() -> None:
            part = self._part(model, link)
            if isinstance(part, Link):
                part.model.move_link(part, pose, twist)
            else:
                part.set_pose(pose)
                if not part.static:
                    part.set_twist(twist)

        self._commands.call(change)

    def set_mass(self, model: str, link: str, mass: float, gravity: bool) -> None:
        """Set a link's mass [kg], its inertia in proportion, and whether gravity acts on it."""

        def change() -> None:
            part = self._world.model(model).link(link)
            now = part.spec.inertial
            if now is None:
                raise SimError(f"link '{link}' has no <inertial>, so it has no mass to set")
            set_inertial(part, scaled(now, mass), gravity)

        self._commands.call(change)

    def set_friction(self, name: str, mu: float, mu2: float) -> None:
        """Set the friction coefficients of a collision, or of all in a model or link."""
        self._commands.call(lambda: set_friction(self._world, name, mu, mu2))

    def _part(self, model: str, link: str | None) -> Model | Link:
        found = self._world.model(model)
        return found if link is None else found.link(link)


def scaled(inertial: Inertial, mass: float) -> Inertial:
    """Return an inertial of another mass [kg], its moments in proportion."""
    factor = mass / inertial.mass if inertial.mass else 1.0
    return replace(
        inertial,
        mass=mass,
        **{
            name: factor * getattr(inertial, name)
            for name in ('ixx', 'ixy', 'ixz', 'iyy', 'iyz', 'izz')
        },
    )
