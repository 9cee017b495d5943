"""Models and links in words and numbers, as HTML."""

from collections.abc import Iterable, Sequence

from ...sim.core import Pose, Twist, Vector, to_rpy
from ...sim.description import (
    Box,
    Collision,
    Cylinder,
    Geometry,
    JointSpec,
    Mesh,
    Plane,
    ShownLink,
    ShownModel,
    Sphere,
)
from .text import STYLE, markup, table

MOST = 100  # parts of one kind that are listed


def scoped_name(*parts: str | None) -> str:
    """Return a name as services know it, of a model and what is in it."""
    return '::'.join(part for part in parts if part is not None)


def chosen_links(model: ShownModel, link: str | None) -> list[ShownLink]:
    """Return the link of that name, or all links for None."""
    return [one for one in model.links if link in (None, one.name)]


def friction(links: Iterable[ShownLink]) -> set[tuple[float, float]]:
    """Return the different pairs of mu and mu2 of the collisions of links."""
    return {(one.surface.mu, one.surface.mu2) for link in links for one in link.collisions}


def state_html(model: ShownModel, link: str | None, pose: Pose, twist: Twist | None) -> str:
    """Return a table of the state [m, rad, m/s, rad/s] and the mass properties."""
    links = chosen_links(model, link)
    rows = [
        ('Position [m]', _three(pose.position)),
        ('Roll, pitch, yaw [rad]', _three(to_rpy(pose.orientation))),
    ]
    if model.static:
        rows.append(('Mass [kg]', 'static'))
    else:
        rows += [
            ('Velocity [m/s]', _three(twist.linear) if twist else ''),
            ('Turning [rad/s]', _three(twist.angular) if twist else ''),
            ('Mass [kg]', f'{sum(one.inertial.mass for one in links if one.inertial):.4g}'),
        ]
    pairs = friction(links)
    if len(pairs) == 1:
        ((mu, mu2),) = pairs
        rows.append(('Friction mu, mu2', f'{mu:.4g}, {mu2:.4g}'))
    elif pairs:
        rows.append(('Friction', 'each collision has its own'))
    title = markup(scoped_name(model.name, link))
    return f'<div style="{STYLE}"><b>{title}</b>{table(rows)}</div>'


def parts_html(model: ShownModel, link: str | None, omissions: Sequence[str] = ()) -> str:
    """Return lists of joints, collisions and sensors, of the model or of one link.

    Args:
        omissions: parts that the model was spawned without.
    """
    links = chosen_links(model, link)
    joints = [_joint(one) for one in model.joints if link in (None, one.parent, one.child)]
    collisions = [_collision(one) for part in links for one in part.collisions]
    sensors = [f'{markup(one.name)}: {markup(one.type)}' for part in links for one in part.sensors]
    return (
        list_html('Spawned without', list(map(markup, omissions)))
        + list_html('Joints', joints)
        + list_html('Collisions', collisions)
        + list_html('Sensors', sensors)
    )


def list_html(title: str, entries: Sequence[str]) -> str:
    """Return a list that unfolds, of entries in HTML; '' without entries."""
    if not entries:
        return ''
    shown = ''.join(f'<li>{entry}</li>' for entry in entries[:MOST])
    if len(entries) > MOST:
        shown += f'<li>and {len(entries) - MOST} more</li>'
    return (
        f'<details style="{STYLE}"><summary>{title} ({len(entries)})</summary>'
        f'<ul>{shown}</ul></details>'
    )


def _joint(joint: JointSpec) -> str:
    limits = ''
    if joint.lower is not None and joint.upper is not None:
        limits = f', {joint.lower:.4g} to {joint.upper:.4g}'
    return (
        f'{markup(joint.name)}: {markup(joint.type)}{limits}, '
        f'{markup(joint.parent)} \u2192 {markup(joint.child)}'
    )


def _collision(collision: Collision) -> str:
    surface = collision.surface
    return (
        f'{markup(collision.name)}: {_shape(collision.geometry)}, '
        f'mu {surface.mu:.4g}, mu2 {surface.mu2:.4g}'
    )


def _shape(geometry: Geometry) -> str:
    match geometry:
        case Box(size):
            return 'box ' + ' x '.join(f'{one:.4g}' for one in size) + ' m'
        case Sphere(radius):
            return f'sphere, radius {radius:.4g} m'
        case Cylinder(radius, length):
            return f'cylinder, radius {radius:.4g} m, length {length:.4g} m'
        case Plane():
            return 'plane'
        case Mesh(path):
            return f'mesh {markup(path.rpartition("/")[2])}'


def _three(vector: Vector) -> str:
    return ', '.join(f'{round(one, 3) + 0.0:.3f}' for one in vector)
