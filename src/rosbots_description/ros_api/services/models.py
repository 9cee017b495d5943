"""Services about models that are in the world."""

import logging

from gazebo_msgs.srv import (
    DeleteModel,
    DeleteModelRequest,
    DeleteModelResponse,
    GetModelState,
    GetModelStateRequest,
    GetModelStateResponse,
)

from ...sim.core import NotFoundError, Pose, Twist, conjugate, relative, rotate, subtract
from ..messages import fill_pose, fill_twist, stamp
from ..server import Server
from .registry import service

logger = logging.getLogger(__name__)


@service('delete_model', DeleteModel, registers=True)
def delete_model(server: Server, request: DeleteModelRequest) -> DeleteModelResponse:
    """Delete a model with its plugins and their topics."""
    name = request.model_name
    try:
        server.world.delete(name)
    except NotFoundError:
        logger.error('DeleteModel: model [%s] does not exist', name)
        return DeleteModelResponse(False, 'DeleteModel: model does not exist')
    return DeleteModelResponse(True, 'DeleteModel: successfully deleted model')


class _CountedState(GetModelStateResponse):  # type: ignore[misc]  # messages have none
    """A response with our own header.seq; rospy would set the number of the call."""

    _has_header = False


@service('get_model_state', GetModelState)
def get_model_state(server: Server, request: GetModelStateRequest) -> GetModelStateResponse:
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
