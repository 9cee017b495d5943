"""Weakens the friction of what slips, before each step, by as much as belongs to its slip."""

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from ...core import Pose, Twist, Vector, rotate, subtract
from ...description import ModelSpec
from .body import Body, Place
from .client import pybullet
from .friction_axes import EVENLY, axes_along, can_slip, first_direction
from .friction_slip_compliance import NONE_SLIPS, Touch, shares, velocity_at

Slip = tuple[Vector, tuple[float, float]]  # an axis of a link, and compliances [m/s per N]


class Slipping:
    """What slips in one PyBullet world: `links` do by their surfaces, others by `set`."""

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
        self._held: dict[Place, tuple[float, ...]] = {}  # shares of friction given last

    def add(self, body: Body, spec: ModelSpec) -> None:
        """Let links slip by slip1 and slip2 of what they touch with."""
        for link in spec.links:
            for one in link.collisions:
                slips = one.surface.slip1, one.surface.slip2
                axis = first_direction(one, link)
                if any(slips) and can_slip(body, link.name, axis):
                    self.links.append((body, link.name, (axis, slips)))
                    break  # its other surfaces slip alike

    def set(self, body: Body, link: str, slip: Slip) -> None:
        """Let a link slip so from now on, whatever its surfaces say."""
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
                self._held.pop(place, None)

    def clear(self) -> None:
        """Forget all links."""
        self.links.clear()
        self._held.clear()

    def note(self) -> tuple[Any, ...]:
        """Return what `recall` takes to go back to the present state."""
        return tuple(self.links), dict(self._held)

    def recall(self, note: tuple[Any, ...]) -> None:
        """Go back to a state of the same bodies."""
        links, held = note
        whole = {place: axes.scales for body, _, _ in (*self.links, *links)
                 for place, axes in body.friction_axes.items()}
        for place in self._held:
            self._scale(place, held.get(place, whole.get(place, EVENLY)))
        self.links, self._held = list(links), dict(held)

    def weaken(
        self, body: Body, link: str, state: tuple[Pose, Twist], axle: Vector,
        slips: tuple[float, float], step_size: float,
    ) -> None:
        """Leave a link so much friction for the next step; as `links` has it."""
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
            self._scale(place, tuple(
                scale * (along if is_axle else ahead)
                for is_axle, scale in zip(axes_along(axes, axle), axes.scales, strict=True)
            ))

    def _scale(self, place: Place, scales: tuple[float, ...]) -> None:
        self._held[place] = scales
        self._scale_friction(place, scales)

    def _touches(self, place: Place, origin: Vector, twist: Twist) -> Iterator[Touch]:
        """Yield the contacts of a part of a link in the last step."""
        number, index = place
        client = self._client
        points = pybullet.getContactPoints(number, linkIndexA=index, physicsClientId=client)
        # PyBullet reports friction on the first body of a pair, normals on the one it is asked for.
        as_second = {point[6] for point in pybullet.getContactPoints(
            bodyB=number, linkIndexB=index, physicsClientId=client)} if points else ()
        for point in points:
            other, spot, normal, load = (point[2], point[4]), point[5], point[7], point[9]
            along, one, across, two = point[10:14]
            sign = -1.0 if spot in as_second else 1.0
            x, y, z = (sign * (along * a + across * b) for a, b in zip(one, two, strict=True))
            own = velocity_at(spot, origin, *twist)
            mu = (pybullet.getDynamicsInfo(*each, client)[1] for each in (place, other))
            yield Touch(
                spot, normal, load, (x, y, z), subtract(own, self._velocity(*other, spot)),
                load * math.prod(mu),
            )

    def _velocity(self, number: int, index: int, place: Vector) -> Vector:
        """Return the velocity of what PyBullet calls so, at a place."""
        if index < 0:
            com, _ = pybullet.getBasePositionAndOrientation(number, self._client)
            return velocity_at(place, com, *pybullet.getBaseVelocity(number, self._client))
        state = pybullet.getLinkState(number, index, 1, 1, self._client)
        return velocity_at(place, state[0], state[6], state[7])
