"""The <physics> and <gravity> of a world, in the current form and in that of SDF 1.3."""

from dataclasses import fields
from typing import Any

from lxml import etree

from ...core import SimError, fault
from ...description import PhysicsSettings, check_physics
from ..xml import scalar, tag_of
from .document import SdfDocument
from .values import number_of, numbers_of

# Paths of each setting in <physics>; the first one found counts, those of older versions come last.
PATHS: dict[str, tuple[str, ...]] = {
    'step_size': ('max_step_size', 'ode/solver/dt'),
    'max_update_rate': ('real_time_update_rate', 'update_rate'),
    'gravity': ('gravity',),
    'max_contacts': ('max_contacts', 'ode/max_contacts'),
    'sor_pgs_precon_iters': ('ode/solver/precon_iters',),
    'sor_pgs_iters': ('ode/solver/iters',),
    'sor_pgs_w': ('ode/solver/sor',),
    'cfm': ('ode/constraints/cfm',),
    'erp': ('ode/constraints/erp',),
    'contact_surface_layer': ('ode/constraints/contact_surface_layer',),
    'contact_max_correcting_vel': ('ode/constraints/contact_max_correcting_vel',),
}
FRICTION = 'ode/solver/friction_model'
_PYRAMID, CONE = 'pyramid_model', 'cone_model'
_READ = ('max_step_size', 'real_time_update_rate', 'update_rate', 'gravity', 'max_contacts', 'ode')
# The rate only limits the speed of the simulation; the solvers' settings have no counterpart here.
_IDLE = ('real_time_factor', 'bullet', 'simbody', 'dart')
_ODE_IDLE = (
    'type',
    'min_step_size',
    'use_dynamic_moi_rescaling',
    'thread_position_correction',
    'island_threads',
)


def read_physics(document: SdfDocument, world: etree._Element) -> PhysicsSettings:
    """Return the settings of the <physics> that counts: the default one, else the first.

    Raises:
        ModelError: a setting is not a number, or out of range.
    """
    settings: dict[str, Any] = {}  # by field
    gravity = world.find('gravity')
    if gravity is not None and scalar(gravity):
        settings |= _setting(world, 'gravity', gravity, 'gravity')
    choices = world.findall('physics')
    if not choices:
        return PhysicsSettings(**settings)
    chosen = next((p for p in choices if p.get('default') in ('1', 'true')), choices[0])
    _check(document, chosen)
    for field in fields(PhysicsSettings):
        for path in PATHS.get(field.name, ()):
            element = chosen.find(path)
            if element is not None and scalar(element) and field.name not in settings:
                settings |= _setting(chosen, path, element, field.name)
    friction = chosen.find(FRICTION)
    model = _PYRAMID if friction is None else (friction.text or '').strip()
    if friction is not None and model not in (_PYRAMID, CONE):
        document.notes.warn(
            friction, f"friction_model '{model}' is not supported; {_PYRAMID} is used"
        )
    return PhysicsSettings(**settings, friction_cone=model == CONE)


def _check(document: SdfDocument, physics: etree._Element) -> None:
    notes = document.notes
    kind = physics.get('type', 'ode')
    if kind != 'ode':
        notes.warn(physics, f"physics type '{kind}' is not available; PyBullet is used")
    notes.check(physics, _READ, _IDLE)
    for path, read in (
        ('ode', ('solver', 'constraints', 'max_contacts')),
        ('ode/solver', ('dt', 'precon_iters', 'iters', 'sor', 'friction_model')),
        ('ode/constraints', ('cfm', 'erp', 'contact_surface_layer', 'contact_max_correcting_vel')),
    ):
        part = physics.find(path)
        if part is not None:
            notes.check(part, read, _ODE_IDLE)


def _setting(
    physics: etree._Element, path: str, element: etree._Element, name: str
) -> dict[str, Any]:
    """Return a field with its value; values out of range are rejected, as by the services."""
    default = getattr(PhysicsSettings(), name)
    setting: dict[str, Any] = {}
    if isinstance(default, tuple):
        setting[name] = numbers_of(physics, path, default)
    else:
        number = number_of(physics, path, 0.0)
        setting[name] = round(number) if isinstance(default, int) else number
    try:
        check_physics(PhysicsSettings(**setting))
    except SimError as error:
        raise fault(element, f'<{tag_of(element)}> is wrong: {error}') from None
    return setting
