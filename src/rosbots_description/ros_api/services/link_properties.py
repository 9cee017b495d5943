"""Services about the inertial properties of links."""

from dataclasses import replace

from gazebo_msgs.srv import (
    GetLinkProperties,
    GetLinkPropertiesRequest,
    GetLinkPropertiesResponse,
    SetLinkProperties,
    SetLinkPropertiesRequest,
    SetLinkPropertiesResponse,
)
from geometry_msgs.msg import Point

from ...sim.core import MAX_INERTIA, MAX_LENGTH, MAX_MASS, MIN_MASS, Pose
from ...sim.description import Inertial
from ...sim.description.inertia import in_link_axes, is_positive, regularised
from ...sim.runtime import Link
from ..messages import RequestError, read_vector, require_finite
from ..server import Server
from .links import NO_LINK, find_link
from .registry import refuse, service

_MOMENTS = ('ixx', 'ixy', 'ixz', 'iyy', 'iyz', 'izz')
# SDF's default of a link without <inertial>, which only static models may have.
_DEFAULT = Inertial(1.0, ixx=1.0, iyy=1.0, izz=1.0)


@service('get_link_properties', GetLinkProperties)
def get_link_properties(
    server: Server, request: GetLinkPropertiesRequest
) -> GetLinkPropertiesResponse:
    """Return mass, centre of mass and the inertia about it, in the axes of the link."""
    response = GetLinkPropertiesResponse()
    link = find_link(server.world, request.link_name)
    if link is None:
        return refuse(response, f'GetLinkProperties: {NO_LINK}')
    inertial = in_link_axes(link.spec.inertial or _DEFAULT)
    response.com.position = Point(*inertial.pose.position)
    response.com.orientation.w = 1.0
    response.gravity_mode, response.mass = link.spec.gravity, inertial.mass
    for name in _MOMENTS:
        setattr(response, name, getattr(inertial, name))
    response.success, response.status_message = True, 'GetLinkProperties: got properties'
    return response


@service('set_link_properties', SetLinkProperties)
def set_link_properties(
    server: Server, request: SetLinkPropertiesRequest
) -> SetLinkPropertiesResponse:
    """Change mass, centre of mass, inertia and gravity mode of a link; its velocity is kept.

    As in Gazebo the orientation of `com` is ignored: the tensor is in the link's axes.
    """
    require_finite(request)
    link = find_link(server.world, request.link_name)
    if link is None:
        return refuse(SetLinkPropertiesResponse(), f'SetLinkProperties: {NO_LINK}')
    inertial = Inertial(
        request.mass,
        Pose(read_vector(request.com.position)),
        **{name: getattr(request, name) for name in _MOMENTS},
    )
    farthest = max(inertial.pose.position, key=abs)
    if abs(farthest) > MAX_LENGTH:
        raise RequestError(
            f"com.position of link '{link.scoped_name}' is {farthest:g} m from its frame; "
            f'at most {MAX_LENGTH:g} m are accepted'
        )
    if not link.model.static:
        inertial = _movable(link, inertial)
    model = link.model
    changed = replace(link.spec, inertial=inertial, gravity=request.gravity_mode)
    links = tuple(changed if spec is link.spec else spec for spec in model.spec.links)
    model.respecify(replace(model.spec, links=links))
    return SetLinkPropertiesResponse(True, 'SetLinkProperties: properties set')


def _movable(link: Link, inertial: Inertial) -> Inertial:
    """Return an inertial that can be simulated.

    Raises:
        RequestError: mass or inertia are out of range for a moving link.

    """
    if inertial.mass <= 0.0:
        raise RequestError(
            f"mass is {inertial.mass}; link '{link.scoped_name}' moves, so it must be greater "
            'than zero [kg]'
        )
    moments = (inertial.ixx, inertial.iyy, inertial.izz, inertial.ixy, inertial.ixz, inertial.iyz)
    if not MIN_MASS <= inertial.mass <= MAX_MASS or max(map(abs, moments)) > MAX_INERTIA:
        raise RequestError(
            f"mass or inertia of link '{link.scoped_name}' is out of range: "
            f'{MIN_MASS:g} to {MAX_MASS:g} kg and at most {MAX_INERTIA:g} kg m^2 are accepted'
        )
    if not is_positive(inertial):
        raise RequestError(
            f"the inertia tensor for link '{link.scoped_name}' has a negative principal moment; "
            'give the tensor about the centre of mass [kg m^2]'
        )
    return regularised(inertial)
