"""Services about the inertial properties of links."""

from gazebo_msgs import srv
from geometry_msgs.msg import Point

from ...sim.core import MAX_LENGTH, Pose
from ...sim.description import Inertial
from ...sim.description.inertia import in_link_axes
from ...sim.runtime import set_inertial
from ..messages import RequestError, read_vector, require_finite
from ..server import Server
from .links import NO_LINK, find_link
from .registry import refuse, service

_MOMENTS = ('ixx', 'ixy', 'ixz', 'iyy', 'iyz', 'izz')
# SDF's default of a link without <inertial>, which only static models may have.
_DEFAULT = Inertial(1.0, ixx=1.0, iyy=1.0, izz=1.0)


@service('get_link_properties', srv.GetLinkProperties)
def get_link_properties(
    server: Server, request: srv.GetLinkPropertiesRequest
) -> srv.GetLinkPropertiesResponse:
    """Return mass, centre of mass and the inertia about it, in the axes of the link."""
    response = srv.GetLinkPropertiesResponse()
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


@service('set_link_properties', srv.SetLinkProperties)
def set_link_properties(
    server: Server, request: srv.SetLinkPropertiesRequest
) -> srv.SetLinkPropertiesResponse:
    """Change mass, centre of mass, inertia and gravity mode of a link; its velocity is kept.

    As in Gazebo the orientation of `com` is ignored: the tensor is in the link's axes.
    """
    require_finite(request)
    link = find_link(server.world, request.link_name)
    if link is None:
        return refuse(srv.SetLinkPropertiesResponse(), f'SetLinkProperties: {NO_LINK}')
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
    set_inertial(link, inertial, request.gravity_mode)
    return srv.SetLinkPropertiesResponse(True, 'SetLinkProperties: properties set')
