"""Services about the simulation as a whole: pause, reset, world properties."""

from gazebo_msgs.srv import (
    GetWorldProperties,
    GetWorldPropertiesRequest,
    GetWorldPropertiesResponse,
)
from std_srvs.srv import Empty, EmptyRequest, EmptyResponse

from ..server import Server
from .registry import service


@service('pause_physics', Empty)
def pause_physics(server: Server, _request: EmptyRequest) -> EmptyResponse:
    """Stop simulated time; no effect while it stands."""
    server.world.paused = True
    return EmptyResponse()


@service('unpause_physics', Empty)
def unpause_physics(server: Server, _request: EmptyRequest) -> EmptyResponse:
    """Let simulated time go on; no effect while it does."""
    server.world.paused = False
    return EmptyResponse()


@service('reset_world', Empty)
def reset_world(server: Server, _request: EmptyRequest) -> EmptyResponse:
    """Bring every model back to its spawn pose, at rest; time and joint angles go on."""
    server.world.reset_world()
    return EmptyResponse()


@service('reset_simulation', Empty)
def reset_simulation(server: Server, _request: EmptyRequest) -> EmptyResponse:
    """Begin again at time zero with every model as it was spawned."""
    server.world.reset_simulation()
    return EmptyResponse()


@service('get_world_properties', GetWorldProperties)
def get_world_properties(
    server: Server, _request: GetWorldPropertiesRequest
) -> GetWorldPropertiesResponse:
    """Tell time [s] and model names in world order; like Gazebo, always claims to render."""
    return GetWorldPropertiesResponse(
        sim_time=server.world.clock.now,
        model_names=list(server.world.models),
        rendering_enabled=True,
        success=True,
        status_message='GetWorldProperties: got properties',
    )
