"""Convert a world file to a `WorldSpec`."""

import logging
import os
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field, replace

from lxml import etree

from ...core import Fault, ModelError, Pose, fault, report
from ...description import Element, LightSpec, ModelSpec, ModelState, PluginSpec, WorldSpec
from ...resources import (
    MAX_XML_BYTES,
    Addresses,
    FileSearch,
    FindModel,
    FindPackage,
    MissingModel,
    not_on_model_path,
    read_file,
)
from ..xml import listed, required_name, to_element
from .document import SdfDocument, SdfLibrary
from .frames import Frames
from .lights import read_light
from .models import ModelParts, add_plugin, model_spec, read_include, read_model
from .physics import read_physics
from .scene import READ_OF_SCENE, read_scene, read_user_camera
from .state import read_states
from .values import text_of

_READ = (
    'model',
    'include',
    'light',
    'plugin',
    'scene',
    'gui',
    'physics',
    'gravity',
    'state',
    'frame',
)
# Elements with an effect on sound and other sensors only.
_IDLE = ('audio', 'atmosphere', 'magnetic_field', 'spherical_coordinates')

# End of the message about an element that is not valid.
_WITHOUT = {
    'model': 'this model is left out',
    'light': 'this light is left out',
    'frame': 'this frame is left out',
    'state': "the world's <state> is not applied",
    'gui': 'windows choose their own view',
}


@dataclass
class _Content:
    """What has been read so far of a world's elements."""

    models: dict[str, tuple[ModelSpec, Pose]] = field(default_factory=dict)
    lights: list[LightSpec] = field(default_factory=list)
    plugins: list[PluginSpec] = field(default_factory=list)
    faults: list[str] = field(default_factory=list)
    taken: Counter[str] = field(default_factory=Counter)  # name -> number of its duplicates
    missing: list[MissingModel] = field(default_factory=list)


def load_world(
    text: str | bytes,
    source: str,
    *,
    find_model: FindModel,
    find_package: FindPackage | None = None,
    find_file: FileSearch = FileSearch(),  # noqa: B008 (it is immutable)
) -> WorldSpec:
    """Read and check a world file.

    A model, light, frame or state that is not valid, or an <include> that is not found, is left out
    which is reported as an error and in `WorldSpec.faults`; the others are loaded, as in Gazebo.

    Args:
        source: the file's path; it begins every message, and relative addresses start from it.
        find_model: see `load_sdf`.
        find_package: see `load_sdf`.
        find_file: see `load_sdf`.
    Raises:
        ModelError: the text is not SDF with a <world>, or a number of the world is not valid.
    """
    library = SdfLibrary(Addresses(find_model, find_package, find_file))
    directory = os.path.dirname(os.path.abspath(source)) if os.path.isfile(source) else ''
    document = library.add(text, source, directory)
    world = document.root.find('world')
    if world is None:
        raise fault(document.root, 'it has no <world>; a world file contains one')
    document.notes.check(world, _READ, _IDLE)
    content = _Content()
    frames = _frames(world, content)
    for element in world:
        reader = _READERS.get(element.tag)
        if reader is not None:
            with _left_out(content, element.tag):
                reader(document, element, frames, content)
    _report_missing(document, content)
    states: tuple[ModelState, ...] = ()
    time, state = 0.0, world.find('state')
    if state is not None:
        with _left_out(content, 'state'):
            states, time = read_states(document, state)
    scene = read_scene(document, world)
    with _left_out(content, 'gui'):
        scene = replace(scene, user_camera=read_user_camera(document, world))
    spec = WorldSpec(
        world.get('name', 'default'),
        tuple(content.models.values()),
        read_physics(document, world),
        tuple(content.lights),
        scene,
        tuple(content.plugins),
        states,
        time,
        tuple(_parts(world)),
        tuple(content.faults),
    )
    library.report()
    return spec


def open_world(
    path: str | os.PathLike[str],
    *,
    find_model: FindModel,
    find_package: FindPackage | None = None,
    find_file: FileSearch = FileSearch(),  # noqa: B008 (it is immutable)
) -> WorldSpec:
    """Read and check the world file at `path`, as `load_world` does.

    Raises:
        ModelError: the file cannot be read; or as `load_world`.
    """
    text = read_file(os.fspath(path), MAX_XML_BYTES, 'world file')
    return load_world(
        text, os.fspath(path), find_model=find_model, find_package=find_package, find_file=find_file
    )


@contextmanager
def _left_out(content: _Content, tag: str) -> Iterator[None]:
    """Report a fault in one element of a world as an error, and leave the element out."""
    try:
        yield
    except MissingModel as error:
        content.missing.append(error)
    except ModelError as error:
        content.faults.append(str(error))
        without = _WITHOUT.get(tag, _WITHOUT['model'])
        report(Fault(f'{error}; {without}', logging.ERROR, **error.place))


def _report_missing(document: SdfDocument, content: _Content) -> None:
    """Report the models that are not found as one error."""
    if not content.missing:
        return
    names = list(dict.fromkeys(error.model for error in content.missing))
    sentence, without = str(content.missing[0]), _WITHOUT['model']
    if len(content.missing) > 1:
        without = 'the world is loaded without them'
        shown = listed([repr(name) for name in names])
        end = not_on_model_path(
            document.library.addresses.find_model, 'them', 'is' if len(names) == 1 else 'are'
        )
        sentence = document.notes.with_source(f'{len(content.missing)} <include>s: {shown} {end}')
    content.faults.append(sentence)
    report(Fault(f'{sentence}; {without}', logging.ERROR, **content.missing[0].place))


def _frames(world: etree._Element, content: _Content) -> Frames:
    """Return the frames in which models of a world may be posed."""
    frames = Frames('world')
    for element in world:
        if element.tag in ('model', 'include'):
            name = element.get('name') or text_of(element, 'name')
            if name:
                with suppress(ModelError):  # reported when the model is read
                    frames.add(name, element)
        elif element.tag == 'frame':
            with _left_out(content, 'frame'):
                frames.add(required_name(element), element, element.get('attached_to', ''))
    return frames


def _read_model(
    document: SdfDocument, element: etree._Element, frames: Frames, content: _Content
) -> None:
    def read() -> ModelParts:
        required_name(element)
        return read_model(document, element)

    _add_model(document, element, frames, content, read)


def _read_include(
    document: SdfDocument, element: etree._Element, frames: Frames, content: _Content
) -> None:
    other = document.included(element)
    light = other.root.find('light')
    if other.root.find('model') is None and light is not None:
        posed = light if element.find('pose') is None else element
        spec = read_light(other, light, frames.place(posed))
        content.lights.append(replace(spec, name=text_of(element, 'name', spec.name)))
        return
    _add_model(document, element, frames, content, lambda: read_include(document, element))


def _add_model(
    document: SdfDocument,
    element: etree._Element,
    frames: Frames,
    content: _Content,
    read: Callable[[], ModelParts],
) -> None:
    parts = read()
    if not parts.name:
        raise fault(element, 'the model has no name; add <name>...</name>')
    name = _free_name(document, element, parts.name, content)
    posed = None if parts.pose_element is None else parts.pose_element.getparent()
    pose = frames.place(element if posed is None else posed)
    content.models[name] = (model_spec(parts, name), pose)


def _free_name(document: SdfDocument, element: etree._Element, name: str, content: _Content) -> str:
    """Return the name, with a number appended if it is taken, as by Gazebo's factory."""
    free = name
    while free in content.models:
        free = f'{name}_{content.taken[name]}'
        content.taken[name] += 1
    if free != name:
        document.notes.warn(
            element, f"the world already has a model '{name}'; this one is called '{free}'"
        )
    return free


def _read_light(
    document: SdfDocument, element: etree._Element, frames: Frames, content: _Content
) -> None:
    content.lights.append(read_light(document, element, frames.place(element)))


def _read_plugin(
    document: SdfDocument, element: etree._Element, frames: Frames, content: _Content
) -> None:
    add_plugin(document, element, content.plugins)


_READERS = {
    'model': _read_model,
    'include': _read_include,
    'light': _read_light,
    'plugin': _read_plugin,
}


def _parts(world: etree._Element) -> Iterator[Element]:
    """Yield what is kept for the one who saves the world."""
    for element in world:
        if element.tag == 'gui' or element.tag not in _READ:
            yield to_element(element)
        elif element.tag == 'scene':
            kept = to_element(element)
            inner = tuple(child for child in kept.children if child.tag not in READ_OF_SCENE)
            if inner:
                yield replace(kept, children=inner)
