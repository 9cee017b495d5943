"""Edits of the models of a simulator, by its services."""

import rospy
from gazebo_msgs.msg import ModelState
from gazebo_msgs.srv import (
    ApplyBodyWrench,
    DeleteLight,
    DeleteModel,
    GetWorldProperties,
    SetModelState,
)
from geometry_msgs.msg import Pose as PoseMessage
from geometry_msgs.msg import Vector3, Wrench
from rosbots_msgs.srv import GetModelDescription, HoldModel, InsertModel

from ...sim.core import Pose, SimError, Vector
from ...sim.description import ModelText
from ..messages import fill_pose, read_pose
from .calls import call

SPAWN_TIMEOUT = 60.0  # for large meshes [s, wall]
MAX_DURATION = 1e6  # of a push [s, simulated]


class RosEditor:
    """Edits models; each method raises SimError with the simulator's sentence."""

    def insert(self, text: ModelText, on_ground: bool = False, beside: bool = False) -> str:
        """Spawn a model or light under a name that is free; return the name."""
        joints = dict(text.joints)
        name: str = call(
            'insert_model',
            InsertModel,
            SPAWN_TIMEOUT,
            model_name=text.name,
            model_xml=text.xml,
            robot_namespace=text.namespace,
            initial_pose=_message(text.pose),
            on_ground=on_ground,
            beside=beside,
            joint_names=list(joints),
            joint_positions=list(joints.values()),
        ).model_name
        return name

    def delete(self, name: str) -> None:
        """Delete a model, else the light of that name."""
        # Asked first: the simulator logs an error when there is no model of the name.
        if name in call('get_world_properties', GetWorldProperties).model_names:
            call('delete_model', DeleteModel, model_name=name)
        else:
            call('delete_light', DeleteLight, light_name=name)

    def describe(self, name: str) -> ModelText:
        """Return what is needed to spawn a model again as it is."""
        found = call('get_model_description', GetModelDescription, model_name=name)
        return ModelText(
            name,
            found.model_xml,
            pose=read_pose(found.pose),
            joints=dict(zip(found.joint_names, found.joint_positions, strict=True)),
        )

    def move(self, name: str, pose: Pose) -> None:
        """Move a model, at rest, so that its frame is at a pose in the world."""
        call(
            'set_model_state',
            SetModelState,
            model_state=ModelState(model_name=name, pose=_message(pose)),
        )

    def hold(self, name: str, pose: Pose, duration: float) -> None:
        """Hold a model at rest at a pose for a time [s, wall]; zero: let it go there."""
        call('hold_model', HoldModel, model_name=name, pose=_message(pose), duration=duration)

    def push(
        self, link: str, force: Vector, torque: Vector, duration: float, own_axes: bool
    ) -> None:
        """Apply a force [N] at the centre of mass of a link, and a torque [N m]."""
        if not 0.0 <= duration <= MAX_DURATION:  # neither for NaN
            raise SimError(f'a push lasts 0 to {MAX_DURATION:g} s, not {duration:g} s')
        call(
            'apply_body_wrench',
            ApplyBodyWrench,
            body_name=link,
            reference_frame=link if own_axes else '',
            wrench=Wrench(Vector3(*force), Vector3(*torque)),
            duration=rospy.Duration.from_sec(duration),
        )


def _message(pose: Pose) -> PoseMessage:
    message = PoseMessage()
    fill_pose(message, pose)
    return message
