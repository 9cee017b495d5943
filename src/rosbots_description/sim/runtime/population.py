"""Populate a world from a `WorldSpec`."""

import logging

from ..core import SimError
from ..description import WorldSpec
from .world import World
from .world_file_state import apply_state

logger = logging.getLogger(__name__)

# World plugins whose function the server provides anyway.
_SERVED = ('libgazebo_ros_api_plugin.so', 'libgazebo_ros_paths_plugin.so',
           'libgazebo_ros_init.so', 'libgazebo_ros_factory.so')


def populate(world: World, spec: WorldSpec) -> None:
    """Add all models to an empty world, and set its clock.

    Lights stay in `spec` for those who serve them; plugins of the world that do more
    than the server does anyway are named as not run. A model that the world does not take is an
    error in the log, and the others stand.
    """
    world.name = spec.name
    world.set_physics(spec.physics)
    world.scene = spec.scene
    world.clock.steps = round(spec.time / spec.physics.step_size)  # before plugins read it
    for model_spec, pose in spec.models:
        try:
            world.spawn(model_spec, model_spec.name, pose)
        except SimError as error:
            logger.error(
                "model '%s': %s; this model is left out", model_spec.name, error
            )
    for state in spec.states:
        model = world.models.get(state.name)
        if model is None:
            logger.warning("the world's <state> names a model '%s' that does not exist", state.name)
        else:
            apply_state(model, state)
    for plugin in spec.plugins:
        if plugin.filename not in _SERVED:
            logger.warning(
                "world plugin '%s' (%s, line %d) is not run here", plugin.name, plugin.filename,
                plugin.element.line,
            )
