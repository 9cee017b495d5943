"""The services of the running /gazebo that a scenario needs."""

import contextlib
from collections.abc import Iterator
from typing import Any

import rospy
from gazebo_msgs import srv
from genpy import Message
from geometry_msgs.msg import Pose as PoseMessage
from std_srvs.srv import Empty

from ...batch import JointReading, ModelEntry, RecordEntry, ScenarioError
from ...sim.public import Descriptions
from ...sim.runtime import Odometry
from ..messages import fill_pose, read_pose, read_twist

DEADLINE = 10.0  # for a service, which takes a fraction of it [s, wall]


def spawn(model: ModelEntry, described: str) -> None:
    """Spawn a model, described by an address, a path or a text."""
    text, _, tag = Descriptions((), ()).text(described, model.xacro_arguments())
    text = text.decode('utf-8', 'replace') if isinstance(text, bytes) else text
    pose = PoseMessage()
    fill_pose(pose, model.pose.pose())
    service = f'spawn_{"urdf" if tag == "robot" else "sdf"}_model'
    _require(_call(service, srv.SpawnModel, model.name, text, '', pose, ''))


def delete(name: str) -> None:
    """Delete a model."""
    _call('delete_model', srv.DeleteModel, name)


def true_state(record: RecordEntry) -> Odometry | JointReading:
    """Return what is true of a record's model, link or joint."""
    if record.joint:
        answer = _require(_call('get_joint_properties', srv.GetJointProperties, record.joint))
        return JointReading(answer.position[0], answer.rate[0])
    if record.link:
        link = f'{record.model}::{record.link}'
        answer = _require(_call('get_link_state', srv.GetLinkState, link, '')).link_state
    else:
        answer = _require(_call('get_model_state', srv.GetModelState, record.model, ''))
    return Odometry(read_pose(answer.pose), read_twist(answer.twist))


@contextlib.contextmanager
def paused() -> Iterator[None]:
    """Pause physics for the length of a `with` statement."""
    _call('pause_physics', Empty)
    try:
        yield
    finally:
        with contextlib.suppress(ScenarioError):
            _call('unpause_physics', Empty)


def _call(name: str, service_type: type[Any], *arguments: object) -> Message:
    """Return the answer of a service; raise a `ScenarioError` if there is none."""
    path = f'/gazebo/{name}'
    try:
        rospy.wait_for_service(path, DEADLINE)
        return rospy.ServiceProxy(path, service_type)(*arguments)
    except rospy.ROSInterruptException:
        raise
    except rospy.ROSException:
        raise ScenarioError(f'there is no service {path}; start the simulator') from None
    except rospy.ServiceException as error:
        raise ScenarioError(f'the call of {path} failed: {error}') from None


def _require(answer: Message) -> Message:
    """Return an answer; raise a `ScenarioError` if it reports a failure."""
    if not answer.success:
        raise ScenarioError(answer.status_message)
    return answer
