"""Populate a world from a `WorldSpec`, and describe it as one."""

import logging
from collections.abc import Iterator
from dataclasses import replace

from ..core import SimError, shortened
from ..description import WorldSpec
from .world import World
from .world_file_state import apply_state, state_of

# World plugins whose function the server provides anyway.
_SERVED = (
    'libgazebo_ros_api_plugin.so',
    'libgazebo_ros_paths_plugin.so',
    'libgazebo_ros_init.so',
    'libgazebo_ros_factory.so',
)


def populate(world: World, spec: WorldSpec) -> None:
    """Add all models and lights to an empty world, and set its clock.

    Plugins of the world that do more than the server does anyway are named as not run. A model
    that the world does not take is an error in `world.faults`, and the others stand.
    """
    world.spec = replace(spec, models=(), states=())  # the world has its own
    world.name, world.scene = spec.name, spec.scene
    world.set_physics(spec.physics)
    world.lights.update({light.name: light for light in spec.lights})
    world.clock.steps = round(spec.time / spec.physics.step_size)  # before plugins read it
    for model_spec, pose in spec.models:
        try:
            world.spawn(model_spec, model_spec.name, pose)
        except SimError as error:
            what = f"model '{model_spec.name}': {error}; this model is left out"
            world.faults.report(what, logging.ERROR, model=model_spec.name)
    for state in spec.states:
        model = world.models.get(state.name)
        if model is None:
            name = shortened(state.name)
            world.faults.report(f"the world's <state> names a model '{name}' that does not exist")
        else:
            apply_state(model, state)
    for plugin in spec.plugins:
        if plugin.filename not in _SERVED:
            name, file = shortened(plugin.name), shortened(plugin.filename)
            what = f"world plugin '{name}' ({file}, line {plugin.element.line}) is not run here"
            world.faults.report(what, element=f"plugin '{name}'", line=plugin.element.line)


def describe(world: World) -> WorldSpec:
    """Return the world as it stands, for a file from which `populate` makes the same bit for bit.

    To that end moving models are moved by rounding errors, to poses that the engine can be given.

    `faults` tells what the description has not. Plugins and sensors begin anew there: odometry,
    noise and commands are not part of it.
    """
    models = world.models.values()
    return replace(
        world.spec,  # its plugins, and the parts that nothing acts on
        name=world.name,
        models=tuple(
            (replace(model.spec, name=model.name), model.initial_pose) for model in models
        ),
        physics=world.physics,
        lights=tuple(world.lights.values()),
        scene=world.scene,
        states=tuple(map(state_of, models)),
        time=world.clock.now,
        faults=tuple(_missing(world)),
    )


def _missing(world: World) -> Iterator[str]:
    if world.spec.faults:
        yield f'{len(world.spec.faults)} parts of its own file, which were left out'
    for model in world.models.values():
        if model.spec.left_out:
            yield f"of model '{model.name}' what was left out: {', '.join(model.spec.left_out)}"
        if (model.mass_scale, model.body.friction_scales) != (1.0, {}):
            yield f"of model '{model.name}' the factors on mass and friction"
    if world.external_forces.are_pending:
        yield 'forces and efforts that act for a time'
