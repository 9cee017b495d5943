"""The services that spawn models and lights."""

import logging
from collections.abc import Callable
from dataclasses import dataclass

from gazebo_msgs.srv import SpawnModel, SpawnModelRequest, SpawnModelResponse
from rosbots_msgs.srv import (
    GetModelOmissions,
    GetModelOmissionsRequest,
    GetModelOmissionsResponse,
)

from ...sim.core import Fault, ModelError, NotFoundError, Pose, compose, report
from ...sim.description import LightSpec, ModelSpec
from ...sim.formats import load_sdf, load_sdf_light, load_urdf
from ...sim.physics import CompiledModel
from ...sim.resources import UnknownPackage, root_tag
from ...sim.runtime import Model, World
from ..messages import read_pose
from ..server import Server
from ..transport import caller_waits
from .registry import EXTENSIONS, CallError, refuse, service

logger = logging.getLogger(__name__)

# [m] An overlap up to this depth is not reported: the spawn heights of published robots are
# rounded to centimetres.
DEEP = 0.01

_NO_FRAME = (
    'SpawnModel: reference reference_frame not found, '
    'did you forget to scope the link by model name?'
)


_NO_FORMAT = (
    'GazeboRosApiPlugin SpawnModel Failure: input model_xml not SDF or URDF, '
    'or cannot be converted to Gazebo compatible format.'
)
_DONE = 'SpawnModel: Successfully spawned entity'


@dataclass(frozen=True)
class PreparedModel:
    """A compiled model that is ready to be added to the world; `pose` is in the frame `frame`."""

    name: str
    model: CompiledModel
    pose: Pose
    frame: str


def _read_urdf(server: Server, request: SpawnModelRequest) -> PreparedModel | SpawnModelResponse:
    """Parse, compile and test a URDF; errors for which Gazebo's call fails are logged here."""
    if root_tag(request.model_xml) != 'robot':
        logger.error('SpawnModel: Failure - entity format is invalid.')
        raise CallError(
            'SpawnModel: Failure - entity format is invalid. '
            'This service takes URDF: XML whose outermost element is <robot>'
        )
    try:
        return _prepare(server, request, load_urdf)
    except UnknownPackage as error:
        logger.critical('%s', error)
        raise CallError(f'SpawnModel: Failure - {error}') from None


def read_description(
    server: Server, request: SpawnModelRequest
) -> PreparedModel | LightSpec | SpawnModelResponse:
    """Parse, compile and test a URDF or an SDF model, or parse a light; called beside the loop."""
    kind = root_tag(request.model_xml)
    if kind == 'robot':
        return _prepare(server, request, load_urdf)
    if kind not in ('sdf', 'gazebo'):
        return refuse(SpawnModelResponse(), _NO_FORMAT)
    light = load_sdf_light(request.model_xml, request.model_name)
    if light is not None:
        # The frame must exist although, as in Gazebo, a light has the pose in its description.
        return server.loop.call(lambda: _frame_refusal(server, request.reference_frame)) or light
    return _prepare(server, request, load_sdf)


def _prepare(
    server: Server, request: SpawnModelRequest, load: Callable[..., tuple[ModelSpec, Pose]]
) -> PreparedModel | SpawnModelResponse:
    """Parse the model, compile it and test it in the sandbox, while the simulation goes on."""
    name, frame = request.model_name, request.reference_frame
    if not name:
        raise ModelError('model_name is empty; give the model a name')
    pose = _initial_pose(request)
    refusal = server.loop.call(lambda: _refusal(server, name, frame))
    if refusal is not None:
        return refusal
    spec, origin = load(
        request.model_xml,
        name,
        robot_namespace=request.robot_namespace,
        find_package=server.find_package,
        find_model=server.find_model,
        find_file=server.find_file,
    )
    model = server.world.compile(spec)
    server.sandbox.require(model, server.world.physics, caller_waits)
    return PreparedModel(name, model, compose(pose, origin), frame)


@service('spawn_urdf_model', SpawnModel, prepare=_read_urdf, registers=True)
@service('spawn_sdf_model', SpawnModel, prepare=read_description, registers=True)
def spawn_model(server: Server, prepared: PreparedModel | LightSpec) -> SpawnModelResponse:
    """Add a prepared model or a light to the world."""
    if isinstance(prepared, LightSpec):
        return _spawn_light(server, prepared)
    refusal = _refusal(server, prepared.name, prepared.frame)
    if refusal is not None:  # the name was taken meanwhile
        return refusal
    frame_pose, _ = server.world.frame(prepared.frame)
    model = server.world.spawn(prepared.model, prepared.name, compose(frame_pose, prepared.pose))
    if not (model.static or model.body.fixed_roots):
        warn_overlap(server.world, model)
    return SpawnModelResponse(True, _DONE)


def warn_overlap(world: World, model: Model) -> None:
    """Warn if a model overlaps others, which will push it out."""
    deep = {name: depth for name, depth in world.overlaps(model).items() if depth > DEEP}
    if deep:
        others = ' and '.join(f"'{name}' ({depth:.2g} m deep)" for name, depth in deep.items())
        what = f"model '{model.name}' was spawned inside {others}, which will push it out"
        report(Fault(what, model=model.name, cure='change its x, y or z'))


@service('get_model_omissions', GetModelOmissions, table=EXTENSIONS)
def get_model_omissions(
    server: Server, request: GetModelOmissionsRequest
) -> GetModelOmissionsResponse:
    """Return the parts of a model's description that are not simulated; not in Gazebo."""
    model = server.world.models.get(request.model_name)
    if model is None:
        # Not logged: spawn_model also calls it after spawning a light.
        return GetModelOmissionsResponse(False, 'GetModelOmissions: model does not exist', [])
    return GetModelOmissionsResponse(True, 'GetModelOmissions: got omissions', model.left_out)


def _spawn_light(server: Server, light: LightSpec) -> SpawnModelResponse:
    """Add a light at the pose in its description; as in Gazebo the initial pose is ignored."""
    if not light.name:
        raise ModelError('model_name is empty; give the light a name')
    if light.name in server.world.lights:
        logger.error('SpawnModel: Failure - light name %s already exist.', light.name)
        return SpawnModelResponse(False, 'SpawnModel: Failure - entity already exists.')
    server.world.lights[light.name] = light
    return SpawnModelResponse(True, _DONE)


def _initial_pose(request: SpawnModelRequest) -> Pose:
    try:
        return read_pose(request.initial_pose)
    except ValueError:
        raise ModelError(
            f"the initial_pose of model '{request.model_name}' holds a number that is not finite"
        ) from None


def _refusal(server: Server, name: str, frame: str) -> SpawnModelResponse | None:
    """Return Gazebo's response to an unknown frame or a name that is taken; otherwise None."""
    refusal = _frame_refusal(server, frame)
    if refusal is None and name in server.world.models:
        logger.error('SpawnModel: Failure - model name %s already exist.', name)
        refusal = SpawnModelResponse(False, 'SpawnModel: Failure - entity already exists.')
    return refusal


def _frame_refusal(server: Server, frame: str) -> SpawnModelResponse | None:
    try:
        server.world.frame(frame)
    except NotFoundError:
        return SpawnModelResponse(False, _NO_FRAME)
    return None
