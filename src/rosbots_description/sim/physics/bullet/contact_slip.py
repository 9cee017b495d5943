"""Weakens the friction of what slips, before each step, by as much as belongs to its slip."""

import math
from collections.abc import Callable, Iterator, Sequence

from ...core import Pose, Twist, Vector, rotate, subtract
from ...description import ModelSpec
from .body import Body, Place
from .client import pybullet
from .friction_axes import axes_along, can_slip, first_direction
from .slip_compliance import NONE_SLIPS, Touch, shares, velocity_at

Slip = tuple[Vector, tuple[float, float]]  # an axis of a link, and compliances [m/s per N]


class Slipping:
    """What slips in one PyBullet world: `links` do by their surfaces, others when they are told."""

    def __init__(
        self,
        client: int,
        scale_friction: Callable[[Place, Sequence[float]], None],
        reach: Callable[[Vector], float],
    ) -> None:
        """Work in the world of that PyBullet client.

        Args:
            scale_friction: lets a part hold shares of its friction along its axes.
            reach: how many times its limit friction can hold in a direction.
        """
        self._client, self._scale_friction, self._reach = client, scale_friction, reach
        self.links: list[tuple[Body, str, Slip]] = []

    def add(self, body: Body, spec: ModelSpec) -> None:
        """Let links slip by slip1 and slip2 of what they touch with."""
        for link in spec.links:
            for one in link.collisions:
                slips = one.surface.slip1, one.surface.slip2
                axis = first_direction(one, link)
                if any(slips) and can_slip(body, link.name, axis):
                    self.links.append((body, link.name, (axis, slips)))
                    break  # its other surfaces slip alike

    def remove(self, body: Body) -> None:
        """Forget the links of a body."""
        self.links = [link for link in self.links if link[0] is not body]

    def clear(self) -> None:
        """Forget all links."""
        self.links.clear()

    def weaken(
        self, body: Body, link: str, state: tuple[Pose, Twist], axle: Vector,
        slips: tuple[float, float], step_size: float,
    ) -> None:
        """Leave a link so much friction for the next step; arguments as for `Engine.let_slip`."""
        pose, twist = state
        for place in body.surfaces[link]:
            held = NONE_SLIPS if not any(slips) else shares(
                self._touches(place, pose.position, twist), rotate(pose.orientation, axle), slips,
                step_size, self._reach,
            )
            if held is None:
                continue
            axes = body.friction_axes[place]
            along, ahead = held
            self._scale_friction(place, [
                scale * (along if is_axle else ahead)
                for is_axle, scale in zip(axes_along(axes, axle), axes.scales, strict=True)
            ])

    def _touches(self, place: Place, origin: Vector, twist: Twist) -> Iterator[Touch]:
        """Yield the contacts of a part of a link in the last step."""
        number, index = place
        client = self._client
        for point in pybullet.getContactPoints(number, linkIndexA=index, physicsClientId=client):
            other, spot, normal, load = (point[2], point[4]), point[5], point[7], point[9]
            first, one, second, two = point[10:14]
            force = (first * a + second * b for a, b in zip(one, two, strict=True))
            own = velocity_at(spot, origin, *twist)
            mu = (pybullet.getDynamicsInfo(*each, client)[1] for each in (place, other))
            yield Touch(
                spot, normal, load, tuple(force), subtract(own, self._velocity(*other, spot)),
                load * math.prod(mu),
            )

    def _velocity(self, number: int, index: int, place: Vector) -> Vector:
        """Return the velocity of what PyBullet calls so, at a place."""
        if index < 0:
            com, _ = pybullet.getBasePositionAndOrientation(number, self._client)
            return velocity_at(place, com, *pybullet.getBaseVelocity(number, self._client))
        state = pybullet.getLinkState(number, index, 1, 1, self._client)
        return velocity_at(place, state[0], state[6], state[7])
