"""Services about links: their state, and external wrenches."""

from gazebo_msgs import srv

from ...sim.core import (
    IDENTITY,
    NotFoundError,
    Pose,
    Twist,
    Vector,
    add,
    compose,
    cross,
    rotate,
    subtract,
)
from ...sim.runtime import WORLD_FRAMES, Entity, Link, World
from ..messages import fill_pose, fill_twist, read_pose, read_twist, read_vector, require_finite
from ..server import Server
from .models import relative_state
from .registry import refuse, service

NO_LINK = 'link not found, did you forget to scope the link by model name?'
_NO_FRAME = (
    'GetLinkState: reference reference_frame not found, '
    'did you forget to scope the link by model name?'
)


def find_link(world: World, name: str) -> Link | None:
    """Return the link of that name; None if the first entity of that name is not a link."""
    entity = world.find_entity(name)
    return entity if isinstance(entity, Link) else None


@service('get_link_state', srv.GetLinkState)
def get_link_state(server: Server, request: srv.GetLinkStateRequest) -> srv.GetLinkStateResponse:
    """Return a link's pose and twist relative to an entity or the world."""
    world, response = server.world, srv.GetLinkStateResponse()
    link = find_link(world, request.link_name)
    if link is None:
        return refuse(response, f'GetLinkState: {NO_LINK}')
    try:
        frame = world.frame(request.reference_frame)
    except NotFoundError:
        return refuse(response, _NO_FRAME)
    pose, twist = relative_state(link.state(), frame)
    state = response.link_state
    state.link_name, state.reference_frame = request.link_name, request.reference_frame
    fill_pose(state.pose, pose)
    fill_twist(state.twist, twist)
    response.success, response.status_message = True, 'GetLinkState: got state'
    return response


@service('set_link_state', srv.SetLinkState)
def set_link_state(server: Server, request: srv.SetLinkStateRequest) -> srv.SetLinkStateResponse:
    """Set a link's pose and velocity, given in the frame of a link or the world.

    As in Gazebo v = v_given - v_frame, without a rotation.
    """
    require_finite(request)
    state = request.link_state
    link = find_link(server.world, state.link_name)
    if link is None:
        return refuse(srv.SetLinkStateResponse(), 'SetLinkState: link does not exist')
    try:
        frame = _frame_entity(server.world, state.reference_frame)
    except NotFoundError:
        return refuse(srv.SetLinkStateResponse(), 'SetLinkState: failed')
    if not isinstance(frame, Link | None):
        return refuse(srv.SetLinkStateResponse(), 'SetLinkState: failed')
    frame_pose, frame_twist = frame.state() if frame else (IDENTITY, Twist())
    given = read_twist(state.twist)
    twist = Twist(
        subtract(given.linear, frame_twist.linear), subtract(given.angular, frame_twist.angular)
    )
    pose = compose(frame_pose, read_pose(state.pose))
    link.model.move_link(link, pose, Twist() if link.model.static else twist)
    return srv.SetLinkStateResponse(True, 'SetLinkState: success')


@service('apply_body_wrench', srv.ApplyBodyWrench)
def apply_body_wrench(
    server: Server, request: srv.ApplyBodyWrenchRequest
) -> srv.ApplyBodyWrenchResponse:
    """Apply a wrench to a link from `start_time`, for `duration`; negative: without end."""
    require_finite(request)
    world = server.world
    link = find_link(world, request.body_name)
    if link is None:
        return refuse(srv.ApplyBodyWrenchResponse(), 'ApplyBodyWrench: body does not exist')
    try:
        frame = _frame_entity(world, request.reference_frame)
    except NotFoundError:
        return refuse(srv.ApplyBodyWrenchResponse(), 'ApplyBodyWrench: reference_frame not found')
    force, torque = world_wrench(
        read_vector(request.wrench.force),
        read_vector(request.wrench.torque),
        read_vector(request.reference_point),
        frame.state()[0] if frame else None,
        link.pose,
    )
    start, duration = request.start_time.to_nsec(), request.duration.to_nsec()
    world.external_forces.add(link, lambda: link.apply_wrench(force, torque), start, duration)
    return srv.ApplyBodyWrenchResponse(success=True)


@service('clear_body_wrenches', srv.BodyRequest)
def clear_body_wrenches(server: Server, request: srv.BodyRequestRequest) -> srv.BodyRequestResponse:
    """Remove all wrenches on the link of that scoped name."""
    server.world.external_forces.cancel(
        lambda target: isinstance(target, Link) and target.scoped_name == request.body_name
    )
    return srv.BodyRequestResponse()


def world_wrench(
    force: Vector, torque: Vector, point: Vector, frame: Pose | None, body: Pose
) -> tuple[Vector, Vector]:
    """Return a wrench as force [N] and torque [N m] on a body, in world axes.

    Args:
        force: in the axes of the frame, acting at `point`.
        torque: in the axes of the frame.
        point: in the frame [m]; without a frame, relative to the body.
        frame: pose of the frame in the world; None: force and torque are in world axes.
        body: pose of the link in the world.

    Upstream rotates the wrench into the body's axes and then applies it in world axes; this follows
    its documentation instead.
    """
    torque = add(torque, cross(point, force))
    if frame is None:
        return force, torque
    force = rotate(frame.orientation, force)
    arm = subtract(frame.position, body.position)
    return force, add(rotate(frame.orientation, torque), cross(arm, force))


def _frame_entity(world: World, name: str) -> Entity | None:
    """Return the entity that a reference frame names; None for the world, by one of its names.

    Raises:
        NotFoundError: nothing in the world has that name.

    """
    entity = world.find_entity(name)
    if entity is None and name not in WORLD_FRAMES:
        raise NotFoundError(f"there is no model, link or collision named '{name}'")
    return entity
