"""Scales the friction of links with slip compliance before each step."""

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from ...core import Pose, Twist, Vector, rotate, subtract
from ...description import ModelSpec
from .body import Body, Place
from .client import pybullet
from .friction_axes import ISOTROPIC, axes_along, can_slip, first_direction
from .friction_slip_compliance import FULL_FRICTION, TyreContact, slip_scales, velocity_at

Slip = tuple[Vector, tuple[float, float]]  # an axis of a link, and compliances [m/s per N]


class SlippingLinks:
    """Links with slip compliance in one PyBullet world, from their surfaces or by `set`."""

    def __init__(
        self,
        client: int,
        scale_friction: Callable[[Place, Sequence[float]], None],
        friction_ratio: Callable[[Vector], float],
    ) -> None:
        """Work in the world of that PyBullet client.

        Args:
            scale_friction: sets the friction scales of a part along its axes.
            friction_ratio: ratio of friction to mu N possible in a direction.
        """
        self._client, self._scale_friction = client, scale_friction
        self._friction_ratio = friction_ratio
        self.links: list[tuple[Body, str, Slip]] = []
        self._scales: dict[Place, tuple[float, ...]] = {}  # friction scales set last

    def add(self, body: Body, spec: ModelSpec) -> None:
        """Add the links of a body whose surfaces have slip1 or slip2."""
        for link in spec.links:
            for one in link.collisions:
                slips = one.surface.slip1, one.surface.slip2
                axis = first_direction(one, link)
                if any(slips) and can_slip(body, link.name, axis):
                    self.links.append((body, link.name, (axis, slips)))
                    break  # applies to all surfaces of the link

    def set(self, body: Body, link: str, slip: Slip) -> None:
        """Set the slip of a link, in place of that of its surfaces."""
        entry = body, link, slip
        for i, (whose, name, _) in enumerate(self.links):
            if (whose, name) == (body, link):
                self.links[i] = entry
                return
        self.links.append(entry)

    def remove(self, body: Body) -> None:
        """Forget the links of a body."""
        self.links = [link for link in self.links if link[0] is not body]
        for places in body.surfaces.values():
            for place in places:
                self._scales.pop(place, None)

    def clear(self) -> None:
        """Forget all links."""
        self.links.clear()
        self._scales.clear()

    def save_state(self) -> tuple[Any, ...]:
        """Return the state for `restore_state`."""
        return tuple(self.links), dict(self._scales)

    def restore_state(self, saved: tuple[Any, ...]) -> None:
        """Restore the state of a note; the bodies must be the same."""
        links, scales = saved
        whole = {
            place: axes.scales
            for body, _, _ in (*self.links, *links)
            for place, axes in body.friction_axes.items()
        }
        for place in self._scales:
            self._scale(place, scales.get(place, whole.get(place, ISOTROPIC)))
        self.links, self._scales = list(links), dict(scales)

    def update_friction(
        self,
        body: Body,
        link: str,
        state: tuple[Pose, Twist],
        axle: Vector,
        slips: tuple[float, float],
        step_size: float,
    ) -> None:
        """Scale the friction of a link for the next step; arguments as in `links`."""
        pose, twist = state
        for place in body.surfaces[link]:
            scales = (
                FULL_FRICTION
                if not any(slips)
                else slip_scales(
                    self._contacts(place, pose.position, twist),
                    rotate(pose.orientation, axle),
                    slips,
                    step_size,
                    self._friction_ratio,
                )
            )
            if scales is None:
                continue
            axes = body.friction_axes[place]
            along, ahead = scales
            self._scale(
                place,
                tuple(
                    scale * (along if is_axle else ahead)
                    for is_axle, scale in zip(axes_along(axes, axle), axes.scales, strict=True)
                ),
            )

    def _scale(self, place: Place, scales: tuple[float, ...]) -> None:
        self._scales[place] = scales
        self._scale_friction(place, scales)

    def _contacts(self, place: Place, origin: Vector, twist: Twist) -> Iterator[TyreContact]:
        """Yield the contacts of a part of a link in the last step."""
        number, index = place
        client = self._client
        points = pybullet.getContactPoints(number, linkIndexA=index, physicsClientId=client)
        # PyBullet reports friction on the first body of a pair, normals on the queried one.
        as_second = (
            {
                point[6]
                for point in pybullet.getContactPoints(
                    bodyB=number, linkIndexB=index, physicsClientId=client
                )
            }
            if points
            else ()
        )
        for point in points:
            other, position, normal, load = (point[2], point[4]), point[5], point[7], point[9]
            along, one, across, two = point[10:14]
            sign = -1.0 if position in as_second else 1.0
            x, y, z = (sign * (along * a + across * b) for a, b in zip(one, two, strict=True))
            own = velocity_at(position, origin, *twist)
            mu = (pybullet.getDynamicsInfo(*each, client)[1] for each in (place, other))
            yield TyreContact(
                position,
                normal,
                load,
                (x, y, z),
                subtract(own, self._velocity(*other, position)),
                load * math.prod(mu),
            )

    def _velocity(self, number: int, index: int, place: Vector) -> Vector:
        """Return the velocity of a PyBullet body's link at a point, in the world [m/s]."""
        if index < 0:
            com, _ = pybullet.getBasePositionAndOrientation(number, self._client)
            return velocity_at(place, com, *pybullet.getBaseVelocity(number, self._client))
        state = pybullet.getLinkState(number, index, 1, 1, self._client)
        return velocity_at(place, state[0], state[6], state[7])
