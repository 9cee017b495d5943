"""Services about the simulation as a whole: pause, reset, world properties."""

from gazebo_msgs import srv
from std_srvs.srv import Empty, EmptyRequest, EmptyResponse

from ..server import Server
from .registry import service


@service('pause_physics', Empty)
def pause_physics(server: Server, _request: EmptyRequest) -> EmptyResponse:
    """Pause simulated time; no effect if it is paused."""
    server.world.paused = True
    return EmptyResponse()


@service('unpause_physics', Empty)
def unpause_physics(server: Server, _request: EmptyRequest) -> EmptyResponse:
    """Continue simulated time; no effect if it is running."""
    server.world.paused = False
    return EmptyResponse()


@service('reset_world', Empty)
def reset_world(server: Server, _request: EmptyRequest) -> EmptyResponse:
    """Return every model to its spawn pose, at rest; time and joint angles are kept."""
    server.world.reset_world()
    return EmptyResponse()


@service('reset_simulation', Empty)
def reset_simulation(server: Server, _request: EmptyRequest) -> EmptyResponse:
    """Restart at time zero with every model as it was spawned."""
    server.world.reset_simulation()
    return EmptyResponse()


@service('get_world_properties', srv.GetWorldProperties)
def get_world_properties(
    server: Server, _request: srv.GetWorldPropertiesRequest
) -> srv.GetWorldPropertiesResponse:
    """Return time [s] and model names in world order; as in Gazebo rendering_enabled is true."""
    return srv.GetWorldPropertiesResponse(
        sim_time=server.world.clock.now,
        model_names=list(server.world.models),
        rendering_enabled=True,
        success=True,
        status_message='GetWorldProperties: got properties',
    )
