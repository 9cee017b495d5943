"""Compiles a model's description for PyBullet, once per spawn.

Slow work and checks of the engine's limits are done here, on any thread: meshes, surfaces, the
URDF that PyBullet reads. The world and the crash sandbox share the result.
"""

import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

from ...core import NO_ROTATION, ModelError, Pose, Quaternion, Vector
from ...description import Collision, Inertial, JointSpec, LinkSpec, Mesh, ModelSpec, Surface
from ...description.inertia import principal_axes
from ...meshes import EngineFiles, SharedFile
from ..compiled_model import CompiledModel, bare
from .body import FrictionAxes
from .contact_parts import ContactPart, contact_parts, slab
from .contact_stiffness import compliant, jointed_mass, restitution
from .friction_axes import friction_scales
from .friction_pairs import Side
from .friction_rolling import rolling_arm
from .generated_urdf import MeshFile, Tree, describe_tree, kinematic_trees
from .shape_groups import Groups, surface_groups, with_split_edges
from .size_limits import MAX_JOINTS, excess_of_joints, excess_of_parts

_MASSLESS = Inertial(0.0)


@dataclass(frozen=True)
class CompiledContactPart:
    """Shapes and contact properties of a part, in PyBullet's terms."""

    shapes: tuple[Collision, ...]
    side: Side
    friction: float
    rolling_friction: float  # [m]
    restitution: float
    surface: Surface  # with limited stiffness
    axes: FrictionAxes


@dataclass(frozen=True)
class CompiledBody:
    """One PyBullet body: the URDF it is loaded from, and the contact parts of each link.

    The first part is on the link itself, the others are on its auxiliary links; None: no shapes.
    """

    text: str
    contact_parts: tuple[tuple[CompiledContactPart | None, ...], ...]


@dataclass(frozen=True)
class CompiledTree:
    """A kinematic tree and the bodies that represent it.

    Only a static tree has several bodies; states are read from the first one.
    """

    tree: Tree  # without visuals and sensors
    moments: tuple[Vector, ...]  # principal moments of inertia of each link [kg m^2]
    inertials: tuple[Pose, ...]  # centre of mass and principal axes, in the link's frame
    bodies: tuple[CompiledBody, ...]


@dataclass(frozen=True)
class BulletModel(CompiledModel):
    """A model ready for the engine on PyBullet."""

    trees: tuple[CompiledTree, ...]


def compile_model(spec: ModelSpec, meshes: EngineFiles) -> BulletModel:
    """Compile a model for the engine.

    Args:
        meshes: writes the mesh files; it must stay open as long as the model is in use.
    Raises:
        ModelError: the model exceeds a limit of the engine, or a mesh file cannot be read or
            written; the message says which.
    """
    _require(spec, excess_of_parts(spec))
    groups = []
    trees = kinematic_trees(bare(spec))
    for tree in trees:
        groups.append([surface_groups(tree, i) for i in range(len(tree.links))])
        _require(spec, excess_of_joints(tree, groups[-1]))
    files: dict[tuple[bool, Mesh], SharedFile] = {}

    def mesh_file(exact: bool, mesh: Mesh) -> str:
        if (exact, mesh) not in files:
            files[exact, mesh] = meshes.engine_file(mesh, exact)
        return str(files[exact, mesh])  # a reference is kept by the model alone

    size = 0
    compiled = []
    for tree, of_tree in zip(trees, groups, strict=True):
        file_of = partial(mesh_file, tree.is_static)
        compiled.append(_compiled_tree(tree, of_tree, file_of))
        size += sum(len(body.text) for body in compiled[-1].bodies)
        shapes = [collision.geometry for link in tree.links for collision in link.collisions]
        size += sum(os.path.getsize(file_of(one)) for one in shapes if isinstance(one, Mesh))
    return BulletModel(spec, tuple(files.values()), size, tuple(compiled))


def _require(spec: ModelSpec, excess: str | None) -> None:
    if excess:
        raise ModelError(f'{spec.location or f"model {spec.name!r}"}: {excess}')


def _compiled_tree(tree: Tree, groups: list[Groups], mesh_file: MeshFile) -> CompiledTree:
    inertials = [link.inertial or _MASSLESS for link in tree.links]
    moments, axes = zip(*map(principal_axes, inertials), strict=True)
    coms = tuple(
        Pose(inertial.pose.position, orientation)
        for inertial, orientation in zip(inertials, axes, strict=True)
    )
    split = [with_split_edges(tree, groups[0]), *groups[1:]]
    found = contact_parts(tree, split, MAX_JOINTS + 1)
    # Each part of a static tree is a body of its own.
    bodies = [[[part]] for part in (*found[0], *slab(tree))] if tree.is_static else [found]
    return CompiledTree(
        tree,
        moments,
        coms,
        tuple(
            CompiledBody(
                describe_tree(
                    tree, coms, [[part.shapes for part in of_link] for of_link in body], mesh_file
                ),
                _compiled_contact_parts(tree, coms, body),
            )
            for body in bodies
        ),
    )


def _compiled_contact_parts(
    tree: Tree, coms: Sequence[Pose], body: list[list[ContactPart]]
) -> tuple[tuple[CompiledContactPart | None, ...], ...]:
    """Return the contact parts of each link of a body of a tree."""
    mass = jointed_mass(tree)
    compiled = []
    for link, joint, com, of_link in zip(tree.links, tree.joints, coms, body, strict=True):
        # An auxiliary link has the frame of its link's parent joint.
        auxiliary = joint.pose.orientation if joint else NO_ROTATION
        compiled.append(
            tuple(
                _compiled_contact_part(part, link, joint, mass, auxiliary if k else com.orientation)
                for k, part in enumerate(of_link)
            )
        )
    return tuple(compiled)


def _compiled_contact_part(
    part: ContactPart, link: LinkSpec, joint: JointSpec | None, mass: float, turn: Quaternion
) -> CompiledContactPart | None:
    """Return a contact part of a link; `turn` rotates its axes in PyBullet into the link's axes."""
    if not part.shapes:
        return None
    surface = compliant(part.shapes[0].surface, mass)
    return CompiledContactPart(
        part.shapes,
        part.side,
        part.friction,
        rolling_arm(part.shapes, joint),
        restitution(surface),
        surface,
        FrictionAxes(turn, friction_scales(part.shapes[0], link, turn, part.friction)),
    )
