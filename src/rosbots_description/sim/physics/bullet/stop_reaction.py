"""Torque of a revolute joint's stop, which PyBullet's joint sensors leave out."""

from collections.abc import Iterable

from ...core import Pose, Vector, add, cross, dot, rotate, subtract
from ..engine import Contact, Wrench
from .client import pybullet

_AT_STOP = 1e-6  # [rad] from a limit


def is_at_stop(client: int, number: int, index: int) -> bool:
    """Return whether a joint, given by PyBullet's body and index, is at one of its limits."""
    lower, upper = pybullet.getJointInfo(number, index, client)[8:10]
    position = pybullet.getJointState(number, index, client)[0]
    return bool(lower <= upper and not lower + _AT_STOP < position < upper - _AT_STOP)


def links_beyond(client: int, number: int, index: int) -> list[int]:
    """Return the links that a joint carries, its child first."""
    found = {index}
    for link in range(index + 1, pybullet.getNumJoints(number, client)):  # parents come first
        if pybullet.getJointInfo(number, link, client)[16] in found:
            found.add(link)
    return sorted(found)


def with_stop(
    client: int,
    number: int,
    links: list[int],
    frame: Pose,
    axis: Vector,
    measured: Wrench,
    contacts: Iterable[Contact],
) -> Wrench:
    """Return the reaction of a joint at its stop, with its whole torque about the axis.

    The measured force F is complete. As the links beyond the joint do not turn relative to the
    parent, F and the contact forces f act through their common centre of mass c: about the axis,
    the torque is (c - o) x (F + sum f) - sum (p - o) x f. The angular acceleration of the parent
    is neglected.

    Args:
        links: that the joint carries.
        frame: of the joint's child, in which `axis` and `measured` are.
        contacts: of these links.
    """
    mass, moment = 0.0, (0.0, 0.0, 0.0)
    for link in links:
        share = pybullet.getDynamicsInfo(number, link, client)[0]
        x, y, z = pybullet.getLinkState(
            number, link, computeForwardKinematics=True, physicsClientId=client
        )[0]
        mass, moment = mass + share, add(moment, (share * x, share * y, share * z))
    if not mass:
        return measured
    x, y, z = moment
    lever = subtract((x / mass, y / mass, z / mass), frame.position)
    force, torque = rotate(frame.orientation, measured.force), (0.0, 0.0, 0.0)
    for contact in contacts:
        force = add(force, contact.force)
        torque = subtract(torque, cross(subtract(contact.position, frame.position), contact.force))
    torque = add(torque, cross(lever, force))
    missing = dot(torque, rotate(frame.orientation, axis)) - dot(measured.torque, axis)
    x, y, z = axis
    return Wrench(measured.force, add(measured.torque, (missing * x, missing * y, missing * z)))
