"""A body of two links in a PyBullet of its own, and its energy as mechanics gives it."""

from types import SimpleNamespace

import numpy as np

from rosbots_description.sim.core.arrays import rotation_matrix
from rosbots_description.sim.core.transforms import from_rpy
from rosbots_description.sim.physics.bullet.body import Mass, Masses
from rosbots_description.sim.physics.bullet.fast_rotation import FastBodies

DT, GRAVITY = 0.002, (0.5, -1.0, -9.8)
BODY, CLIENT, GROUND, OTHER = 4, 2, 0, 7
BASE, LINK = Mass(-1, 3.0, (0.1, 0.2, 0.3), True), Mass(0, 2.0, (0.04, 0.05, 0.06), True)
POSES = {
    -1: ((1.0, 2.0, 3.0), from_rpy(0.3, -0.7, 1.1)),
    0: ((1.5, 1.0, 2.0), from_rpy(2.0, 0.4, 0.2)),
}
TWISTS = {-1: ((1.0, -2.0, 0.5), (7.0, 30.0, -4.0)), 0: ((-1.0, 3.0, 2.0), (5.0, -20.0, 9.0))}
JOINT = 0.4, 3.0, 0.0  # position [rad], velocity [rad/s], effort of its motor [N m]


BY_NAME = {'physicsClientId': CLIENT}


class Bullet:
    """PyBullet's state of one body with a link on a joint; each call is checked for the client.

    Attributes:
        touched: bodies that it touches.
    """

    def __init__(self):
        self.twists, self.joint, self.touched = dict(TWISTS), JOINT, set()

    def called(self):
        """Return the functions by the names that PyBullet gives them."""
        return SimpleNamespace(
            getBasePositionAndOrientation=self.pose,
            getBaseVelocity=self.velocity,
            getLinkStates=self.links,
            getJointStates=self.joints,
            getContactPoints=self.contacts,
            resetBaseVelocity=self.set_velocity,
            resetJointStatesMultiDof=self.set_joints,
        )

    def pose(self, number, client):
        assert (number, client) == (BODY, CLIENT)
        return POSES[-1]

    def velocity(self, number, client):
        assert (number, client) == (BODY, CLIENT)
        return self.twists[-1]

    def links(self, number, indices, velocities, forward, client):
        assert (number, velocities, forward, client) == (BODY, 1, 1, CLIENT)
        return [(*POSES[one], *[None] * 4, *self.twists[one]) for one in indices]

    def joints(self, number, joints, client):
        assert (number, client) == (BODY, CLIENT)
        position, velocity, effort = self.joint
        return [(position, velocity, None, effort) for _ in joints]

    def contacts(self, number, **client):
        assert (number, client) == (BODY, BY_NAME)
        return [(0, BODY, one) for one in (BODY, *self.touched)]  # of two links of its own, too

    def set_velocity(self, number, linear, angular, **client):
        assert (number, client) == (BODY, BY_NAME)
        self.twists[-1] = linear, angular

    def set_joints(self, number, joints, positions, velocities, **client):
        assert (number, joints, client) == (BODY, (0,), BY_NAME)
        assert positions == [[self.joint[0]]]
        self.joint = self.joint[0], velocities[0][0], self.joint[2]

    def speed_up(self, factor):
        """Scale all velocities relative to the centre of mass, and those of joints."""
        drift = drift_of(self.twists)
        for index, (linear, angular) in self.twists.items():
            self.twists[index] = (
                tuple(drift + factor * (np.array(linear) - drift)),
                tuple(factor * np.array(angular)),
            )


def drift_of(twists):
    """Return the velocity of the centre of mass [m/s]."""
    return (BASE.mass * np.array(twists[-1][0]) + LINK.mass * np.array(twists[0][0])) / (
        BASE.mass + LINK.mass
    )


def energies_of(twists, gravity=GRAVITY):
    """Return total energy, and the kinetic one about the centre of mass [J]: half a step ago."""
    potential, kinetic = 0.0, 0.0
    for part in (BASE, LINK):
        (position, turn), (linear, angular) = POSES[part.link], twists[part.link]
        middle = np.array(position) - np.array(linear) * DT / 2.0
        potential -= part.mass * float(np.dot(gravity, middle))
        turning = rotation_matrix(turn).T @ angular
        kinetic += 0.5 * part.mass * float(np.dot(linear, linear)) + 0.5 * sum(
            moment * rate**2 for moment, rate in zip(part.moments, turning, strict=True)
        )
    drift = drift_of(twists)
    carried = 0.5 * (BASE.mass + LINK.mass) * float(drift @ drift)
    return potential + kinetic, kinetic - carried


def masses(stiffness=0.0, damping=0.0, reference=0.0, is_fixed=False, unbalanced=(0,)):
    return Masses(
        (BASE, LINK), (0,), (damping,), (stiffness,), (reference,), (1e-6,), unbalanced, is_fixed
    )


SINGLE = Masses((Mass(-1, 1.0, (0.1, 0.2, 0.3), True),), (), (), (), (), (), (), False)


def watched(of, *others):
    """Return the fast bodies of a world in which that body is one; it is found to be fast."""
    bodies = FastBodies(CLIENT)
    bodies.set(DT, GRAVITY)
    bodies.add({BODY: of, **dict.fromkeys(others, Masses((), (), (), (), (), (), (), False))})
    bodies._update_body(BODY, of, 100.0)
    return bodies


def noted(bodies):
    """Return peak of the kinetic energy, limit and total energy [J] of the body, and its flight."""
    peak, limit, is_airborne, total, _ = bodies.save_state()[1][BODY]
    return peak, limit, total, is_airborne
