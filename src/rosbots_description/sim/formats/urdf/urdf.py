"""Convert the text of a URDF to a `ModelSpec`, by the rules of sdformat 9 (parser_urdf.cc)."""

import logging
from dataclasses import replace

from lxml import etree

from ...core import Fault, ModelError, Pose, fault, location, note, report, shortened
from ...description import WORLD, LinkSpec, ModelSpec
from ...description.inertia import impossible, possible, regularised
from ...meshes import check_mesh
from ...resources import (
    Addresses,
    FileSearch,
    FindModel,
    FindPackage,
    parse_xml,
    substitute_in_tree,
)
from ..kinematics import (
    KinematicTree,
    Reduction,
    build_tree,
    reduce_fixed_joints,
    require_links,
)
from ..xml import (
    XACRO_CURE,
    check_name,
    foreign_tags,
    initial_pose,
    inject_namespace,
    origin,
    remove_xacro,
    required_name,
    tag_of,
)
from .elements import LinkReader, read_urdf_joint
from .gazebo_tags import GazeboTags, SpringTags, read_gazebo_tags
from .link_tags import apply_tags
from .robot_control import read_robot_control


def load_urdf(
    text: str | bytes,
    name: str,
    *,
    source: str = 'robot_description',
    robot_namespace: str = '',
    find_package: FindPackage | None = None,
    find_model: FindModel = lambda inner: None,
    find_file: FileSearch = FileSearch(),  # noqa: B008 (it is immutable)
) -> tuple[ModelSpec, Pose]:
    """Read and check a URDF, and reduce its fixed joints.

    Args:
        name: of the model; the robot's own name is ignored, as in Gazebo.
        source: origin of the text, a file or parameter; it begins every message.
        robot_namespace: given to plugins that have no <robotNamespace>; '' for none.
        find_package: package name -> its directory, or None if unknown, for package://.
        find_model: path below the model path -> file, or None, for model:// of meshes.
        find_file: for file:// with a relative path, and for materials by name.

    Returns:
        The model, and the <origin> directly below <robot>. The caller spawns the model at
        compose(initial pose, <origin>).

    Raises:
        UnknownPackage: a package:// address names a package that is not found.
        ModelError: the description cannot be simulated; the message says where and why.

    What is simulated differently than written is reported as a warning, one per kind.
    """
    check_name(name)
    robot = parse_xml(text, source)
    if robot.tag != 'robot':
        raise fault(robot, f'the first element is <{tag_of(robot)}>; a URDF begins with <robot>')
    if find_package is not None:
        substitute_in_tree(robot, find_package)
    inject_namespace(robot, robot_namespace)
    xacro = remove_xacro(robot)
    notes = [Fault(sentence) for sentence in (*xacro, *foreign_tags(robot))]
    try:
        tree, tags = _read(robot, notes, Addresses(find_model, find_package, find_file))
    except ModelError as error:
        if not xacro or XACRO_CURE in str(error):
            raise
        # Most likely xacro would have generated what is missing.
        raise ModelError(f'{error}; {"; ".join(xacro)}') from error
    reduction = reduce_fixed_joints(tree)
    require_links(tree, reduction)
    spec = ModelSpec(
        name,
        _regularised_links(reduction.links, notes),
        reduction.joints,
        tuple(tags.plugins),
        tags.static,
        reduction.parents,
        left_out=tuple(dict.fromkeys((*tags.left_out.parts, *_quoted(reduction.vanished)))),
        location=location(robot),
        control=read_robot_control(robot),
    )
    pose = initial_pose(lambda: origin(robot), name)
    _report(name, source, [*notes, *tags.left_out.warnings, *_reduction_notes(reduction)], tags)
    return spec, pose


def _report(name: str, source: str, warnings: list[Fault], tags: GazeboTags) -> None:
    """Report what of a description is simulated otherwise than written, or not at all."""
    faults = tags.left_out.errors()
    faults += [replace(one, what=one.what.removeprefix(f'{source}, ')) for one in warnings]
    if tags.idle:
        idle = ', '.join(dict.fromkeys(tags.idle))
        faults.append(Fault(f'without effect here: {idle}', logging.DEBUG))
    for one in faults:
        report(replace(one, what=f"model '{name}' ({source}): {one.what}", model=name))


def _read(
    robot: etree._Element, notes: list[Fault], addresses: Addresses
) -> tuple[KinematicTree, GazeboTags]:
    link_elements, joint_elements = robot.findall('link'), robot.findall('joint')
    tags = read_gazebo_tags(
        robot,
        [required_name(element) for element in link_elements],
        [required_name(element) for element in joint_elements],
        addresses,
    )
    notes += tags.notes
    joints = [read_urdf_joint(element, tags.kept_joints, notes) for element in joint_elements]
    joints = [
        replace(joint, spec=replace(joint.spec, **tags.joints.get(joint.spec.name, SpringTags())))
        for joint in joints
    ]
    reader = LinkReader(robot, check_mesh, tags.left_out, addresses)
    links = [
        apply_tags(link, tags.links.get(link.spec.name))
        for link in (reader.read(element) for element in link_elements)
    ]
    notes += reader.notes
    tree = build_tree(robot, links, joints)
    world = tree.links[tree.root].spec if tree.root == WORLD else None
    if world and (world.collisions or world.visuals or world.inertial):
        notes.append(
            Fault(
                "'world': a root of that name is the world itself; the content of the link is "
                'not simulated, as in Gazebo'
            )
        )
    return tree, tags


def _regularised_links(links: tuple[LinkSpec, ...], notes: list[Fault]) -> tuple[LinkSpec, ...]:
    """Return the links, with zero principal moments replaced; `notes` names the changed ones."""
    links = tuple(_possible_link(link, notes) for link in links)
    turned = tuple(replace(link, inertial=regularised(link.mass_properties)) for link in links)
    changed = [
        new.name for old, new in zip(links, turned, strict=True) if new.inertial is not old.inertial
    ]
    if changed:
        note(
            notes,
            lambda: Fault(
                f'{_names(changed)}: an inertia of zero cannot be simulated; '
                'that of a small sphere of the same mass is used'
            ),
        )
    return turned


def _possible_link(link: LinkSpec, notes: list[Fault]) -> LinkSpec:
    """Return the link with a physically possible inertia; a note shows both tensors."""
    given = link.mass_properties
    inertial = possible(given)
    if inertial is given:
        return link
    note(notes, lambda: Fault(impossible(link.name, given, inertial), link=link.name))
    return replace(link, inertial=inertial)


def _reduction_notes(reduction: Reduction) -> list[Fault]:
    notes = []
    if reduction.vanished:
        notes.append(
            Fault(
                f'{_names(reduction.massless)}: no mass (no <inertial>, or zero); '
                f'not simulated, as in Gazebo: {_names(reduction.vanished)}',
                cure='give each an <inertial>',
            )
        )
    if reduction.conflicts:
        notes.append(
            Fault(
                f'{_names(reduction.conflicts)}: gravity, selfCollide or damping set for a reduced '
                'link (child of a fixed joint) applies to the link it is merged into, as in Gazebo'
            )
        )
    return notes


def _quoted(links: tuple[str, ...]) -> list[str]:
    return [f"link '{shortened(link, 60)}'" for link in links]


def _names(names: tuple[str, ...] | list[str], most: int = 12) -> str:
    shown = ', '.join(f"'{shortened(name, 60)}'" for name in names[:most])
    return shown + (f' and {len(names) - most} more' if len(names) > most else '')
