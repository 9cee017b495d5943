"""Single steps, which Gazebo offers only by its own transport: a service of ours."""

from functools import partial

from rosbots_msgs.srv import Step, StepRequest, StepResponse

from ..server import Server
from .registry import EXTENSIONS, refuse, service

CHUNK = 20  # steps between which other services are served

_BUSY = 'Step: steps for another caller are being made; wait for their end'
_END = 'Step: simulated time ended after {} steps; call reset_simulation'


@service('step', Step, on_loop=False, table=EXTENSIONS)
def step(server: Server, request: StepRequest) -> StepResponse:
    """Advance paused time by exactly so many steps; the same steps give the same motion.

    They are made in small portions, so that no other service waits for all of them.
    """
    if not server.stepping.acquire(blocking=False):
        return refuse(StepResponse(sim_time=_now(server)), _BUSY)
    try:
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
    """Make steps, on the world's own thread; return how many, or None while time runs."""
    return server.world.run(steps) if server.world.paused else None


def _refusal(made: int) -> str:
    if made:
        return f'Step: somebody unpaused the simulation after {made} steps'
    return 'Step: the simulation is running; call pause_physics first'


def _now(server: Server) -> float:
    return server.loop.call(lambda: server.world.clock.now)
