"""A service by which a page holds a model that is dragged; not in Gazebo."""

import time

from rosbots_msgs.srv import HoldModel, HoldModelRequest, HoldModelResponse

from ..messages import RequestError, read_pose, require_finite
from ..server import Server
from .registry import EXTENSIONS, refuse, service

MAX_DURATION = 10.0  # [s, wall] after which a client that has ended no longer matters


@service('hold_model', HoldModel, table=EXTENSIONS)
def hold_model(server: Server, request: HoldModelRequest) -> HoldModelResponse:
    """Hold a model at rest at a pose; without a duration, leave it there."""
    require_finite(request)
    if not 0.0 <= request.duration <= MAX_DURATION:
        raise RequestError(f'duration is {request.duration:g}; it must be 0 to {MAX_DURATION:g} s')
    model = server.world.models.get(request.model_name)
    if model is None:
        return refuse(HoldModelResponse(), 'HoldModel: model does not exist')
    end = time.monotonic() + request.duration
    server.world.holds.hold(model, read_pose(request.pose), lambda: time.monotonic() < end)
    if request.duration == 0.0:
        server.world.holds.release(model)
        return HoldModelResponse(True, 'HoldModel: the model is free')
    return HoldModelResponse(True, 'HoldModel: the model is held')
