"""Services that describe a model or move it."""

from gazebo_msgs.srv import (
    GetModelProperties,
    GetModelPropertiesRequest,
    GetModelPropertiesResponse,
    SetModelConfiguration,
    SetModelConfigurationRequest,
    SetModelConfigurationResponse,
    SetModelState,
    SetModelStateRequest,
    SetModelStateResponse,
)

from ...sim.core import NotFoundError, Twist, compose, rotate
from ...sim.runtime import Joint
from ..messages import read_pose, read_twist, require_finite
from ..server import Server
from .registry import refuse, service

_INNER = '::'  # separates the name of a nested model from those of its parts


@service('get_model_properties', GetModelProperties)
def get_model_properties(
    server: Server, request: GetModelPropertiesRequest
) -> GetModelPropertiesResponse:
    """Return the parts of a model by their plain names, without those of nested models."""
    response = GetModelPropertiesResponse()
    model = server.world.find_model(request.model_name)
    if model is None:
        return refuse(response, 'GetModelProperties: model does not exist')
    links = [link for link in model.spec.links if _INNER not in link.name]
    response.body_names = [link.name for link in links]
    response.geom_names = [collision.name for link in links for collision in link.collisions]
    response.joint_names = [j.name for j in model.spec.joints if _INNER not in j.name]
    response.parent_model_name = model.parent_name
    response.child_model_names = [name for name in model.spec.nested if _INNER not in name]
    response.is_static = model.static
    response.success, response.status_message = True, 'GetModelProperties: got properties'
    return response


@service('set_model_state', SetModelState)
def set_model_state(server: Server, request: SetModelStateRequest) -> SetModelStateResponse:
    """Set a model's pose and velocity, both given in the frame of an entity or the world.

    As in Gazebo the velocity of the frame itself is not added.
    """
    require_finite(request)
    state = request.model_state
    model = server.world.find_model(state.model_name)
    if model is None:
        return refuse(SetModelStateResponse(), 'SetModelState: model does not exist')
    try:
        frame, _ = server.world.frame(state.reference_frame)
    except NotFoundError:
        return refuse(
            SetModelStateResponse(),
            'SetModelState: specified reference frame entity does not exist',
        )
    model.set_pose(compose(frame, read_pose(state.pose)))
    if not model.static:
        twist = read_twist(state.twist)
        model.set_twist(
            Twist(rotate(frame.orientation, twist.linear), rotate(frame.orientation, twist.angular))
        )
    return SetModelStateResponse(True, 'SetModelState: set model state done')


@service('set_model_configuration', SetModelConfiguration)
def set_model_configuration(
    server: Server, request: SetModelConfigurationRequest
) -> SetModelConfigurationResponse:
    """Set joint positions [rad or m], clamped to their limits; unknown names are ignored."""
    require_finite(request)
    response = SetModelConfigurationResponse()
    model = server.world.find_model(request.model_name)
    if model is None:
        return refuse(response, 'SetModelConfiguration: model does not exist')
    if len(request.joint_names) != len(request.joint_positions):
        return refuse(
            response,
            'SetModelConfiguration: joint name and position list have different lengths',
        )
    for name, position in zip(request.joint_names, request.joint_positions, strict=True):
        joint = model.joints.get(name.removeprefix(f'{model.name}::'))
        if joint is not None:
            joint.set_position(_within_limits(joint, position))
    return SetModelConfigurationResponse(True, 'SetModelConfiguration: success')


def _within_limits(joint: Joint, position: float) -> float:
    lower, upper = joint.spec.lower, joint.spec.upper
    if upper is not None:
        position = min(position, upper)
    return position if lower is None else max(position, lower)
