"""The services of the running /gazebo that a scenario needs."""

import contextlib
from collections.abc import Callable, Iterator
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
    call = _service(f'spawn_{"urdf" if tag == "robot" else "sdf"}_model', srv.SpawnModel)
    _require(call(model.name, text, '', pose, ''))


def delete(name: str) -> None:
    """Delete a model."""
    _service('delete_model', srv.DeleteModel)(name)


def true_state(record: RecordEntry) -> Odometry | JointReading:
    """Return what is true of a record's model, link or joint."""
    if record.joint:
        answer = _service('get_joint_properties', srv.GetJointProperties)(record.joint)
        _require(answer)
        return JointReading(answer.position[0], answer.rate[0])
    if record.link:
        answer = _service('get_link_state', srv.GetLinkState)(f'{record.model}::{record.link}', '')
        _require(answer)
        answer = answer.link_state
    else:
        answer = _service('get_model_state', srv.GetModelState)(record.model, '')
        _require(answer)
    return Odometry(read_pose(answer.pose), read_twist(answer.twist))


@contextlib.contextmanager
def paused() -> Iterator[None]:
    """Pause physics for the length of a `with` statement."""
    pause, unpause = _service('pause_physics', Empty), _service('unpause_physics', Empty)
    pause()
    try:
        yield
    finally:
        with contextlib.suppress(ScenarioError):
            unpause()


def _service(name: str, service_type: type[Any]) -> Callable[..., Message]:
    """Return what calls a service; it raises a `ScenarioError` if there is no answer."""
    path = f'/gazebo/{name}'

    def call(*arguments: object) -> Message:
        try:
            rospy.wait_for_service(path, DEADLINE)
            return rospy.ServiceProxy(path, service_type)(*arguments)
        except rospy.ROSInterruptException:
            raise
        except rospy.ROSException:
            raise ScenarioError(f'there is no service {path}; start the simulator') from None
        except rospy.ServiceException as error:
            raise ScenarioError(f'the call of {path} failed: {error}') from None

    return call


def _require(answer: Message) -> None:
    if not answer.success:
        raise ScenarioError(answer.status_message)
