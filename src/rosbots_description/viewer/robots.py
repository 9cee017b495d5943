"""Velocity commands to the robots of a world."""

from ..sim import World
from ..sim.controllers import DriveController
from ..sim.plugins import Drive
from .commands import WorldCommands


class WorldRobots:
    """Robots with a drive: a plugin, or a controller of ros_control."""

    def __init__(self, world: World, commands: WorldCommands) -> None:
        self._world, self._commands = world, commands

    def drive_topics(self) -> list[str]:
        """Return the names of the drives, MODEL/PLUGIN or MODEL/CONTROLLER."""
        return list(self._drives())

    def drive(self, topic: str, forward: float, left: float) -> None:
        """Send a command: forward [m/s], and turning left [rad/s]."""

        def command() -> None:
            drive = self._drives().get(topic)
            if drive is not None:  # its model is not deleted
                drive.command(forward, left)

        self._commands.post(command)

    def _drives(self) -> dict[str, Drive | DriveController]:
        found: dict[str, Drive | DriveController] = {}
        for model in tuple(self._world.models.values()):
            for plugin in tuple(model.plugins.values()):
                if isinstance(plugin, Drive):
                    found[f'{model.name}/{plugin.spec.name}'] = plugin
                for name, one in tuple(plugin.controllers.items()):
                    if isinstance(one, DriveController):
                        found[f'{model.name}/{name}'] = one
        return found
