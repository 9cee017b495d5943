"""Repeat drives recorded in Gazebo, and measure the motion in the same way."""

import math
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import AbstractContextManager
from typing import NamedTuple

from rosbots_description.sim.core.transforms import Pose, relative, rotate, yaw_of
from rosbots_description.sim.description.model_spec import ModelSpec
from rosbots_description.sim.formats.urdf.urdf import load_urdf
from rosbots_description.sim.physics.bullet.tuning import Tuning
from rosbots_description.sim.runtime.world import World

from . import empty_world, robot_spec
from .converged import mechanics
from .mechanics import DRIVES
from .recorded import DATA, Difference, load

ROBOTS = ('article', 'burger', 'box4', 'skid4', 'planar', 'tricycle')
MOTORED = ('article', 'burger', 'box4', 'skid4', 'tricycle')  # driven by motors in joints
REST = 3.0  # [s] after the end of a command
STEADY = ('v', 'lateral', 'w', 'odom_vx', 'odom_wz')  # steady speeds, beside those of wheels
SUMS = ('end_yaw', 'yaw')  # what adds up from them, beside places
STEADY_FROM = 1.0  # [s] after the start of a command
REACHED = 0.9  # share of the steady speed
STOPPED = 0.05  # share of the steady speed
ROW = 20  # steps between the rows of a recording
IDLE = 20.0  # [s]

# Tolerances relative to Gazebo's values, with lower bounds (floors). A steady speed must be within
# SPEED_SHARE of the interval between Gazebo's value and that of mechanics (converged.py); so are
# headings and places, to which it adds up.
SPEED_SHARE = 0.03  # of a steady speed, an angle turned, a wheel speed
PLACE_SHARE = 0.04  # of the displacement
TIME_SHARE, TIME_FLOOR = 0.05, 0.03  # of a rise or stopping time; [s], more than one row
RIM_SHARE = 0.01  # of the fastest rim speed: floor of forward and lateral speeds
WAY_SHARE = 0.005  # of the distance of the fastest rim: floor of positions
VEER_RATE, VEER = 0.002, 0.01  # [rad/s], [rad] floor of the heading drift in a straight drive
WHEEL_FLOOR = 0.05  # [rad/s]
HEIGHT, PITCH = 0.001, 0.002  # [m], [rad]
CREEP, CREEP_TURN = 0.0005, 0.0005  # [m], [rad] in 20 s at rest

MakeWorld = Callable[[Tuning | None], AbstractContextManager[World]]
Command = tuple[float, float, float, float]  # time [s], vx, vy [m/s], yaw rate [rad/s]


class Robot(NamedTuple):
    """A robot as it was spawned in Gazebo."""

    spec: ModelSpec
    spawn_z: float  # [m]
    settled: int  # steps before the first command
    arm: float  # lever arm: rim speed per yaw rate [m]


class Sample(NamedTuple):
    """Pose of a robot in its frame at the first command, and its velocity.

    Odometry is the latest reading: x, y, forward, turning. Wheels are in the order of the model.
    """

    time: float  # [s] since the first command
    x: float  # [m]
    y: float  # [m]
    yaw: float  # [rad], unwrapped
    z: float  # [m], in the world
    pitch: float  # [rad]
    forward: float  # [m/s]
    lateral: float  # [m/s] to the left
    turning: float  # [rad/s]
    odometry: tuple[float, float, float, float]
    wheels: dict[str, float]  # speed of each joint [rad/s]


def robot(name: str) -> Robot:
    """Return a recorded robot by name."""
    data = load(name)
    if name == 'article':
        spec = robot_spec()
    else:
        text = (DATA / 'robots' / data['robot']).read_text(encoding='utf-8')
        spec, _ = load_urdf(text, name, robot_namespace='/')
    return Robot(spec, data['spawn_z'], round(1000 * data['settled']), data['arm'])


def drive(
    one: Robot,
    commands: Sequence[Command],
    duration: float,
    tuning: Tuning | None = None,
    make_world: MakeWorld = empty_world,
    sampled: Collection[int] = (),
) -> list[Sample]:
    """Return the motion from the first command on.

    Args:
        sampled: the milliseconds after which it is noted, from 0 on in order; by default each. A
            step takes a third of the time if its motion is not noted, and moves to the same bit.
    """
    with make_world(tuning) as world:
        model = world.spawn(one.spec, 'robot', Pose((0.0, 0.0, one.spawn_z)))
        latest = [Pose(), (0.0, 0.0)]

        def on_odometry(reading) -> None:
            latest[:] = reading.pose, (reading.twist.linear[0], reading.twist.angular[2])

        if model.plugins:
            next(iter(model.plugins.values())).odometry.connect(on_odometry)
        world.run(one.settled)
        odometry_start = latest[0]
        start, yaw, samples, waiting, made = None, 0.0, [], list(commands), 0
        for k in sampled or range(round(duration * 1000) + 1):
            while waiting and k >= (at := round(1000 * waiting[0][0])):
                world.run(at - made)
                made = at
                _, x, y, w = waiting.pop(0)
                for plugin in model.plugins.values():
                    plugin.command(x, w, y)
            world.run(k + 1 - made)
            made = k + 1
            pose, ((vx, vy, _), (_, _, turning)) = model.state()
            start = start or pose
            moved, heading = relative(pose, start), yaw_of(pose.orientation)
            yaw += math.remainder(yaw_of(moved.orientation) - yaw, math.tau)
            cos, sin = math.cos(heading), math.sin(heading)
            measured = relative(latest[0], odometry_start).position
            samples.append(
                Sample(
                    k / 1000.0,
                    *moved.position[:2],
                    yaw,
                    pose.position[2],
                    -math.asin(max(-1.0, min(1.0, rotate(pose.orientation, (1.0, 0.0, 0.0))[2]))),
                    cos * vx + sin * vy,
                    cos * vy - sin * vx,
                    turning,
                    (*measured[:2], *latest[1]),
                    {name: joint.velocity for name, joint in model.joints.items()},
                )
            )
        return samples


def drive_as_recorded(
    name: str,
    command: str,
    tuning: Tuning | None = None,
    make_world: MakeWorld = empty_world,
    each_step: bool = False,
) -> list[Sample]:
    """Return the motion of a recorded robot for a command, until it is at rest.

    It is noted at the rows and in the trace of the recording, or after each step.
    """
    data = load(name)['drives'][command]
    seconds = data['seconds']
    commands = [(0.0, *data['command']), (seconds, 0.0, 0.0, 0.0)]
    rows = range(0, round(1000 * (seconds + REST)) + 1, ROW)
    traced = (round(1000 * time) for time, *_ in data['trace'])
    sampled = () if each_step else sorted({*rows, *traced})
    return drive(robot(name), commands, seconds + REST, tuning, make_world, sampled)


def samples_at(samples: Sequence[Sample], trace: Sequence[Sequence[float]]) -> list[Sample]:
    """Return the samples at the times of a recorded trace."""
    by_step = {round(1000 * sample.time): sample for sample in samples}
    return [by_step[round(1000 * time)] for time, *_ in trace]


def measure(samples: Sequence[Sample], seconds: float) -> dict[str, float]:
    """Return the quantities of a recording for a command that ended after `seconds`."""
    rows = [sample for sample in samples if round(1000 * sample.time) % ROW == 0]
    steady = [row for row in rows if STEADY_FROM <= row.time < seconds]
    end, rest = next(row for row in rows if row.time >= seconds), rows[-1]

    def mean(value) -> float:
        return sum(map(value, steady)) / len(steady)

    found = {
        'v': mean(lambda row: row.forward),
        'lateral': mean(lambda row: row.lateral),
        'w': mean(lambda row: row.turning),
        'odom_vx': mean(lambda row: row.odometry[2]),
        'odom_wz': mean(lambda row: row.odometry[3]),
        'end_x': end.x, 'end_y': end.y, 'end_yaw': end.yaw,
        'x': rest.x, 'y': rest.y, 'yaw': rest.yaw, 'z': rest.z, 'pitch': rest.pitch,
        'odom_x': rest.odometry[0], 'odom_y': rest.odometry[1],
    }  # fmt: skip
    for key, field in (('v', 'forward'), ('w', 'turning')):
        full = abs(found[key])
        speeds = [(row.time, abs(getattr(row, field))) for row in rows]
        found[f't90_{key}'] = next(t for t, speed in speeds if speed >= REACHED * full)
        found[f'stop_{key}'] = max(
            (t - seconds for t, speed in speeds if t >= seconds and speed > STOPPED * full),
            default=0.0,
        )
    for joint in steady[0].wheels:
        found[joint] = mean(lambda row, joint=joint: row.wheels[joint])
    return found


def compare_drive(
    name: str, command: str, tuning: Tuning | None = None, samples: Sequence[Sample] = ()
) -> list[Difference]:
    """Return the differences in all recorded quantities of a drive."""
    data, arm = load(name)['drives'][command], load(name)['arm']
    samples = samples or drive_as_recorded(name, command, tuning)
    gazebo, ours = dict(data['quantities']), measure(samples, data['seconds'])
    scene = f'{name} {command}'
    *_, turning = data['command']
    rim = math.hypot(gazebo['v'], gazebo['lateral']) + abs(gazebo['w']) * arm
    floor = WAY_SHARE * rim * data['seconds']
    solved = mechanics().get(scene, {}).get('quantities', {})
    found = []

    def add(quantity: str, unit: str, *values, least: bool = False) -> None:
        between = quantity in (*STEADY, *SUMS, *data.get('wheels', ()))
        predicted = solved.get(quantity) if between else None
        found.append(Difference(scene, quantity, unit, *values, least, mechanics=predicted))

    for keys in (('end_x', 'end_y'), ('x', 'y'), ('odom_x', 'odom_y')):
        if keys[0] in gazebo:
            theirs, own = ([values[key] for key in keys] for values in (gazebo, ours))
            # The distance between both positions, as one number.
            reach = max(PLACE_SHARE * math.hypot(*theirs), floor)
            quantity = keys[0].removesuffix('_x').replace('x', 'rest') + ' place'
            predicted = [solved.get(key, gazebo[key]) for key in keys]
            add(quantity, 'm', 0.0, _beside(own, theirs, predicted), reach)
            for key in keys:
                del gazebo[key]
    for key, theirs in gazebo.items():
        unit, tolerance = _tolerance(key, theirs, rim, bool(turning))
        veers = unit.startswith('rad') and not turning and key != 'pitch'
        add(key, unit, theirs, ours[key], tolerance, least=veers)
    for joint, speed in data.get('wheels', {}).items():
        tolerance = max(SPEED_SHARE * abs(speed), WHEEL_FLOOR)
        add(joint, 'rad/s', speed, ours[joint], tolerance)
    for one, quantity, value, reason in DRIVES:
        if one == scene:
            tolerance = _tolerance(quantity, value, rim, bool(turning))
            found.append(
                Difference(
                    scene,
                    quantity,
                    tolerance[0],
                    value,
                    ours[quantity],
                    tolerance[1],
                    reference='mechanics',
                    reason=reason,
                )
            )
    return found + list(_compare_paths(scene, data, samples, floor))


def _tolerance(key: str, theirs: float, rim: float, turns: bool) -> tuple[str, float]:
    """Return unit and tolerance of a quantity."""
    share = SPEED_SHARE * abs(theirs)
    if key in ('w', 'odom_wz'):
        return 'rad/s', share if turns else max(abs(theirs), VEER_RATE)
    if key in ('yaw', 'end_yaw'):
        return 'rad', share if turns else max(abs(theirs), VEER)
    if key.startswith(('t90', 'stop')):
        return 's', max(TIME_SHARE * theirs, TIME_FLOOR)
    if key in ('z', 'pitch'):
        return ('m', HEIGHT) if key == 'z' else ('rad', PITCH)
    return 'm/s', max(share, RIM_SHARE * rim)


def _compare_paths(
    scene: str, data: dict, samples: Sequence[Sample], floor: float
) -> Iterator[Difference]:
    """Yield the largest differences of path and heading."""
    apart = turned = 0.0
    solved = mechanics().get(scene, {}).get('trace', data['trace'])
    traced = samples_at(samples, data['trace'])
    for (_, x, y, yaw), (_, *place, heading), sample in zip(
        data['trace'], solved, traced, strict=True
    ):
        apart = max(apart, _beside((sample.x, sample.y), (x, y), place))
        turned = max(turned, min(yaw, heading) - sample.yaw, sample.yaw - max(yaw, heading))
    reach = max(math.hypot(x, y) for _, x, y, _ in data['trace'])
    most = max(abs(yaw) for *_, yaw in data['trace'])
    turns = bool(data['command'][2])
    tolerance = SPEED_SHARE * most
    yield Difference(scene, 'path', 'm', 0.0, apart, max(PLACE_SHARE * reach, floor))
    if turns:  # otherwise the final yaw is compared
        yield Difference(scene, 'heading', 'rad', 0.0, turned, tolerance)


def _beside(place: Sequence[float], one: Sequence[float], other: Sequence[float]) -> float:
    """Return the distance of a place from the way between two others [m]; all x and y."""
    (px, py), (x, y), (dx, dy) = place, one, (b - a for a, b in zip(one, other, strict=True))
    share = ((px - x) * dx + (py - y) * dy) / (dx * dx + dy * dy or 1.0)
    share = max(0.0, min(1.0, share))
    return math.hypot(px - x - share * dx, py - y - share * dy)


def compare_idle(name: str) -> list[Difference]:
    """Return how far a standing robot drifts; in Gazebo it creeps."""
    idle = load(name).get('idle')
    if idle is None:
        return []
    rows = range(0, round(1000 * IDLE) + 1, ROW)
    samples = drive(robot(name), [], IDLE, sampled=rows)
    last, scene = samples[-1], f'{name} idle 20 s'
    way = math.hypot(idle['dx'], idle['dy'])
    most = max(CREEP, way)  # the tricycle coasts: its plugin commands the measured speed
    return [
        Difference(scene, 'way', 'm', way, math.hypot(last.x, last.y), most, True),
        Difference(scene, 'yaw', 'rad', idle['dyaw'], last.yaw, CREEP_TURN, True),
        Difference(scene, 'z', 'm', idle['z'], last.z, HEIGHT),
    ]


def ramp_delays(
    samples: Sequence[Sample], speeds: Sequence[Sequence[float]], start: float, rising: bool
) -> list[float]:
    """Return the delays against Gazebo at which the recorded speeds are passed [s].

    Args:
        speeds: recorded pairs of time since `start` [s] and forward speed [m/s].
        start: of the ramp [s].
        rising: whether the speed increases.
    """
    passing = [sample for sample in samples if sample.time > start]
    return [
        next(s.time for s in passing if (s.forward >= speed if rising else s.forward <= speed))
        - start
        - time
        for time, speed in speeds
    ]
