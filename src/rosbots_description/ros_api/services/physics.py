"""Services about the physics of the world: step size, update rate, gravity and the solver."""

from dataclasses import replace

from gazebo_msgs import srv
from gazebo_msgs.msg import ODEPhysics
from geometry_msgs.msg import Vector3

from ...sim.description import check_physics
from ..messages import read_vector
from ..server import Server
from .registry import service


@service('get_physics_properties', srv.GetPhysicsProperties)
def get_physics_properties(
    server: Server, _request: srv.GetPhysicsPropertiesRequest
) -> srv.GetPhysicsPropertiesResponse:
    """Return the current settings."""
    physics = server.world.physics
    return srv.GetPhysicsPropertiesResponse(
        time_step=physics.step_size,
        pause=server.world.paused,
        max_update_rate=physics.max_update_rate,
        gravity=Vector3(*physics.gravity),
        ode_config=ODEPhysics(**{name: getattr(physics, name) for name in ODEPhysics.__slots__}),
        success=True,
        status_message='GetPhysicsProperties: got properties',
    )


@service('set_physics_properties', srv.SetPhysicsProperties)
def set_physics_properties(
    server: Server, request: srv.SetPhysicsPropertiesRequest
) -> srv.SetPhysicsPropertiesResponse:
    """Change the settings from the next step on; every field is used, zeros included.

    The friction model is not part of the request and is kept.

    The target real-time factor is `max_update_rate` * `time_step`; a rate of 0 means as fast as
    possible.
    """
    physics = replace(
        server.world.physics,
        step_size=request.time_step,
        max_update_rate=request.max_update_rate,
        gravity=read_vector(request.gravity),
        **{name: getattr(request.ode_config, name) for name in ODEPhysics.__slots__},
    )
    check_physics(physics)
    server.world.set_physics(physics)
    server.physics_changed()
    return srv.SetPhysicsPropertiesResponse(True, 'physics engine updated')
