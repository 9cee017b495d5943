"""Services about lights, by which cameras see; RViz has a light of its own."""

from dataclasses import replace

from gazebo_msgs import srv
from std_msgs.msg import ColorRGBA

from ...sim.description import Colour
from ..messages import read_pose, read_vector, require_finite
from ..server import Server
from .registry import refuse, service

_ATTENUATION = ('attenuation_constant', 'attenuation_linear', 'attenuation_quadratic')


@service('get_light_properties', srv.GetLightProperties)
def get_light_properties(
    server: Server, request: srv.GetLightPropertiesRequest
) -> srv.GetLightPropertiesResponse:
    """Return a light's diffuse colour and attenuation."""
    response = srv.GetLightPropertiesResponse()
    light = server.world.lights.get(request.light_name)
    if light is None:
        text = f'getLightProperties: Requested light {request.light_name} not found!'
        return refuse(response, text)
    response.diffuse = ColorRGBA(*light.diffuse)
    for name in _ATTENUATION:
        setattr(response, name, getattr(light, name))
    response.success = True
    return response


@service('set_light_properties', srv.SetLightProperties)
def set_light_properties(
    server: Server, request: srv.SetLightPropertiesRequest
) -> srv.SetLightPropertiesResponse:
    """Change a light; every field is used, zeros included."""
    require_finite(request)
    lights, name = server.world.lights, request.light_name
    if name not in lights:
        text = f'setLightProperties: Requested light {name} not found!'
        return refuse(srv.SetLightPropertiesResponse(), text)
    lights[name] = replace(
        lights[name],
        cast_shadows=request.cast_shadows,
        diffuse=_read_colour(request.diffuse),
        specular=_read_colour(request.specular),
        direction=read_vector(request.direction),
        pose=read_pose(request.pose),
        **{field: getattr(request, field) for field in _ATTENUATION},
    )
    return srv.SetLightPropertiesResponse(success=True)


@service('delete_light', srv.DeleteLight)
def delete_light(server: Server, request: srv.DeleteLightRequest) -> srv.DeleteLightResponse:
    """Delete a light; an unknown name gets Gazebo's text, but at once."""
    name = request.light_name
    if server.world.lights.pop(name, None) is None:
        text = f'DeleteLight: Timeout reached while removing light "{name}"'
        return refuse(srv.DeleteLightResponse(), text)
    return srv.DeleteLightResponse(True, f'DeleteLight: {name} successfully deleted')


def _read_colour(message: ColorRGBA) -> Colour:
    return (message.r, message.g, message.b, message.a)
