"""Services about joints: their state, their limits, and external efforts."""

from dataclasses import replace
from typing import Any

from gazebo_msgs import srv
from gazebo_msgs.msg import ODEJointProperties

from ...sim.description import JointSpec
from ...sim.runtime import Joint, World
from ..messages import RequestError, require_finite
from ..server import Server
from .registry import refuse, service

_UNLIMITED = 1e16  # a limit of at least this magnitude means none, as in SDF [rad or m]


@service('get_joint_properties', srv.GetJointProperties)
def get_joint_properties(
    server: Server, request: srv.GetJointPropertiesRequest
) -> srv.GetJointPropertiesResponse:
    """Return position [rad or m] and rate; type and damping stay empty, as in Gazebo."""
    response = srv.GetJointPropertiesResponse()
    joint = server.world.find_joint(request.joint_name)
    if joint is None and not _is_fixed(server.world, request.joint_name):
        return refuse(response, 'GetJointProperties: joint not found')
    position, rate = joint.state() if joint else (0.0, 0.0)
    response.position, response.rate = [position], [rate]
    response.success, response.status_message = True, 'GetJointProperties: got properties'
    return response


@service('set_joint_properties', srv.SetJointProperties)
def set_joint_properties(
    server: Server, request: srv.SetJointPropertiesRequest
) -> srv.SetJointPropertiesResponse:
    """Change limits, damping and motor of a joint; an empty array changes nothing.

    The other fields are parameters of ODE's solver and have no counterpart here.
    """
    require_finite(request)
    joint = server.world.find_joint(request.joint_name)
    if joint is not None:
        _change(joint, request.ode_joint_config)
    elif not _is_fixed(server.world, request.joint_name):
        return refuse(srv.SetJointPropertiesResponse(), 'SetJointProperties: joint not found')
    return srv.SetJointPropertiesResponse(True, 'SetJointProperties: properties set')


@service('apply_joint_effort', srv.ApplyJointEffort)
def apply_joint_effort(
    server: Server, request: srv.ApplyJointEffortRequest
) -> srv.ApplyJointEffortResponse:
    """Apply an effort [N m or N] from `start_time`, for `duration`; negative: without end."""
    require_finite(request)
    joint = server.world.find_joint(request.joint_name)
    if joint is not None:
        start, duration = request.start_time.to_nsec(), request.duration.to_nsec()
        server.world.external_forces.add(
            joint, lambda: joint.apply_effort(request.effort), start, duration
        )
    elif not _is_fixed(server.world, request.joint_name):
        return refuse(srv.ApplyJointEffortResponse(), 'ApplyJointEffort: joint not found')
    return srv.ApplyJointEffortResponse(True, 'ApplyJointEffort: effort set')


@service('clear_joint_forces', srv.JointRequest)
def clear_joint_forces(
    server: Server, request: srv.JointRequestRequest
) -> srv.JointRequestResponse:
    """Remove all efforts on joints of that unscoped name, in all models."""
    server.world.external_forces.cancel(
        lambda target: isinstance(target, Joint) and target.name == request.joint_name
    )
    return srv.JointRequestResponse()


def _is_fixed(world: World, name: str) -> bool:
    """Return whether a model has a fixed joint of that plain or scoped name."""
    return any(
        name in (joint.name, f'{model.name}::{joint.name}')
        for model in world.models.values()
        for joint in model.spec.joints
        if joint.name not in model.joints
    )


def _change(joint: Joint, config: ODEJointProperties) -> None:
    """Apply the fields that have a counterpart here; only the first axis of each array is used."""
    velocity, effort = changed_motor(joint.spec.name, joint.motor, config)
    given = {'damping': config.damping, 'lower': config.loStop, 'upper': config.hiStop}
    changes = {field: values[0] for field, values in given.items() if values}
    spec = changed_spec(joint.spec, changes)
    # Nothing above changes the joint, so a rejected request has no effect.
    if (velocity, effort) != joint.motor:
        joint.set_motor(velocity, effort)
    if spec != joint.spec:
        model = joint.model
        joints = tuple(spec if other is joint.spec else other for other in model.spec.joints)
        model.respecify(replace(model.spec, joints=joints))


def changed_motor(
    name: str, motor: tuple[float, float], config: ODEJointProperties
) -> tuple[float, float]:
    """Return the requested target velocity [rad/s or m/s] and maximum effort [N m or N].

    Raises:
        RequestError: the maximum effort is negative.

    """
    velocity = config.vel[0] if config.vel else motor[0]
    effort = config.fmax[0] if config.fmax else motor[1]
    if effort < 0.0:
        raise RequestError(
            f"fmax of joint '{name}' is {effort:g}; it must not be negative [N m or N]"
        )
    return velocity, effort


def changed_spec(spec: JointSpec, changes: dict[str, float]) -> JointSpec:
    """Return the joint with other limits or damping.

    Raises:
        RequestError: the lower limit is above the upper one, or damping is negative.

    """
    fields: dict[str, Any] = {
        name: None if name != 'damping' and abs(value) >= _UNLIMITED else value
        for name, value in changes.items()
    }
    changed = replace(spec, **fields)
    lower, upper = changed.lower, changed.upper
    if lower is not None and upper is not None and lower > upper:
        raise RequestError(f"loStop {lower:g} of joint '{spec.name}' is above hiStop {upper:g}")
    if changed.damping < 0.0:
        raise RequestError(
            f"damping of joint '{spec.name}' is {changed.damping:g}; it must not be negative"
        )
    return changed
