"""Models of SDF: links, joints and plugins, with nested and included models flattened.

Parts of a nested model are called `inner::name` in the outer one, as in Gazebo. Fixed joints are
kept: only those of URDF are reduced.
"""

from collections import Counter
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, field, replace

from lxml import etree

from ...core import AbsentError, Pose, compose, fault, location, shortened
from ...description import (
    WORLD,
    Element,
    JointSpec,
    LinkSpec,
    ModelSpec,
    Plane,
    PluginSpec,
    SensorSpec,
)
from ...description.inertia import impossible, possible, regularised
from ..xml import required_name, to_element
from .document import SdfDocument
from .exact import REDUCED
from .frames import MODEL_FRAME, Frames
from .joints import add_joint_frame, as_trees, read_sdf_joint
from .links import UNIT_INERTIAL, read_link
from .values import boolean_of, pose_in, text_of

_READ = ('pose', 'link', 'joint', 'frame', 'plugin', 'model', 'include', 'static', 'self_collide')
_INCLUDE_READ = ('uri', 'name', 'pose', 'static', 'plugin')


@dataclass
class ModelParts:
    """The parts of a model, in its own frame, with their elements.

    `pose_element` holds its pose in the world or outer model.
    """

    document: SdfDocument
    element: etree._Element
    name: str
    static: bool
    pose_element: etree._Element | None
    links: list[LinkSpec] = field(default_factory=list)
    joints: list[tuple[JointSpec, etree._Element]] = field(default_factory=list)
    plugins: list[PluginSpec] = field(default_factory=list)
    nested: dict[str, Pose] = field(default_factory=dict)  # nested model -> pose of its frame
    reduced: dict[str, tuple[str, Pose]] = field(default_factory=dict)  # as in `ModelSpec`
    left_out: list[str] = field(default_factory=list)  # parts that were left out


def read_model(
    document: SdfDocument, element: etree._Element, static: bool | None = None
) -> ModelParts:
    """Return the parts of a <model>, including those of nested models.

    Args:
        static: whether it is static; None: its own <static> decides.
    Raises:
        ModelError: something in it cannot be simulated; the message says where and why.
    """
    document.notes.check(element, _READ, ('allow_auto_disable',))
    if static is None:
        static = boolean_of(element, 'static')
    parts = ModelParts(document, element, element.get('name', ''), static, element.find('pose'))
    known = len(document.notes.left_out.parts)
    nested = _nested_models(document, element, True if static else None)
    frames = _frames(element, nested)
    for child in element.iterfind('plugin'):
        add_plugin(document, child, parts.plugins)
    self_collide = boolean_of(element, 'self_collide')
    parts.links = [
        read_link(document, child, frames, parts.static, self_collide)
        for child in element.iterfind('link')
    ]
    parts.reduced = {
        required_name(child): (child.get('attached_to', ''), pose_in(child.find('pose')))
        for child in element.iterfind('frame')
        if child.get(REDUCED)
    }
    for model in nested:
        _merge_nested(parts, model, frames.pose_of(model.name, model.element))
    for child in element.iterfind('joint'):
        _add_joint(document, child, frames, parts)
    parts.left_out += document.notes.left_out.parts[known:]
    canonical = element.get('canonical_link')
    if canonical and parts.links and canonical != parts.links[0].name:
        document.notes.warn(element, 'canonical_link is not read; the first link is canonical')
    return parts


def _nested_models(
    document: SdfDocument, element: etree._Element, static: bool | None
) -> list[ModelParts]:
    """Return the nested models of a model; those of a static model are static.

    As in Gazebo an included model that cannot be found is left out.
    """
    nested = []
    for child in element:
        if child.tag == 'model':
            nested.append(read_model(document, child, static))
        elif child.tag == 'include':
            try:
                document.included(child)
            except AbsentError as error:
                called = f"model '{shortened(text_of(child, 'uri'), 100)}'"
                document.notes.left_out.part(called, error)
            else:
                nested.append(read_include(document, child, static))
    return nested


def _add_joint(
    document: SdfDocument, element: etree._Element, frames: Frames, parts: ModelParts
) -> None:
    """Add a joint to a model; as in Gazebo a joint whose links do not exist is left out."""
    try:
        joint = read_sdf_joint(document, element, frames)
    except AbsentError as error:
        document.notes.left_out.part(f"joint '{shortened(element.get('name', ''), 100)}'", error)
        return
    if joint is not None:
        parts.joints.append((joint, element))


def read_include(
    document: SdfDocument, element: etree._Element, static: bool | None = None
) -> ModelParts:
    """Return the parts of the model that an <include> names, with its name, pose and static.

    Args:
        static: whether it is static; None: the <static> of the include or the model decides.
    Raises:
        ModelError: there is no such model, or it cannot be simulated.
    """
    document.notes.check(element, _INCLUDE_READ)
    other = document.included(element)
    model = other.root.find('model')
    if model is None:
        raise fault(
            element, f"'{text_of(element, 'uri')}' contains no <model>; it cannot be included here"
        )
    if static is None and element.find('static') is not None:
        static = boolean_of(element, 'static')
    parts = document.library.within(other, element, lambda: read_model(other, model, static))
    parts.element = element
    parts.name = text_of(element, 'name', parts.name)
    if element.find('pose') is not None:
        parts.pose_element = element.find('pose')
    for child in element.iterfind('plugin'):
        add_plugin(document, child, parts.plugins)
    return parts


def model_spec(parts: ModelParts, name: str) -> ModelSpec:
    """Return the complete and checked model under the given name.

    Raises:
        ModelError: it has no link, or names are not unique.
    """
    if not parts.links:
        raise fault(parts.element, 'the model has no <link>; a model needs at least one')
    _require_unique(parts, [link.name for link in parts.links], 'link')
    _require_unique(parts, [joint.name for joint, _ in parts.joints], 'joint')
    joints = as_trees(parts.document, parts.links, parts.joints)
    links = parts.links
    if not parts.static:
        links = _movable(parts, links, {joint.child for joint in joints})
    return ModelSpec(
        name,
        tuple(links),
        joints,
        tuple(parts.plugins),
        parts.static,
        parts.reduced,
        parts.nested,
        left_out=tuple(dict.fromkeys(parts.left_out)),
        location=location(parts.element),
    )


def _frames(element: etree._Element, nested: Sequence[ModelParts]) -> Frames:
    """Return the frames of a model; if a name occurs twice, links precede models, then others."""
    frames = Frames(MODEL_FRAME)
    for child in element.iterfind('link'):
        frames.add(required_name(child), child)
    for model in nested:
        if not model.name:
            raise fault(model.element, 'a <model> without name; add name="..."')
        first = f'{model.name}::{model.links[0].name}' if model.links else ''
        frames.add(model.name, model.element, carrier=first, pose_element=model.pose_element)
        for link in model.links:
            frames.add_at(f'{model.name}::{link.name}', model.element, link.pose, model.name)
    for child in element.iterfind('joint'):
        add_joint_frame(frames, child)
    for child in element.iterfind('frame'):
        attached = child.get('attached_to', '')
        frames.add(required_name(child), child, attached, carrier=attached)
    return frames


def _merge_nested(parts: ModelParts, nested: ModelParts, pose: Pose) -> None:
    """Add a nested model, whose frame is at `pose`, to the outer one."""
    prefix = f'{nested.name}::'
    parts.nested[nested.name] = pose
    parts.left_out += nested.left_out
    parts.nested |= {prefix + name: compose(pose, place) for name, place in nested.nested.items()}
    names = {link.name for link in nested.links} | {joint.name for joint, _ in nested.joints}
    bolted = nested.static and not parts.static
    parts.links += [
        replace(
            link,
            name=prefix + link.name,
            pose=compose(pose, link.pose),
            kinematic=link.kinematic or bolted,
            sensors=tuple(_scoped_sensor(sensor, names, prefix) for sensor in link.sensors),
        )
        for link in nested.links
    ]
    parts.joints += [
        (
            replace(
                joint,
                name=prefix + joint.name,
                parent=joint.parent if joint.parent == WORLD else prefix + joint.parent,
                child=prefix + joint.child,
            ),
            element,
        )
        for joint, element in nested.joints
    ]
    parts.plugins += _scoped_plugins(nested.plugins, names, prefix)


def _scoped(element: Element, names: Collection[str], prefix: str) -> Element:
    """Return an element of an inner model; links and joints it names get their new name."""
    return replace(
        element,
        text=prefix + element.text if element.text in names else element.text,
        children=tuple(_scoped(child, names, prefix) for child in element.children),
    )


def _scoped_plugins(
    plugins: Iterable[PluginSpec], names: Collection[str], prefix: str
) -> list[PluginSpec]:
    return [replace(plugin, element=_scoped(plugin.element, names, prefix)) for plugin in plugins]


def _scoped_sensor(sensor: SensorSpec, names: Collection[str], prefix: str) -> SensorSpec:
    return replace(
        sensor,
        element=_scoped(sensor.element, names, prefix),
        plugins=tuple(_scoped_plugins(sensor.plugins, names, prefix)),
    )


def add_plugin(document: SdfDocument, element: etree._Element, plugins: list[PluginSpec]) -> None:
    """Add a <plugin>; one without a filename is noted and ignored."""
    filename = element.get('filename', '').strip()
    if filename:
        plugins.append(PluginSpec(element.get('name', ''), filename, to_element(element)))
    else:
        what = 'a <plugin> without filename is ignored; add filename="libgazebo_ros_….so"'
        document.notes.warn(element, what)


def _movable(
    parts: ModelParts, links: Sequence[LinkSpec], children: Collection[str]
) -> list[LinkSpec]:
    """Return the links of a moving model as the engine can move them; note the changes."""
    notes, made = parts.document.notes, []
    for link in links:
        given = link.inertial or UNIT_INERTIAL
        real = possible(given)
        if real is not given:
            notes.warn(parts.element, impossible(link.name, given, real))
        inertial = regularised(real)
        if inertial is not real:
            notes.warn(
                parts.element,
                f"link '{link.name}': an inertia of zero cannot be simulated; "
                'that of a small sphere of the same mass is used',
            )
        solid = tuple(c for c in link.collisions if not isinstance(c.geometry, Plane))
        if len(solid) < len(link.collisions):
            notes.warn(
                parts.element,
                f"link '{link.name}': an infinite plane cannot move; its collision is left out; "
                'make the model <static>',
            )
        kinematic = link.kinematic and link.name not in children
        if link.kinematic and not kinematic:
            notes.warn(
                parts.element,
                f"link '{link.name}': <kinematic> is not read where a joint moves the link",
            )
        made.append(replace(link, inertial=inertial, collisions=solid, kinematic=kinematic))
    return made


def _require_unique(parts: ModelParts, names: Sequence[str], kind: str) -> None:
    twice = [name for name, count in Counter(names).items() if count > 1]
    if twice:
        raise fault(parts.element, f"there are two {kind}s '{twice[0]}'; names must be unique")
