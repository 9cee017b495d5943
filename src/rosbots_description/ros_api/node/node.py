"""The node /gazebo: a world, the loop that owns it, and its ROS interface.

Parameters:
    ~enable_ros_network (bool, true): false leaves only /clock, the time parameter and plugins.
    ~enable_performance_metrics (bool, false): true adds the topic ~performance_metrics.
    ~extensions (bool, true): false leaves out all topics and services that Gazebo does not have.
    ~strict (bool, false): true brings back flaws of Gazebo that a client may rely on.
    ~pub_clock_frequency (int, 0) [Hz]: how often /clock is published; 0: at every step.
    /use_sim_time (bool): set to true if it is not set.
"""

import gc
import logging
import signal
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass
from types import FrameType

import rospy

from ...sim.core import Fault, reporting_to
from ...sim.description import WorldSpec
from ...sim.meshes import load_readers
from ...sim.physics import CrashSandbox, EngineFactory, make_engine
from ...sim.runtime import World, populate
from .. import adapters, services  # noqa: F401  both register what they hold
from ..adapters import Adapters
from ..server import Loop, Server
from ..services import EXTENSIONS, SERVICES, advertise
from ..topics import advertise_clock, advertise_performance, advertise_states, subscribe_states
from ..transport import (
    BatchedPublishing,
    FaultLog,
    Registrar,
    connect_logging,
    free_name,
    guard_handshakes,
    guard_messages,
    init_node,
    is_master_running,
    node_name,
    replacing_node,
    require_address,
    running_node,
    set_level,
    wait_for_answers,
    watch_master,
)
from ..views.contacts import advertise_contacts
from ..views.frames import advertise_frames
from ..views.overview_picture import advertise_view
from ..views.scene import advertise_scene
from ..views.visuals import advertise_visuals
from .packages import find_file, find_model, find_package
from .world_loading import read_world

logger = logging.getLogger(__name__)

NAME = 'gazebo'
LAST_ANSWERS = 1.0  # time to finish pending requests after the last step [s, wall]
MASTER_PERIOD = 0.5  # period of looking for a master [s, wall]
REMINDER = 10.0  # period of the warning that there is none [s, wall]
# The longest time a computing callback thread can block the loop [s]; Python's default of 5 ms
# would be five steps.
SWITCH_INTERVAL = 0.0005


@dataclass(frozen=True)
class Options:
    """The options of a run, from the command line."""

    world: str  # its file: a path, or a name on the search path
    paused: bool = False
    steps: int | None = None  # number of steps to make; None: until stopped
    remarks: tuple[tuple[int, str], ...] = ()  # messages to log at start: level and text
    verbose: bool = False  # log debug messages too
    replace: bool = False  # shut down a simulator with the same node name
    seed: int = 0  # of the noise of sensors


def run(
    options: Options,
    ros_arguments: Sequence[str] = (),
    make_engine: EngineFactory = make_engine,
) -> int:
    """Run the node until it is stopped; return the exit code.

    Args:
        options: what to simulate and how.
        ros_arguments: ROS name remappings and parameters, e.g. `__name:=gazebo`.
        make_engine: makes the physics engine.

    Raises:
        SimError: the world cannot be read, the address of the master is invalid, or a simulator is
            already running on it, and no node was started; or the world cannot be populated, and
            the node was shut down again.

    """
    _on_signals(signal.default_int_handler)
    faults: list[Fault] = []  # until there is a log
    with reporting_to(faults.append):
        spec = read_world(options.world)
    try:
        # The sandbox forks this process before it has threads and connections.
        with (
            closing(World(make_engine=make_engine)) as world,
            CrashSandbox(world.engine, make_engine) as sandbox,
        ):
            _wait_for_master()
            _take_name(node_name(NAME, ros_arguments), options.replace)
            guard_handshakes()
            guard_messages()
            publishing = BatchedPublishing()
            publishing.serve_publishers()
            init_node(
                NAME,
                ros_arguments,
                disable_signals=True,  # the loop is stopped between two steps
                disable_rostime=True,  # see log_bridge
            )
            loop = Loop(world, publishing.batched)
            server = Server(world, loop, Registrar(), find_package, find_model, sandbox, find_file)
            _simulate(options, spec, faults, server)
    except (KeyboardInterrupt, rospy.ROSInterruptException):
        return 0
    finally:
        rospy.signal_shutdown('the simulator ends')
    return 0


def _simulate(options: Options, spec: WorldSpec, faults: list[Fault], server: Server) -> None:
    world, loop = server.world, server.loop
    _on_signals(lambda _signal, _frame: loop.stop())
    rospy.on_shutdown(lambda: _end(loop))
    connect_logging(lambda: world.clock.now_ns)
    if options.verbose:
        set_level('debug')
    sys.setswitchinterval(SWITCH_INTERVAL)
    for level, text in options.remarks:
        logger.log(level, '%s', text)
    world.faults.on_fault = FaultLog()
    for fault in faults:
        world.faults.add(fault)
    world.paused, world.seed = options.paused, options.seed
    _connect(server, spec)
    watch_master(server.registrar, server.parameters)
    gc.freeze()  # otherwise each full collection scans all modules, which takes tens of steps
    gc.collect()  # otherwise the next one waits until the number of objects has grown by a quarter
    loop.run(options.steps)
    wait_for_answers(LAST_ANSWERS)


def _connect(server: Server, spec: WorldSpec) -> None:
    """Advertise all topics and services, in Gazebo's order."""
    networked = rospy.get_param('~enable_ros_network', True)
    extensions = networked and rospy.get_param('~extensions', True)
    server.world.strict = rospy.get_param('~strict', False)
    logger.info('Finished loading Gazebo ROS API Plugin.')
    advertise_clock(server)
    if networked:
        advertise_states(server)
        advertise_performance(server)
        if extensions:
            advertise_visuals(server)
            advertise_view(server)
            advertise_frames(server)
            advertise_scene(server)
            advertise_contacts(server)
            server.static_frames.watch(server.loop)
    server.world.listeners.append(Adapters(server))
    populate(server.world, spec)
    server.parameters.append(_use_simulated_time)
    _use_simulated_time()
    if networked:
        subscribe_states(server)
        advertise(server, SERVICES)
        if extensions:
            advertise(server, EXTENSIONS)
        server.registrar.post(lambda: _advertise_reconfigure(server))
    server.registrar.post(load_readers)


def _use_simulated_time() -> None:
    if not rospy.has_param('/use_sim_time'):
        rospy.set_param('/use_sim_time', True)


def _advertise_reconfigure(server: Server) -> None:
    """Advertise dynamic_reconfigure last; importing its library must not block the world."""
    from ..reconfigure.physics import advertise_reconfigure

    advertise_reconfigure(server)


def _wait_for_master() -> None:
    """Wait for a ROS master, with Gazebo's warning; ROS logging does not work yet.

    Raises:
        SimError: ROS_MASTER_URI is invalid, or something else than a ROS master answers there.
    """
    require_address()
    reminder = time.monotonic()
    while not is_master_running(f'/{NAME}'):
        if time.monotonic() >= reminder:
            _warn('No ROS master - start roscore to continue...')
            reminder += REMINDER
        time.sleep(MASTER_PERIOD)


def _take_name(name: str, replace: bool) -> None:
    """Make sure that no running simulator is shut down by accident.

    Raises:
        SimError: a running node has that name, and `replace` is false.
    """
    if replace and (other := running_node(name)):
        _warn(f'this simulator replaces the node {name}, {other}')
    else:
        free_name(name)


def _end(loop: Loop) -> None:
    """Stop the loop at node shutdown; warn if another simulator has taken the name."""
    if not loop.stopping:  # shut down by the master or by rosnode kill
        name = rospy.get_name()
        if other := replacing_node(name, rospy.get_node_uri()):
            logger.warning('this simulator ends: %s has taken over the name %s', other, name)
        loop.stop()


def _warn(text: str) -> None:
    """Warn before rospy's logging works."""
    sys.stderr.write(f'[WARN] [{time.time():f}]: {text}\n')


def _on_signals(react: Callable[[int, FrameType | None], object]) -> None:
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, react)
