"""Services by which a window inserts models where there is room, and copies them; not in Gazebo."""

from dataclasses import dataclass, replace

from gazebo_msgs.srv import SetModelConfigurationRequest, SpawnModelRequest, SpawnModelResponse
from rosbots_msgs import srv

from ...sim.core.arrays import FloatArray
from ...sim.description import LightSpec
from ...sim.formats import copy_of_model
from ...sim.placement import box_around, free_name, placed
from ...sim.resources import model_names, own_name
from ..messages import RequestError, fill_pose, require_finite
from ..server import Server
from .models import set_model_configuration
from .registry import EXTENSIONS, refuse, service
from .spawning import PreparedModel, read_description, spawn_model


@dataclass(frozen=True)
class _Insertion:
    """A model or light, and the request for it."""

    prepared: PreparedModel | LightSpec
    box: FloatArray | None  # around the model
    request: srv.InsertModelRequest


def _read(server: Server, request: srv.InsertModelRequest) -> _Insertion | srv.InsertModelResponse:
    """Parse, compile and test; called beside the loop."""
    require_finite(request)
    if len(request.joint_names) != len(request.joint_positions):
        raise RequestError('joint_names and joint_positions have different lengths')
    wanted = request.model_name or own_name(request.model_xml, 'model_xml')
    name = server.loop.call(lambda: free_name(server.world, wanted))
    prepared = read_description(
        server,
        SpawnModelRequest(
            name, request.model_xml, request.robot_namespace, request.initial_pose, ''
        ),
    )
    if isinstance(prepared, SpawnModelResponse):
        return _response(prepared)
    box = (
        box_around(prepared.model.spec, prepared.pose)
        if isinstance(prepared, PreparedModel)
        else None
    )
    return _Insertion(prepared, box, request)


@service('insert_model', srv.InsertModel, prepare=_read, registers=True, table=EXTENSIONS)
def insert_model(server: Server, insertion: _Insertion) -> srv.InsertModelResponse:
    """Spawn a model or light that was prepared."""
    prepared, box, request = insertion.prepared, insertion.box, insertion.request
    # Its name was free before it was prepared, perhaps at the same time as another of that name.
    prepared = replace(prepared, name=free_name(server.world, prepared.name))
    if isinstance(prepared, PreparedModel) and box is not None:
        prepared = replace(
            prepared,
            pose=placed(server.world, prepared.pose, box, request.on_ground, request.beside),
        )
    response = spawn_model(server, prepared)  # never refused, since the name is free
    if request.joint_names:
        set_model_configuration(
            server,
            SetModelConfigurationRequest(
                prepared.name, '', request.joint_names, request.joint_positions
            ),
        )
    return _response(response, prepared.name)


@service('get_model_description', srv.GetModelDescription, table=EXTENSIONS)
def get_model_description(
    server: Server, request: srv.GetModelDescriptionRequest
) -> srv.GetModelDescriptionResponse:
    """Return a model as SDF, with the joint positions and the pose that it has now."""
    response = srv.GetModelDescriptionResponse()
    model = server.world.models.get(request.model_name)
    if model is None:
        return refuse(response, 'GetModelDescription: model does not exist')
    response.model_xml = copy_of_model(model.spec)
    fill_pose(response.pose, model.pose)
    response.joint_names = list(model.joints)
    response.joint_positions = [joint.position for joint in model.joints.values()]
    response.success, response.status_message = True, 'GetModelDescription: got description'
    return response


@service('get_model_library', srv.GetModelLibrary, on_loop=False, table=EXTENSIONS)
def get_model_library(
    server: Server, _request: srv.GetModelLibraryRequest
) -> srv.GetModelLibraryResponse:
    """Return the names of the models along the model path."""
    return srv.GetModelLibraryResponse(model_names(server.find_model))


def _response(response: SpawnModelResponse, name: str = '') -> srv.InsertModelResponse:
    return srv.InsertModelResponse(response.success, response.status_message, name)
