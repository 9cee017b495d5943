"""What `gz` does on a running simulator, each command by the services of Gazebo's ROS interface."""

from __future__ import annotations

import argparse
import sys
import time
from collections import deque
from collections.abc import Callable, Sequence

import rospy
from gazebo_msgs import srv
from gazebo_msgs.msg import ModelState
from geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from rosbots_msgs.srv import Step
from std_srvs.srv import Empty

from ...sim.core import as_quaternion, from_rpy, to_rpy
from ..transport import topics_of
from . import service_program
from .model_source import SourceError, canonical_xml, read_file
from .service_program import NODE, START, Call, CommandError, Lines

PERIOD = 0.2  # of the lines of `gz stats`, as Gazebo's [s, wall]
SAMPLES = 20  # over which the real-time factor is taken, as in Gazebo


def run(command: str, flags: argparse.Namespace, ros_arguments: Sequence[str]) -> int:
    """Do a command of gz on the running simulator; return the exit code.

    Args:
        command: one of `COMMANDS`.
        flags: see cli.gz; positions in m, angles in rad.
        ros_arguments: ROS remappings.
    """
    act = COMMANDS[command]
    return service_program.run(f'gz {command}', lambda call: act(call, flags), ros_arguments)


def world(call: Call, flags: argparse.Namespace) -> Lines:
    """Pause or unpause, make steps, reset, in this order; steps pause first, as in Gazebo."""
    if flags.reset_time:
        raise CommandError(
            'time alone cannot be reset (-t); use -r for time and models, or -o '
            'for the models alone'
        )
    if flags.pause is not None:
        call('pause_physics' if flags.pause else 'unpause_physics', Empty)
    steps = (flags.multi_step or 0) + flags.step
    if steps:
        call('pause_physics', Empty)
        call('step', Step, steps=steps)
    if flags.reset_all:
        call('reset_simulation', Empty)
    elif flags.reset_models:
        call('reset_world', Empty)
    yield from ()


def model(call: Call, flags: argparse.Namespace) -> Lines:
    """List, show, spawn, move or delete models."""
    name = flags.model_name
    if flags.list:
        yield from call('get_world_properties', srv.GetWorldProperties).model_names
    elif flags.delete:
        call('delete_model', srv.DeleteModel, model_name=name)
    elif flags.spawn_file or flags.spawn_string:
        text = read_file(flags.spawn_file) if flags.spawn_file else _standard_input()
        call(
            'spawn_sdf_model',
            srv.SpawnModel,
            model_name=name,
            model_xml=canonical_xml(text),
            initial_pose=_pose(flags),
        )
    elif flags.info:
        yield from _info(call, name)
    elif flags.pose:
        yield _six_numbers(call('get_model_state', srv.GetModelState, model_name=name).pose)
    else:  # its velocity stays, as in Gazebo
        twist = call('get_model_state', srv.GetModelState, model_name=name).twist
        call(
            'set_model_state',
            srv.SetModelState,
            model_state=ModelState(model_name=name, pose=_pose(flags), twist=twist),
        )


def _standard_input() -> bytes:
    text = sys.stdin.buffer.read()
    if not text.strip():
        raise SourceError('standard input is empty; pipe an SDF into it')
    return text


def _pose(flags: argparse.Namespace) -> Pose:
    x, y, z, *angles = (getattr(flags, f'pose_{letter}') or 0.0 for letter in 'xyzRPY')
    return Pose(Point(x, y, z), Quaternion(*from_rpy(*angles)))


def _six_numbers(pose: Pose) -> str:
    """Return x y z roll pitch yaw with six digits after the point, as Gazebo prints poses."""
    # Read here, as `messages` imports the simulator, for a third of the time of a command.
    position, turn = pose.position, pose.orientation
    angles = to_rpy(as_quaternion((turn.x, turn.y, turn.z, turn.w)))
    numbers = (position.x, position.y, position.z, *angles)
    return ' '.join(f'{round(number, 6) + 0.0:g}' for number in numbers)  # no -0


def _info(call: Call, name: str) -> Lines:
    """Yield what is known of a model, in the form in which Gazebo prints its messages."""
    known = call('get_model_properties', srv.GetModelProperties, model_name=name)
    state = call('get_model_state', srv.GetModelState, model_name=name)
    yield f'name: "{name}"'
    yield f'is_static: {str(known.is_static).lower()}'
    yield 'pose {'
    for part in ('position', 'orientation'):
        vector = getattr(state.pose, part)
        yield f'  {part} {{'
        yield from (f'    {axis}: {getattr(vector, axis):.17g}' for axis in vector.__slots__)
        yield '  }'
    yield '}'
    for kind, names in (('joint', known.joint_names), ('link', known.body_names)):
        for inner in names:
            yield from (f'{kind} {{', f'  name: "{name}::{inner}"', '}')


def physics(call: Call, flags: argparse.Namespace) -> Lines:
    """Change the physics settings that were given; the others stay."""
    now = call('get_physics_properties', srv.GetPhysicsProperties)
    if flags.iters is not None:
        now.ode_config.sor_pgs_iters = flags.iters
    call(
        'set_physics_properties',
        srv.SetPhysicsProperties,
        time_step=_given(flags.step_size, now.time_step),
        max_update_rate=_given(flags.update_rate, now.max_update_rate),
        gravity=Vector3(*flags.gravity) if flags.gravity else now.gravity,
        ode_config=now.ode_config,
    )
    yield from ()


def _given(value: float | None, otherwise: float) -> float:
    return otherwise if value is None else value


def topic(_: Call, __: argparse.Namespace) -> Lines:
    """List the ROS topics that the simulator publishes or subscribes to."""
    found = topics_of(rospy.resolve_name(NODE))
    if not found:
        raise CommandError(f'there is no simulator; {START}')
    yield from found


def stats(
    call: Call,
    flags: argparse.Namespace,
    clock: Callable[[], float] = time.monotonic,
    sleep: Callable[[float], None] = time.sleep,
) -> Lines:
    """Yield real-time factor, simulated time, wall time since the start, and whether paused."""
    if flags.plot:
        yield '# real-time factor (percent), simtime (sec), realtime (sec), paused (T or F)'
    samples: deque[tuple[float, float]] = deque(maxlen=SAMPLES)
    begin = clock()
    while True:
        simulated = call('get_world_properties', srv.GetWorldProperties).sim_time
        real = clock() - begin
        if flags.duration is not None and real > flags.duration:
            return
        samples.append((simulated, real))
        paused = 'T' if call('get_physics_properties', srv.GetPhysicsProperties).pause else 'F'
        if len(samples) > 1:
            factor = real_time_factor(samples)
            if flags.plot:
                yield f'{factor:4.2f}, {simulated:16.6f}, {real:16.6f}, {paused}'
            else:
                yield (
                    f'Factor[{factor:4.2f}] SimTime[{simulated:4.2f}] '
                    f'RealTime[{real:4.2f}] Paused[{paused}]'
                )
        sleep(PERIOD)


def real_time_factor(samples: Sequence[tuple[float, float]]) -> float:
    """Return the mean real-time factor as Gazebo does: by the sums of the times since the first.

    Args:
        samples: simulated and real time [s]; at least two, at different real times.
    """
    first_simulated, first_real = samples[0]
    simulated = sum(sample - first_simulated for sample, _ in samples)
    return max(0.0, simulated / sum(sample - first_real for _, sample in samples))


COMMANDS: dict[str, Callable[[Call, argparse.Namespace], Lines]] = {
    'model': model,
    'physics': physics,
    'stats': stats,
    'topic': topic,
    'world': world,
}
