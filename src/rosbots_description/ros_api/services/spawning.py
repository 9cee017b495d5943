"""The service that brings models into the world."""

import logging
from dataclasses import dataclass

from gazebo_msgs.srv import SpawnModel, SpawnModelRequest, SpawnModelResponse

from ...sim.errors import ModelError, NotFoundError
from ...sim.markup import root_tag
from ...sim.pose import Pose, compose
from ...sim.spec import Mesh, ModelSpec
from ...sim.urdf import load_urdf
from ...sim.uris import UnknownPackage
from ..conversions import read_pose
from ..server import Server
from .registry import CallError, service

logger = logging.getLogger(__name__)

_NO_FRAME = (
    'SpawnModel: reference reference_frame not found, '
    'did you forget to scope the link by model name?'
)


@dataclass(frozen=True)
class _Arrival:
    """A model that only has to be put into the world; `pose` is given in the frame `frame`."""

    name: str
    spec: ModelSpec
    pose: Pose
    frame: str


def _read_urdf(server: Server, request: SpawnModelRequest) -> _Arrival | SpawnModelResponse:
    """Do what is slow about a spawn: parse, validate, read meshes; simulation goes on."""
    if root_tag(request.model_xml) != 'robot':
        logger.error('SpawnModel: Failure - entity format is invalid.')
        raise CallError(
            'SpawnModel: Failure - entity format is invalid. '
            'This service takes URDF: XML whose outermost element is <robot>'
        )
    if not request.model_name:
        raise ModelError('model_name is empty; give the model a name')
    pose = _initial_pose(request)
    name, frame = request.model_name, request.reference_frame
    refusal = server.loop.call(lambda: _refusal(server, name, frame))
    if refusal is not None:
        return refusal
    try:
        spec, origin = load_urdf(
            request.model_xml,
            name,
            robot_namespace=request.robot_namespace,
            find_package=server.find_package,
        )
    except UnknownPackage as error:
        logger.critical('%s', error)
        raise CallError(f'SpawnModel: Failure - {error}') from None
    _warm_meshes(server, spec)
    return _Arrival(name, spec, compose(pose, origin), frame)


@service('spawn_urdf_model', SpawnModel, prepare=_read_urdf, registers=True)
def spawn_urdf_model(server: Server, arrival: _Arrival) -> SpawnModelResponse:
    """Put a model that has been read into the world."""
    refusal = _refusal(server, arrival.name, arrival.frame)
    if refusal is not None:  # someone else was quicker
        return refusal
    frame_pose, _ = server.world.frame(arrival.frame)
    server.world.spawn(arrival.spec, arrival.name, compose(frame_pose, arrival.pose))
    return SpawnModelResponse(True, 'SpawnModel: Successfully spawned entity')


def _initial_pose(request: SpawnModelRequest) -> Pose:
    try:
        return read_pose(request.initial_pose)
    except ValueError:
        raise ModelError(
            f"the initial_pose of model '{request.model_name}' holds a number that is not finite"
        ) from None


def _refusal(server: Server, name: str, frame: str) -> SpawnModelResponse | None:
    """Return Gazebo's answer to a frame that is not there or a name that is; else None."""
    try:
        server.world.frame(frame)
    except NotFoundError:
        return SpawnModelResponse(False, _NO_FRAME)
    if name in server.world.models:
        logger.error('SpawnModel: Failure - model name %s already exist.', name)
        return SpawnModelResponse(False, 'SpawnModel: Failure - entity already exists.')
    return None


def _warm_meshes(server: Server, spec: ModelSpec) -> None:
    """Convert the meshes that will touch, so that the world finds them ready."""
    for link in spec.links:
        for collision in link.collisions:
            if isinstance(collision.geometry, Mesh):
                mesh = collision.geometry
                server.world.meshes.collision_hull(mesh.path, mesh.scale)
