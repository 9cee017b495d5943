"""Wheel slip: tyres with a slip proportional to their rolling speed.

Tags and meaning are those of libgazebo_ros_wheel_slip.so in gazebo_ros_pkgs 2.9.2: a tyre of rim
speed v under friction force F and normal force N slips at v C F / N, with C the lateral slip
compliance along its axle and the longitudinal one ahead.
"""

import logging
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from ...core import Fault, PluginError, parse_number, report
from ...description import Element
from ...plugin_registry import register
from ..base import PeriodicPlugin
from ..wheel_geometry import radius_of

if TYPE_CHECKING:
    from ...runtime import Joint

NUMBERS = (
    'slip_compliance_lateral',
    'slip_compliance_longitudinal',
    'wheel_normal_force',
    'wheel_radius',
)


@dataclass(frozen=True)
class SlippingWheel:
    """A wheel with slip compliance."""

    joint: 'Joint'
    lateral: float  # slip compliance, relative to the rim speed
    longitudinal: float
    normal_force: float  # [N]
    radius: float  # [m]


@register('libgazebo_ros_wheel_slip.so')
class WheelSlip(PeriodicPlugin):
    """Sets the slip compliance of a model's tyres, at every step."""

    prefix = 'wheel_slip: '

    def find_namespace(self, given: str | None) -> str:
        """Return the namespace, which is below that of the model."""
        return f'{self.model.name}/{(given or "").strip("/ ") or "wheel_slip"}'

    def load(self) -> None:
        """Read the wheels; one that cannot slip is left out with an error in the log.

        Raises:
            PluginError: there is none.
        """
        self.params.ignore('wheel')
        self.wheels: list[SlippingWheel] = []
        for element in self.spec.element.children:
            if element.tag != 'wheel':
                continue
            try:
                self.wheels.append(self._wheel(element))
            except PluginError as error:
                report(Fault(f'wheel_slip: {error}; this wheel does not slip', logging.ERROR))
        if not self.wheels:
            raise PluginError('wheel_slip: there is no <wheel> that can slip')

    def set_compliance(
        self, lateral: float | None = None, longitudinal: float | None = None
    ) -> None:
        """Set the slip compliances of all wheels; None or negative: unchanged."""
        if lateral is not None and lateral >= 0.0:
            self.wheels = [replace(wheel, lateral=lateral) for wheel in self.wheels]
        if longitudinal is not None and longitudinal >= 0.0:
            self.wheels = [replace(wheel, longitudinal=longitudinal) for wheel in self.wheels]

    def update(self, _elapsed: float) -> None:
        """Set the slip compliance of each tyre according to its speed."""
        for wheel in self.wheels:
            slip = abs(wheel.joint.velocity) * wheel.radius / wheel.normal_force
            slips = slip * wheel.lateral, slip * wheel.longitudinal
            spec = wheel.joint.spec
            self.model.links[spec.child].set_slip_compliance(spec.axis_in_child, slips)

    def _wheel(self, element: Element) -> SlippingWheel:
        name = element.attributes.get('link_name', '')
        link = self.model.links.get(name)
        if link is None:
            known = ', '.join(self.model.links)
            raise PluginError(
                f"line {element.line}: <wheel link_name='{name}'> is no link of "
                f"'{self.model.name}'; its links: {known}"
            )
        joint = next((one for one in self.model.joints.values() if one.spec.child == name), None)
        if joint is None:
            raise PluginError(f"<wheel link_name='{name}'>: no joint turns this link")
        numbers = {tag: _number(element, name, tag) for tag in NUMBERS}
        radius = numbers['wheel_radius'] or radius_of(joint) or 0.0
        for tag, value in (('wheel_radius', radius), ('wheel_normal_force', numbers[NUMBERS[2]])):
            if value <= 0.0:
                raise PluginError(f"<wheel link_name='{name}'>: <{tag}> must be above 0")
        if not link.can_slip(joint.spec.axis_in_child):
            raise PluginError(
                f"<wheel link_name='{name}'>: its axle is no principal axis of its inertia, and "
                'the engine can scale friction along these axes only'
            )
        lateral, longitudinal = (max(0.0, numbers[tag]) for tag in NUMBERS[:2])
        return SlippingWheel(joint, lateral, longitudinal, numbers['wheel_normal_force'], radius)


def _number(element: Element, name: str, tag: str) -> float:
    child = element.child(tag)
    if child is None:
        return 0.0
    value = parse_number(child.text)
    if value is None:
        raise PluginError(
            f"<wheel link_name='{name}'>: <{tag}> is '{child.text}'; it takes a finite number"
        )
    return value
