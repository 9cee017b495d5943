"""Services about models that are in the world."""

import logging

from gazebo_msgs import srv

from ...sim.core import NotFoundError, Pose, Twist, compose, conjugate, relative, rotate, subtract
from ...sim.runtime import Joint
from ..messages import fill_pose, fill_twist, read_pose, read_twist, require_finite, stamp
from ..server import Server
from .registry import refuse, service

logger = logging.getLogger(__name__)

_INNER = '::'  # separates the name of a nested model from those of its parts


@service('delete_model', srv.DeleteModel, registers=True)
def delete_model(server: Server, request: srv.DeleteModelRequest) -> srv.DeleteModelResponse:
    """Delete a model with its plugins and their topics."""
    name = request.model_name
    try:
        server.world.delete(name)
    except NotFoundError:
        logger.error('DeleteModel: model [%s] does not exist', name)
        return srv.DeleteModelResponse(False, 'DeleteModel: model does not exist')
    return srv.DeleteModelResponse(True, 'DeleteModel: successfully deleted model')


class _CountedState(srv.GetModelStateResponse):  # type: ignore[misc]  # messages have none
    """A response with our own header.seq; rospy would set the number of the call."""

    _has_header = False


@service('get_model_state', srv.GetModelState)
def get_model_state(server: Server, request: srv.GetModelStateRequest) -> srv.GetModelStateResponse:
    """Return a model's pose and twist relative to an entity or the world."""
    response = _CountedState()
    model = server.world.find_model(request.model_name)
    if model is None:
        logger.error('GetModelState: model [%s] does not exist', request.model_name)
        response.status_message = 'GetModelState: model does not exist'
        return response
    server.lookups[model.name] += 1
    response.header.seq = server.lookups[model.name]
    response.header.stamp = stamp(server.world.clock.now_ns)
    response.header.frame_id = request.relative_entity_name
    try:
        frame = server.world.frame(request.relative_entity_name)
    except NotFoundError:
        response.status_message = (
            'GetModelState: reference relative_entity_name not found, '
            'did you forget to scope the body by model name?'
        )
        return response
    pose, twist = relative_state(model.state(), frame)
    fill_pose(response.pose, pose)
    fill_twist(response.twist, twist)
    response.success, response.status_message = True, 'GetModelState: got properties'
    return response


def relative_state(state: tuple[Pose, Twist], frame: tuple[Pose, Twist]) -> tuple[Pose, Twist]:
    """Return a state relative to a frame, both given in the world.

    The velocity is R_frame^-1 (v - v_frame) without the w x r term, as in Gazebo.
    """
    (pose, twist), (frame_pose, frame_twist) = state, frame
    back = conjugate(frame_pose.orientation)
    return relative(pose, frame_pose), Twist(
        rotate(back, subtract(twist.linear, frame_twist.linear)),
        rotate(back, subtract(twist.angular, frame_twist.angular)),
    )


@service('get_model_properties', srv.GetModelProperties)
def get_model_properties(
    server: Server, request: srv.GetModelPropertiesRequest
) -> srv.GetModelPropertiesResponse:
    """Return the parts of a model by their plain names, without those of nested models."""
    response = srv.GetModelPropertiesResponse()
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


@service('set_model_state', srv.SetModelState)
def set_model_state(server: Server, request: srv.SetModelStateRequest) -> srv.SetModelStateResponse:
    """Set a model's pose and velocity, both given in the frame of an entity or the world.

    As in Gazebo the velocity of the frame itself is not added.
    """
    require_finite(request)
    state = request.model_state
    model = server.world.find_model(state.model_name)
    if model is None:
        return refuse(srv.SetModelStateResponse(), 'SetModelState: model does not exist')
    try:
        frame, _ = server.world.frame(state.reference_frame)
    except NotFoundError:
        return refuse(
            srv.SetModelStateResponse(),
            'SetModelState: specified reference frame entity does not exist',
        )
    model.set_pose(compose(frame, read_pose(state.pose)))
    if not model.static:
        twist = read_twist(state.twist)
        model.set_twist(
            Twist(rotate(frame.orientation, twist.linear), rotate(frame.orientation, twist.angular))
        )
    return srv.SetModelStateResponse(True, 'SetModelState: set model state done')


@service('set_model_configuration', srv.SetModelConfiguration)
def set_model_configuration(
    server: Server, request: srv.SetModelConfigurationRequest
) -> srv.SetModelConfigurationResponse:
    """Set joint positions [rad or m], clamped to their limits; unknown names are ignored."""
    require_finite(request)
    response = srv.SetModelConfigurationResponse()
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
    return srv.SetModelConfigurationResponse(True, 'SetModelConfiguration: success')


def _within_limits(joint: Joint, position: float) -> float:
    lower, upper = joint.spec.lower, joint.spec.upper
    if upper is not None:
        position = min(position, upper)
    return position if lower is None else max(position, lower)
