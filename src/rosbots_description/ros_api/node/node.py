"""The node /gazebo: a world, the loop that owns it, and everything that connects it to ROS.

Parameters:
    ~enable_ros_network (bool, true): false leaves only /clock, the time parameter and plugins.
    ~enable_performance_metrics (bool, false): true adds the topic ~performance_metrics.
    ~extensions (bool, true): false leaves out all topics and services that Gazebo does not have.
    ~strict (bool, false): true brings back flaws of Gazebo that a client may rely on.
    ~pub_clock_frequency (int, 0) [Hz]: how often /clock is published; 0: at every step.
    /use_sim_time is set to true if nobody has set it.
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

from ...sim.description import WorldSpec
from ...sim.meshes import load_readers
from ...sim.physics import CrashSandbox
from ...sim.runtime import World
from .. import adapters, services  # noqa: F401  both register what they hold
from ..adapters import Adapters
from ..server import Loop, Server
from ..services import EXTENSIONS, SERVICES, advertise
from ..topics import advertise_clock, advertise_performance, advertise_states, subscribe_states
from ..transport import (
    Outlets,
    Registrar,
    connect_logging,
    guard_handshakes,
    guard_messages,
    holder,
    init_node,
    is_master_there,
    leave_rosout,
    node_name,
    require_address,
    require_free,
    set_level,
    successor,
    wait_for_answers,
    watch_master,
)
from ..views.frames import advertise_frames
from ..views.overview_picture import advertise_view
from ..views.visuals import advertise_visuals
from .packages import find_model, find_package
from .world_loading import fill_world, held_records, read_world, replay

logger = logging.getLogger(__name__)

NAME = 'gazebo'
LAST_ANSWERS = 1.0  # how long requests are answered after the last step [s, wall]
MASTER_PERIOD = 0.5  # time between two looks for a master [s, wall]
REMINDER = 10.0  # time between two warnings that there is none [s, wall]
# A callback thread that computes may keep the loop waiting for this long [s]; Python's own 5 ms
# would be five steps.
SWITCH_INTERVAL = 0.0005


@dataclass(frozen=True)
class Options:
    """What the command line says about a run."""

    world: str  # its file, by path or as it is called along the search path
    paused: bool = False
    steps: int | None = None  # make so many, then end; None: until told to stop
    remarks: tuple[tuple[int, str], ...] = ()  # what to log at start: level and text
    verbose: bool = False  # log debug messages too
    replace: bool = False  # end the simulator that has this one's name
    seed: int = 0  # of the noise of sensors


def run(options: Options, ros_arguments: Sequence[str] = ()) -> int:
    """Be the node until it is told to stop; return the exit code.

    Args:
        options: what to simulate and how.
        ros_arguments: name remappings and parameters as ROS writes them, e.g. `__name:=gazebo`.

    Raises:
        SimError: the world cannot be read, there can be no master, or a simulator runs on it, and
            nothing has been done; or a model of the world cannot be brought in, and the node has
            been shut down again.

    """
    _on_signals(signal.default_int_handler)
    with held_records() as records:
        spec = read_world(options.world)
    try:
        # The sandbox is a copy of this process before there are threads and connections.
        with closing(World()) as world, CrashSandbox(world.engine) as sandbox:
            _wait_for_master()
            _take_name(node_name(NAME, ros_arguments), options.replace)
            guard_handshakes()
            guard_messages()
            outlets = Outlets()
            outlets.serve_publishers()
            init_node(
                NAME,
                ros_arguments,
                disable_signals=True,  # the loop is stopped between two steps
                disable_rostime=True,  # see log_bridge
            )
            loop = Loop(world, outlets.gathered)
            server = Server(world, loop, Registrar(), find_package, find_model, sandbox)
            _simulate(options, spec, records, server)
    except (KeyboardInterrupt, rospy.ROSInterruptException):
        return 0
    finally:
        rospy.signal_shutdown('the simulator ends')
    return 0


def _simulate(
    options: Options, spec: WorldSpec, records: list[logging.LogRecord], server: Server
) -> None:
    world, loop = server.world, server.loop
    _on_signals(lambda _signal, _frame: loop.stop())
    rospy.on_shutdown(lambda: _end(loop))
    connect_logging(lambda: world.clock.now_ns)
    if options.verbose:
        set_level('debug')
    sys.setswitchinterval(SWITCH_INTERVAL)
    for level, text in options.remarks:
        logger.log(level, '%s', text)
    replay(records)
    world.paused, world.seed = options.paused, options.seed
    _connect(server, spec)
    watch_master(server.registrar, server.parameters)
    gc.freeze()  # else each full collection looks at all modules, for tens of steps
    gc.collect()  # else the next waits until a quarter of all those objects has come anew
    loop.run(options.steps)
    wait_for_answers(LAST_ANSWERS)


def _connect(server: Server, spec: WorldSpec) -> None:
    """Offer everything, in the order in which Gazebo does."""
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
            server.static_frames.watch(server.loop)
    server.world.listeners.append(Adapters(server))
    fill_world(server.world, spec)
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
    """Offer dynamic_reconfigure last; loading its library must not keep the world waiting."""
    from ..reconfigure.physics import advertise_reconfigure

    advertise_reconfigure(server)


def _wait_for_master() -> None:
    """Wait for a ROS master, complaining as Gazebo does; nothing of ROS's logging works yet.

    Raises:
        SimError: there can be none at the address that is given.
    """
    require_address()
    reminder = time.monotonic()
    while not is_master_there(f'/{NAME}'):
        if time.monotonic() >= reminder:
            _warn('No ROS master - start roscore to continue...')
            reminder += REMINDER
        time.sleep(MASTER_PERIOD)


def _take_name(name: str, replace: bool) -> None:
    """See to it that no simulator loses its name by accident.

    Raises:
        SimError: one has that name, and it is not to be replaced.
    """
    if not replace:
        require_free(name)
    elif other := holder(name):
        _warn(f'this simulator takes the place of the node {name}, {other}')


def _end(loop: Loop) -> None:
    """Stop the loop since the node shuts down; say so if another simulator has its name."""
    if not loop.stopping:  # told by the master or by rosnode kill
        name = rospy.get_name()
        if other := successor(name, rospy.get_node_uri()):
            leave_rosout()
            logger.warning('this simulator ends: %s has taken over the name %s', other, name)
        loop.stop()


def _warn(text: str) -> None:
    """Warn before rospy's logging works."""
    sys.stderr.write(f'[WARN] [{time.time():f}]: {text}\n')


def _on_signals(react: Callable[[int, FrameType | None], object]) -> None:
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, react)
