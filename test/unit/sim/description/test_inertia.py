"""Mass properties: principal axes, sums, and valid inertia tensors."""

import math

import numpy as np
import pytest

from rosbots_description.sim.core.transforms import (
    IDENTITY,
    NO_ROTATION,
    Pose,
    compose,
    from_rpy,
    rotate,
)
from rosbots_description.sim.description import inertia
from rosbots_description.sim.description.inertia import (
    STAND_IN_RADIUS,
    is_balanced,
    is_positive,
    merge,
    mobility,
    possible,
    principal_axes,
    regularised,
    rounded,
    tensor,
)
from rosbots_description.sim.description.model_spec import (
    PRISMATIC,
    REVOLUTE,
    Inertial,
    JointSpec,
    LinkSpec,
)


def in_link_axes(moments, axes):
    turn = np.array([rotate(axes, axis) for axis in np.eye(3).tolist()]).T
    return turn @ np.diag(moments) @ turn.T


def test_diagonal_tensor_keeps_its_axes_and_order():
    turned = from_rpy(0.1, 0.2, 0.3)
    inertial = Inertial(1.0, Pose(orientation=turned), ixx=3.0, iyy=1.0, izz=2.0)
    assert principal_axes(inertial) == ((3.0, 1.0, 2.0), turned)


def with_tensor(full, mass=1.0, pose=IDENTITY):
    return Inertial(
        mass,
        pose,
        ixx=full[0, 0],
        iyy=full[1, 1],
        izz=full[2, 2],
        ixy=full[0, 1],
        ixz=full[0, 2],
        iyz=full[1, 2],
    )


def random_tensor(seed):
    root = np.random.default_rng(seed).normal(size=(3, 3))
    return root @ root.T


@pytest.mark.parametrize('full', map(random_tensor, range(20)))
def test_principal_axes_and_moments_reproduce_the_tensor(full):
    moments, axes = principal_axes(with_tensor(full))
    assert math.isclose(math.hypot(*axes), 1.0)
    np.testing.assert_allclose(in_link_axes(moments, axes), full, atol=1e-12)
    near = sorted(rotate(axes, axis)[i] for i, axis in enumerate(np.eye(3).tolist()))
    assert near[0] + near[1] >= -1e-12  # otherwise those two, reversed, were nearer


@pytest.mark.parametrize('product', ['ixy', 'ixz', 'iyz'])
@pytest.mark.parametrize('size', [1e-6, -1e-6])
@pytest.mark.parametrize('moments', [(3.0, 1.0, 2.0), (1.0, 2.0, 3.0), (3.0, 2.0, 1.0)])
def test_small_product_of_inertia_rotates_the_axes_slightly(product, size, moments):
    diagonal = dict(zip(('ixx', 'iyy', 'izz'), moments, strict=True))
    _, axes = principal_axes(Inertial(1.0, **diagonal, **{product: size}))
    assert axes[3] > 0.999999


def test_the_axes_are_given_in_the_links_frame():
    turned = Pose(orientation=from_rpy(0.0, 0.0, math.pi / 2))
    inertial = Inertial(1.0, turned, ixx=2.0, iyy=2.0, izz=5.0, ixz=1.0)
    moments, axes = principal_axes(inertial)
    # A quarter turn about z maps the product xz to yz.
    expected = [[2.0, 0.0, 0.0], [0.0, 2.0, 1.0], [0.0, 1.0, 5.0]]
    np.testing.assert_allclose(in_link_axes(moments, axes), expected, atol=1e-12)


def test_single_part_in_place_is_unchanged():
    part = Inertial(1.0, Pose((1.0, 2.0, 3.0), from_rpy(0.1, 0.0, 0.0)), ixx=1.0, iyy=2.0, izz=3.0)
    assert merge([(IDENTITY, part)]) is part


def test_zero_inertia_becomes_that_of_a_ball():
    ball = 0.4 * 2.0 * STAND_IN_RADIUS**2
    turned = regularised(Inertial(2.0))
    assert (turned.ixx, turned.iyy, turned.izz) == (ball, ball, ball)


def test_unphysical_tensor_becomes_the_nearest_physical_one():
    rosbot = Inertial(1.0, ixx=0.01, iyy=0.01, izz=0.01, ixy=0.01, ixz=0.01, iyz=0.01)
    nearest = tensor(possible(rosbot))
    # Moments (0.03, 0, 0) become (0.02, 0.01, 0.01): those of a rod, about the same axes.
    np.testing.assert_allclose(np.linalg.eigvalsh(nearest), (0.01, 0.01, 0.02), rtol=1e-9)
    np.testing.assert_allclose(nearest @ np.ones(3), 0.02 * np.ones(3), rtol=1e-9)


@pytest.mark.parametrize('seed', range(20))
def test_no_physical_tensor_is_nearer_than_the_one_used(seed):
    random = np.random.default_rng(seed)
    root = random.normal(size=(3, 3))
    full = root + root.T  # usually indefinite
    used = tensor(possible(with_tensor(full)))
    moments = np.linalg.eigvalsh(used)
    assert moments[2] <= moments[0] + moments[1] + 1e-9
    distance = np.linalg.norm(used - full)
    for _ in range(200):
        step = random.normal(size=(3, 3)) * random.choice([1e-3, 0.1, 1.0])
        second = np.trace(used) / 2 * np.eye(3) - used  # positive semidefinite for a physical body
        values, axes = np.linalg.eigh(second + step + step.T)
        second = axes @ np.diag(np.maximum(values, 0.0)) @ axes.T
        other = np.trace(second) * np.eye(3) - second
        assert np.linalg.norm(other - full) >= distance - 1e-9


@pytest.mark.parametrize(
    'moments',
    [
        (1.0, 1.0, 2.0),  # a flat disc
        (0.12, 0.24, 0.39),  # a plate of 0.125, 0.235 and 0.36, written with two digits
        (1.0, 1.0, 0.0),  # a rod
    ],
)
def test_tensor_physical_up_to_rounding_is_unchanged(moments):
    given = Inertial(1.0, ixx=moments[0], iyy=moments[1], izz=moments[2])
    assert possible(given) is given


def test_excess_beyond_rounding_is_corrected():
    assert possible(Inertial(1.0, ixx=1.0, iyy=1.0, izz=2.22)).izz == 2.22
    assert possible(Inertial(1.0, ixx=1.0, iyy=1.0, izz=2.23)).izz < 2.23


def test_negative_principal_moment_is_detected():
    assert not is_positive(Inertial(1.0, ixx=1.0, iyy=1.0, izz=1.0, ixy=2.0))
    assert is_positive(Inertial(1.0, ixx=1.0, iyy=1.0, izz=1.0, ixy=1.0))


@pytest.mark.parametrize(
    ('inertial', 'joint_type', 'balanced'),
    [
        (Inertial(1.0, Pose((0.0, 0.0, 0.3)), ixx=1.0, iyy=1.0, izz=2.0), REVOLUTE, True),
        (Inertial(1.0, Pose((0.0, 0.0, 0.3)), ixx=1.0, iyy=1.0, izz=2.0), PRISMATIC, False),
        (Inertial(1.0, Pose((0.3, 0.0, 0.0)), ixx=1.0, iyy=1.0, izz=2.0), REVOLUTE, False),
        (Inertial(1.0, IDENTITY, ixx=1.0, iyy=1.2, izz=2.0), REVOLUTE, False),
        (Inertial(1.0, IDENTITY, ixx=1.0, iyy=1.0, izz=2.0, ixz=0.1), REVOLUTE, False),
        (
            Inertial(1.0, Pose(orientation=from_rpy(0.0, 1.0, 0.0)), ixx=1.0, iyy=1.0, izz=2.0),
            REVOLUTE,
            False,
        ),
        # The same for a wheel of 5 cm: its imbalance counts relative to its moment about the axis.
        (Inertial(0.1, Pose((0.0, 0.0, 0.3)), ixx=6e-5, iyy=6e-5, izz=1.2e-4), REVOLUTE, True),
        (Inertial(0.1, IDENTITY, ixx=6e-5, iyy=8e-5, izz=1.2e-4), REVOLUTE, False),
        (Inertial(0.1, Pose((0.02, 0.0, 0.0)), ixx=6e-5, iyy=6e-5, izz=1.2e-4), REVOLUTE, False),
        # It may be out of balance by 2 % of the moment about the axis.
        (Inertial(1.0, Pose((0.199, 0.0, 0.0)), ixx=1.0, iyy=1.0, izz=2.0), REVOLUTE, True),
        (Inertial(1.0, Pose((0.0, 0.201, 0.0)), ixx=1.0, iyy=1.0, izz=2.0), REVOLUTE, False),
        (Inertial(1.0, IDENTITY, ixx=1.0, iyy=1.0, izz=2.0, iyz=0.028), REVOLUTE, True),
        (Inertial(1.0, IDENTITY, ixx=1.0, iyy=1.0, izz=2.0, iyz=0.029), REVOLUTE, False),
    ],
)
def test_a_wheel_is_balanced_and_a_lever_is_not(inertial, joint_type, balanced):
    assert is_balanced(inertial, JointSpec('j', joint_type, 'a', 'b')) == balanced


def test_a_wheel_is_balanced_about_the_axis_of_its_joint_not_of_its_link():
    wheel = Inertial(1.0, Pose((0.3, -0.2, 5.0)), ixx=1.0, iyy=1.0, izz=2.0)
    on, off = (
        JointSpec('j', REVOLUTE, 'a', 'b', pose=Pose(place))
        for place in ((0.3, -0.2, 0.1), (-0.3, 0.2, 0.1))
    )
    assert is_balanced(wheel, on)
    assert not is_balanced(wheel, off)


def points_at(seed):
    """Return masses (n,) and places (n, 3) of some points of a body."""
    random = np.random.default_rng(seed)
    return random.uniform(0.1, 1.0, 5), random.normal(size=(5, 3))


def inertial_of(masses, places):
    """Return the mass properties of points in the axes of their frame, by their definition."""
    centre = masses @ places / masses.sum()
    apart = places - centre
    second = (masses[:, None] * apart).T @ apart
    full = np.trace(second) * np.eye(3) - second
    return with_tensor(full, float(masses.sum()), Pose(tuple(centre.tolist())))


def moved(pose, places):
    return np.array([compose(pose, Pose(tuple(place))).position for place in places.tolist()])


def assert_equal(one, other):
    assert one.mass == pytest.approx(other.mass)
    assert one.pose.position == pytest.approx(other.pose.position)
    assert one.pose.orientation == other.pose.orientation == NO_ROTATION
    np.testing.assert_allclose(tensor(one), tensor(other), rtol=1e-9, atol=1e-9)


def test_parts_weigh_together_what_their_points_do():
    poses = [
        Pose((1.0, -2.0, 0.5), from_rpy(0.3, 0.2, 0.1)),
        Pose((-1.0, 0.0, 3.0), from_rpy(2.0, -1.0, 0.5)),
        IDENTITY,
    ]
    bodies = [points_at(seed) for seed in range(3)]
    merged = merge([(pose, inertial_of(*body)) for pose, body in zip(poses, bodies, strict=True)])
    assert_equal(
        merged,
        inertial_of(
            np.concatenate([masses for masses, _ in bodies]),
            np.concatenate(
                [moved(pose, places) for pose, (_, places) in zip(poses, bodies, strict=True)]
            ),
        ),
    )


def test_all_of_a_tensor_is_rotated_into_link_axes():
    masses, places = points_at(7)
    own = inertial_of(masses, places - masses @ places / masses.sum())
    pose = Pose((0.1, 0.2, 0.3), from_rpy(0.4, -0.5, 2.0))
    turned = inertia.in_link_axes(
        Inertial(own.mass, pose, own.ixx, own.iyy, own.izz, own.ixy, own.ixz, own.iyz)
    )
    assert_equal(turned, inertial_of(masses, moved(pose, places - masses @ places / masses.sum())))


def test_wrench_at_a_point_accelerates_a_free_link_by_newton_and_euler():
    own = Inertial(2.0, Pose((0.1, -0.2, 0.3), from_rpy(0.3, 0.2, 0.1)), 1.0, 2.0, 2.5, 0.1)
    link = LinkSpec('l', Pose((1.0, 2.0, 3.0), from_rpy(0.5, 0.0, -1.0)), own)
    place, turn = (0.4, 2.5, 3.3), from_rpy(0.2, -0.7, 1.5)
    com = compose(link.pose, own.pose)
    torque, force = np.array((0.3, -1.0, 2.0)), np.array((5.0, 1.0, -2.0))
    arm = np.array(rotate(turn, tuple(np.subtract(com.position, place))))  # point to centre
    axes = np.array([rotate(turn, rotate(com.orientation, axis)) for axis in np.eye(3).tolist()]).T
    spin = np.linalg.solve(axes @ tensor(own) @ axes.T, torque - np.cross(arm, force))
    linear = force / own.mass - np.cross(spin, arm)
    np.testing.assert_allclose(
        mobility(link, place, turn) @ np.concatenate((torque, force)),
        np.concatenate((spin, linear)),
        rtol=1e-9,
    )


def test_numbers_are_rounded_to_12_digits_of_the_largest_and_have_no_negative_zero():
    values = rounded(np.array([1234.567890123456, 0.1234567890123456, -1e-20]))
    assert values.tolist() == [1234.56789012, 0.12345679, 0.0]
    assert math.copysign(1.0, values[2]) == 1.0
    assert rounded(np.zeros(3)).tolist() == [0.0, 0.0, 0.0]


@pytest.mark.parametrize(('least', 'expected'), [(-0.9e-9, True), (-1.1e-9, False)])
def test_a_moment_is_negative_beyond_a_billionth_of_the_greatest(least, expected):
    given = Inertial(1.0, ixx=2.0, iyy=2.0, izz=2.0 * least)
    assert is_positive(given) == expected
    assert (possible(given) is given) == expected


@pytest.mark.parametrize(('moment', 'is_kept'), [(2.1e-12, True), (1.9e-12, False)])
def test_a_moment_below_that_of_a_radius_of_a_micrometre_counts_as_zero(moment, is_kept):
    used = regularised(Inertial(2.0, ixx=1.0, iyy=1.0, izz=moment))
    assert used.izz == (moment if is_kept else 0.4 * 2.0 * 0.1**2)
    assert (used.ixx, used.iyy) == (1.0, 1.0)
