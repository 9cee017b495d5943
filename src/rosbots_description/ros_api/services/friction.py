"""Services about the friction of collisions, which Gazebo does not have."""

from rosbots_msgs import srv

from ...sim.runtime import collisions_named
from ...sim.runtime import set_friction as set_world_friction
from ..messages import require_finite
from ..server import Server
from .registry import EXTENSIONS, service


@service('get_friction', srv.GetFriction, table=EXTENSIONS)
def get_friction(server: Server, request: srv.GetFrictionRequest) -> srv.GetFrictionResponse:
    """Return the friction coefficients of the collisions of a model, a link, or of one."""
    found = collisions_named(server.world, request.name)
    surfaces = [frame.spec.surface for frame in found]
    return srv.GetFrictionResponse(
        True,
        'GetFriction: got friction',
        [frame.scoped_name for frame in found],
        [surface.mu for surface in surfaces],
        [surface.mu2 for surface in surfaces],
    )


@service('set_friction', srv.SetFriction, table=EXTENSIONS)
def set_friction(server: Server, request: srv.SetFrictionRequest) -> srv.SetFrictionResponse:
    """Change the friction coefficients of those collisions; the motion stays."""
    require_finite(request)
    set_world_friction(server.world, request.name, request.mu, request.mu2)
    return srv.SetFrictionResponse(True, 'SetFriction: friction set')
