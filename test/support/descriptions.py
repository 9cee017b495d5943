"""Strategies for valid models in URDF and SDF, with their expected mass and centre of mass.

Expected values are computed here from 4x4 matrices, independent of the code under test.
"""

import math
from dataclasses import dataclass, field

import numpy as np
from hypothesis import strategies as st
from lxml import etree

LENGTHS = st.floats(0.01, 3.0)  # [m]
POSITIONS = st.floats(-5.0, 5.0)  # [m]
ANGLES = st.floats(-math.pi, math.pi)  # [rad]
MASSES = st.floats(1e-3, 1e3)  # [kg]
MOMENTS = st.floats(1e-4, 10.0)  # [kg m^2]
NAMES = st.text(
    st.characters(whitelist_categories=('L', 'N'), whitelist_characters='_-/ .:'),
    min_size=1,
    max_size=12,
)
NAMES = NAMES.map(str.strip).filter(lambda name: name not in ('', 'world'))
JOINT_TYPES = ('fixed', 'fixed', 'continuous', 'revolute', 'prismatic', 'floating', 'planar')


@dataclass
class Description:
    """A document, and the totals of its model."""

    text: str
    mass: float = 0.0  # [kg]
    moment: np.ndarray = field(default_factory=lambda: np.zeros(3))  # sum of m * r [kg m]
    links: int = 0

    @property
    def centre(self) -> np.ndarray:
        """Return the centre of mass in the model's frame [m]."""
        return self.moment / self.mass

    def add_mass(self, frame: np.ndarray, mass: float, centre: tuple[float, ...]) -> None:
        """Add a mass [kg] with its centre [m] in a frame, a 4x4 matrix in the model's frame."""
        self.mass += mass
        self.moment = self.moment + mass * (frame @ [*centre, 1.0])[:3]


@dataclass(frozen=True)
class Origin:
    """A pose as xyz [m] and rpy [rad], as in both formats."""

    xyz: tuple[float, float, float]
    rpy: tuple[float, float, float]

    @property
    def matrix(self) -> np.ndarray:
        """Return the 4x4 matrix: rotation about fixed x, y and z, then translation."""
        matrix = np.eye(4)
        for axis, angle in zip((0, 1, 2), self.rpy, strict=True):
            turn = np.eye(4)
            a, b = (axis + 1) % 3, (axis + 2) % 3
            turn[a, a] = turn[b, b] = math.cos(angle)
            turn[b, a], turn[a, b] = math.sin(angle), -math.sin(angle)
            matrix = turn @ matrix
        matrix[:3, 3] = self.xyz
        return matrix


ORIGINS = st.builds(Origin, st.tuples(*[POSITIONS] * 3), st.tuples(*[ANGLES] * 3))


def words(numbers) -> str:
    """Return numbers as the text of an attribute."""
    return ' '.join(map(repr, numbers))


def child(parent: etree._Element, tag: str, text: str | None = None, **attributes: str):
    """Add an element and return it."""
    element = etree.SubElement(parent, tag, attributes)
    element.text = text
    return element


@st.composite
def urdfs(draw) -> Description:
    """Return a URDF with a tree of links, in which every mass is simulated."""
    names = draw(st.lists(NAMES, min_size=1, max_size=8, unique=True))
    parents = [None] + [draw(st.integers(0, i - 1)) for i in range(1, len(names))]
    kinds = [''] + [draw(st.sampled_from(JOINT_TYPES)) for _ in names[1:]]
    masses = _masses(draw, parents, kinds)
    robot = etree.Element('robot', name='random')
    description = Description('', links=len(names))
    frames: list[np.ndarray] = []
    for i, name in enumerate(names):
        link = child(robot, 'link', name=name)
        frame = np.eye(4)
        if i:
            place = draw(ORIGINS)
            _urdf_joint(draw, robot, f'joint of {name}', kinds[i], names[parents[i]], name, place)
            frame = frames[parents[i]] @ place.matrix
        frames.append(frame)
        if masses[i]:
            centre = draw(ORIGINS)
            inertial = child(link, 'inertial')
            child(inertial, 'origin', xyz=words(centre.xyz), rpy=words(centre.rpy))
            child(inertial, 'mass', value=repr(masses[i]))
            child(inertial, 'inertia', **_tensor(draw))
            description.add_mass(frame, masses[i], centre.xyz)
        for tag in draw(st.lists(st.sampled_from(('collision', 'visual')), max_size=3)):
            shape = child(link, tag)
            place = draw(ORIGINS)
            child(shape, 'origin', xyz=words(place.xyz), rpy=words(place.rpy))
            _urdf_shape(draw, child(shape, 'geometry'))
    _gazebo_blocks(draw, robot, names)
    description.text = etree.tostring(robot, encoding='unicode', pretty_print=True)
    return description


def _masses(draw, parents: list, kinds: list[str]) -> list[float]:
    """Return masses; 0 only for leaves on fixed joints and for links that fixed children weigh."""
    masses = [draw(st.just(0.0) | MASSES) for _ in parents]
    carried = list(masses)
    for i in range(len(parents) - 1, -1, -1):
        leaf = i not in parents
        if carried[i] == 0.0 and not (leaf and kinds[i] == 'fixed'):
            masses[i] = carried[i] = draw(MASSES)
        if kinds[i] == 'fixed':
            carried[parents[i]] += carried[i]
    return masses


def _tensor(draw) -> dict[str, str]:
    """Return an inertia tensor with positive moments: its diagonal dominates."""
    diagonal = draw(st.tuples(*[MOMENTS] * 3))
    products = draw(st.tuples(*[st.floats(-0.4, 0.4)] * 3))
    numbers = (*diagonal, *(min(diagonal) * product for product in products))
    keys = ('ixx', 'iyy', 'izz', 'ixy', 'ixz', 'iyz')
    return dict(zip(keys, map(repr, numbers), strict=True))


def _axis(draw) -> str:
    vector = draw(st.tuples(*[st.floats(-1.0, 1.0)] * 3).filter(lambda v: math.hypot(*v) > 0.1))
    return words(vector)


def _urdf_joint(draw, robot, name, kind, parent, link, place: Origin) -> None:
    joint = child(robot, 'joint', name=name, type=kind)
    child(joint, 'parent', link=parent)
    child(joint, 'child', link=link)
    child(joint, 'origin', xyz=words(place.xyz), rpy=words(place.rpy))
    if kind in ('continuous', 'revolute', 'prismatic'):
        child(joint, 'axis', xyz=_axis(draw))
        lower, upper = sorted(draw(st.tuples(ANGLES, ANGLES)))
        child(
            joint,
            'limit',
            lower=repr(lower),
            upper=repr(upper),
            effort=repr(draw(st.floats(0.0, 100.0))),
            velocity='10',
        )
        child(joint, 'dynamics', damping=repr(draw(st.floats(0.0, 1.0))))


def _urdf_shape(draw, geometry) -> None:
    kind = draw(st.sampled_from(('box', 'sphere', 'cylinder')))
    sizes = draw(st.tuples(*[LENGTHS] * 3))
    if kind == 'box':
        child(geometry, 'box', size=words(sizes))
    else:
        shape = child(geometry, kind, radius=repr(sizes[0]))
        if kind == 'cylinder':
            shape.set('length', repr(sizes[1]))


def _gazebo_blocks(draw, robot, names: list[str]) -> None:
    for name in draw(st.lists(st.sampled_from(names), max_size=3)):
        block = child(robot, 'gazebo', reference=name)
        tag, values = draw(
            st.sampled_from(
                (
                    ('mu1', st.floats(0.0, 5.0).map(repr)),
                    ('kp', st.floats(1e3, 1e15).map(repr)),
                    ('kd', st.floats(0.0, 1e3).map(repr)),
                    ('selfCollide', st.sampled_from(('true', 'false'))),
                    ('turnGravityOff', st.sampled_from(('true', 'false'))),
                    ('material', st.sampled_from(('Gazebo/Red', 'Gazebo/NoSuchColour'))),
                )
            )
        )
        child(block, tag, draw(values))
    if draw(st.booleans()):
        child(child(robot, 'gazebo'), 'static', draw(st.sampled_from(('true', 'false'))))


@st.composite
def sdfs(draw) -> Description:
    """Return an SDF model with any graph of joints, and perhaps a nested model."""
    root = etree.Element('sdf', version=draw(st.sampled_from(('1.4', '1.5', '1.6', '1.7'))))
    model = child(root, 'model', name='random')
    description = Description('')
    names = _sdf_model(draw, model, np.eye(4), description)
    if draw(st.booleans()):
        inner = child(model, 'model', name=draw(NAMES.filter(lambda name: name not in names)))
        place = draw(ORIGINS)
        child(inner, 'pose', words((*place.xyz, *place.rpy)))
        _sdf_model(draw, inner, place.matrix, description)
    description.text = etree.tostring(root, encoding='unicode', pretty_print=True)
    return description


def _sdf_model(draw, model, frame: np.ndarray, description: Description) -> list[str]:
    """Fill a <model> whose pose is `frame`; return the names of its links."""
    names = draw(
        st.lists(NAMES.filter(lambda name: '::' not in name), min_size=1, max_size=5, unique=True)
    )
    for name in names:
        link, place, centre = child(model, 'link', name=name), draw(ORIGINS), draw(ORIGINS)
        child(link, 'pose', words((*place.xyz, *place.rpy)))
        mass, inertial = draw(MASSES), child(link, 'inertial')
        child(inertial, 'pose', words((*centre.xyz, *centre.rpy)))
        child(inertial, 'mass', repr(mass))
        inertia = child(inertial, 'inertia')
        for key, value in _tensor(draw).items():
            child(inertia, key, value)
        description.add_mass(frame @ place.matrix, mass, centre.xyz)
        if draw(st.booleans()):
            geometry = child(child(link, 'collision', name='shape'), 'geometry')
            size = draw(st.tuples(*[LENGTHS] * 3))
            child(child(geometry, 'box'), 'size', words(size))
    description.links += len(names)
    pairs = (
        draw(
            st.lists(
                st.tuples(*[st.sampled_from(names)] * 2).filter(lambda p: p[0] != p[1]), max_size=4
            )
        )
        if len(names) > 1
        else []
    )
    for i, (parent, link) in enumerate(pairs):
        kind = draw(st.sampled_from(('fixed', 'revolute', 'prismatic', 'continuous')))
        joint = child(model, 'joint', name=f'joint {i} of {parent}', type=kind)
        child(joint, 'parent', parent)
        child(joint, 'child', link)
        if kind != 'fixed':
            child(child(joint, 'axis'), 'xyz', _axis(draw))
    return names
