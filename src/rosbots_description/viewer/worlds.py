"""A world as a file, and what can be inserted into it."""

from ..sim import SimError, World
from ..sim.description import LightSpec, ModelSpec, ModelText
from ..sim.formats import sdf_of_include, sdf_of_light, sdf_of_model, sdf_of_world
from ..sim.resources import text_of_upload
from ..sim.runtime import describe
from .commands import WorldCommands


class WorldFiles:
    """The world as a world file."""

    def __init__(self, world: World, commands: WorldCommands) -> None:
        self._world, self._commands = world, commands

    def save(self) -> tuple[str, str]:
        """Return the world as it stands as a world file, and a sentence about it."""
        spec = self._commands.call(lambda: describe(self._world))
        missing = f'; not in it: {"; ".join(spec.faults)}' if spec.faults else ''
        return (
            sdf_of_world(spec),
            f'{len(spec.models)} models as they are at {spec.time:.3f} s{missing}',
        )


class WorldLibrary:
    """Shapes, lights, and uploaded URDF and SDF files."""

    def __init__(self, world: World) -> None:
        self._world = world

    def models(self) -> list[str]:
        """Return the names of the models along the model path."""
        return self._world.available_models()

    def parameters(self) -> list[str]:
        """Return no names: there is no parameter server."""
        return []

    def model(self, name: str) -> ModelText:
        """Return a model of the model path."""
        return ModelText(name, sdf_of_include(f'model://{name}'))

    def parameter(self, name: str) -> ModelText:
        """Refuse: there is no parameter server.

        Raises:
            SimError: always.
        """
        raise SimError(f'there is no ROS here, and no parameter {name}')

    def file(self, name: str, content: bytes) -> ModelText:
        """Return a URDF or SDF.

        Raises:
            SimError: it is xacro, too large, or not text.
        """
        if name.lower().endswith('.xacro'):
            raise SimError(
                f"'{name}' is xacro, which can run code, so it is not taken from a "
                'browser here; open it by rosbots-view, or upload its URDF'
            )
        return ModelText('', text_of_upload(name, content, 'URDF or SDF'))

    def shape(self, spec: ModelSpec) -> ModelText:
        """Return a model as SDF."""
        return ModelText(spec.name, sdf_of_model(spec))

    def light(self, spec: LightSpec) -> ModelText:
        """Return a light as SDF."""
        return ModelText(spec.name, sdf_of_light(spec))
