"""Single steps: a service that Gazebo does not have; it offers them only by its own transport."""

import logging
from functools import partial

from rosbots_msgs.srv import Step, StepRequest, StepResponse

from ..server import Server
from ..transport import subscribed_connections, wait_for_delivery
from .registry import EXTENSIONS, refuse, service

logger = logging.getLogger(__name__)

CHUNK = 20  # steps between which other services are served

_BUSY = 'Step: another caller is stepping the simulation; wait until it is done'
_LATE = 'Step: a message that came before is still being handled; the steps do not wait any longer'
_END = 'Step: simulated time ended after {} steps; call reset_simulation'


@service('step', Step, on_loop=False, table=EXTENSIONS)
def step(server: Server, request: StepRequest) -> StepResponse:
    """Make exactly the requested number of steps while paused.

    They are made in small portions, so that other services respond in between. Messages that have
    arrived before, such as commands, take effect from the first step on; a warning says if one has
    not been handled after some seconds.
    """
    if not server.stepping.acquire(blocking=False):
        return refuse(StepResponse(sim_time=_now(server)), _BUSY)
    try:
        if not wait_for_delivery(subscribed_connections()):
            logger.warning(_LATE)
        made = 0
        while True:
            portion = min(CHUNK, request.steps - made)
            advanced = server.loop.call(partial(_make, server, portion))
            if advanced is None:
                return refuse(StepResponse(sim_time=_now(server)), _refusal(made))
            made += advanced
            if advanced < portion:
                return refuse(StepResponse(sim_time=_now(server)), _END.format(made))
            if made == request.steps:
                return StepResponse(True, f'Step: made {made} steps', _now(server))
    finally:
        server.stepping.release()


def _make(server: Server, steps: int) -> int | None:
    """Make steps, on the world's own thread; return how many, or None if it is not paused."""
    return server.world.run(steps) if server.world.paused else None


def _refusal(made: int) -> str:
    if made:
        return f'Step: the simulation was unpaused after {made} steps'
    return 'Step: the simulation is running; call pause_physics first'


def _now(server: Server) -> float:
    return server.loop.call(lambda: server.world.clock.now)
