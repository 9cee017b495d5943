"""State and properties of models and links, by the simulator's services."""

from gazebo_msgs.msg import LinkState, ModelState
from gazebo_msgs.srv import (
    GetLinkProperties,
    GetLinkState,
    GetModelState,
    SetLinkProperties,
    SetLinkState,
    SetModelState,
)
from rosbots_msgs.srv import GetModelOmissions, SetFriction

from ...sim.core import Pose, Twist
from ..messages import fill_pose, fill_twist, read_pose, read_twist
from .calls import TIMEOUT, answer_of, call

_MOMENTS = ('ixx', 'ixy', 'ixz', 'iyy', 'iyz', 'izz')


class RosInspection:
    """Reads and changes a model, or one of its links; each raises SimError if it is refused."""

    def state(
        self, model: str, link: str | None, patience: float | None = None
    ) -> tuple[Pose, Twist]:
        """Return pose and velocity in the world; `patience` is for the answer [s, wall]."""
        patience = TIMEOUT if patience is None else patience
        if link is None:
            answer = call('get_model_state', GetModelState, patience, model_name=model)
            return read_pose(answer.pose), read_twist(answer.twist)
        state = call(
            'get_link_state', GetLinkState, patience, link_name=f'{model}::{link}'
        ).link_state
        return read_pose(state.pose), read_twist(state.twist)

    def omissions(self, model: str) -> list[str]:
        """Return the parts that a model was spawned without; [] of a light."""
        answer = answer_of('get_model_omissions', GetModelOmissions, model_name=model)
        return list(answer.omissions)

    def set_state(self, model: str, link: str | None, pose: Pose, twist: Twist) -> None:
        """Set pose and velocity in the world."""
        state = (
            ModelState(model_name=model)
            if link is None
            else LinkState(link_name=f'{model}::{link}')
        )
        fill_pose(state.pose, pose)
        fill_twist(state.twist, twist)
        if link is None:
            call('set_model_state', SetModelState, model_state=state)
        else:
            call('set_link_state', SetLinkState, link_state=state)

    def set_mass(self, model: str, link: str, mass: float, gravity: bool) -> None:
        """Set a link's mass [kg], its inertia in proportion, and whether gravity acts on it."""
        name = f'{model}::{link}'
        now = call('get_link_properties', GetLinkProperties, link_name=name)
        factor = mass / now.mass if now.mass else 1.0
        call(
            'set_link_properties',
            SetLinkProperties,
            link_name=name,
            com=now.com,
            gravity_mode=gravity,
            mass=mass,
            **{moment: factor * getattr(now, moment) for moment in _MOMENTS},
        )

    def set_friction(self, name: str, mu: float, mu2: float) -> None:
        """Set the friction coefficients of a collision, or of all in a model or link."""
        call('set_friction', SetFriction, name=name, mu=mu, mu2=mu2)
