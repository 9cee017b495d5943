"""Links and joints as described, before fixed joint reduction, verified to be one tree."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypedDict, TypeVar

from lxml import etree

from ...core import IDENTITY, Pose, fault, line_of, suggestion
from ...description import FIXED, WORLD, JointSpec, LinkSpec

FREE = 'free'  # a joint type without constraints: the child becomes a tree of its own


class LinkFlags(TypedDict, total=False):
    """Fields of LinkSpec that a description sets explicitly."""

    gravity: bool
    self_collide: bool
    linear_damping: float
    angular_damping: float


@dataclass(frozen=True)
class TreeLink:
    """A link as described; shape names are as written, '' if there is none.

    `flags` are set by <gazebo> blocks; they also apply to the link this one is reduced into.
    """

    spec: LinkSpec
    element: etree._Element
    flags: LinkFlags = field(default_factory=LinkFlags)


@dataclass(frozen=True)
class TreeJoint:
    """A joint as described; `origin` is the child's pose in the parent at position zero."""

    spec: JointSpec
    element: etree._Element
    origin: Pose = IDENTITY
    is_reduced: bool = False  # the child becomes part of the parent


@dataclass(frozen=True)
class KinematicTree:
    """All links and joints: one root, and every other link is the child of exactly one joint."""

    root: str
    links: Mapping[str, TreeLink]
    joint_to: Mapping[str, TreeJoint]  # child link -> the joint above it
    joints_below: Mapping[str, tuple[TreeJoint, ...]]  # parent link -> joints, by name

    def depth_first(self) -> list[str]:
        """Return the links, parents before children, siblings by the name of their joint.

        This is the order in which Gazebo lists the links of a URDF: urdfdom keeps joints by name.
        """
        order, waiting = [], [self.root]
        while waiting:
            name = waiting.pop()
            order.append(name)
            waiting.extend(joint.spec.child for joint in reversed(self.joints_below.get(name, ())))
        return order

    def reduces(self, joint: TreeJoint) -> bool:
        """Tell whether a joint's child becomes part of its parent."""
        bolts = self.root == WORLD and joint.spec.parent == WORLD
        return joint.spec.type == FIXED and joint.is_reduced and not bolts


def build_tree(
    robot: etree._Element, links: Sequence[TreeLink], joints: Sequence[TreeJoint]
) -> KinematicTree:
    """Connect links and joints.

    Raises:
        ModelError: no link, duplicate names, a joint to an unknown link, a link that is the child
            of two joints, no root or several, a loop.
    """
    by_name = _unique(links, 'link')
    _unique(joints, 'joint')
    if not by_name:
        raise fault(robot, 'the model has no <link>; a model needs at least one, with a mass')
    joint_to: dict[str, TreeJoint] = {}
    below: dict[str, list[TreeJoint]] = {}
    for joint in joints:
        for role, name in (('parent', joint.spec.parent), ('child', joint.spec.child)):
            if name not in by_name:
                raise fault(
                    joint.element,
                    f"{role} link '{name}' does not exist{suggestion(name, by_name)}",
                )
        first = joint_to.setdefault(joint.spec.child, joint)
        if first is not joint:
            raise fault(
                joint.element,
                f"child link '{joint.spec.child}' is already the child of joint "
                f"'{first.spec.name}' ({line_of(first.element)}); a link has one parent joint",
            )
        below.setdefault(joint.spec.parent, []).append(joint)
    root = _find_root(robot, by_name, joint_to)
    tree = KinematicTree(
        root,
        by_name,
        joint_to,
        {
            name: tuple(sorted(group, key=lambda joint: joint.spec.name))
            for name, group in below.items()
        },
    )
    _refuse_loops(tree)
    return tree


Named = TypeVar('Named', TreeLink, TreeJoint)


def _unique(items: Sequence[Named], kind: str) -> dict[str, Named]:
    by_name: dict[str, Named] = {}
    for item in items:
        first = by_name.setdefault(item.spec.name, item)
        if first is not item:
            raise fault(
                item.element,
                f"the {kind} '{item.spec.name}' is already defined in "
                f'{line_of(first.element)}; {kind} names must be unique',
            )
    return by_name


def _find_root(
    robot: etree._Element, links: Mapping[str, TreeLink], joint_to: Mapping[str, TreeJoint]
) -> str:
    roots = [name for name in links if name not in joint_to]
    if len(roots) == 1:
        return roots[0]
    if not roots:
        first = next(iter(joint_to.values()))
        raise fault(first.element, 'the joints form a loop; one link must have no parent joint')
    shown = ', '.join(f"'{name}' ({line_of(links[name].element)})" for name in roots[:6])
    more = f' and {len(roots) - 6} more' if len(roots) > 6 else ''
    raise fault(
        robot,
        f'{len(roots)} links are not the child of any joint: {shown}{more}; a model has one root: '
        'connect the others with joints',
    )


def _refuse_loops(tree: KinematicTree) -> None:
    reached = set(tree.depth_first())
    lost = [name for name in tree.links if name not in reached]
    if lost:
        shown = ', '.join(f"'{name}'" for name in lost[:6])
        raise fault(
            tree.joint_to[lost[0]].element,
            f"the joints of {shown} form a loop that is not connected to the root '{tree.root}'; "
            'every link must descend from the root',
        )
