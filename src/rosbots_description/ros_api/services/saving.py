"""Save the world: a service that Gazebo does not have; it saves from its window only."""

from rosbots_msgs.srv import SaveWorld, SaveWorldRequest, SaveWorldResponse

from ...sim.description import WorldSpec
from ...sim.formats import sdf_of_world
from ...sim.resources import write_world
from ...sim.runtime import describe
from ..server import Server
from .registry import EXTENSIONS, service


@service('save_world', SaveWorld, on_loop=False, table=EXTENSIONS)
def save_world(server: Server, request: SaveWorldRequest) -> SaveWorldResponse:
    """Write the world as a world file, or return its text; the simulation goes on meanwhile."""
    spec = server.loop.call(lambda: describe(server.world))
    text = sdf_of_world(spec)
    if request.path:
        write_world(request.path, text, request.overwrite)
        text = ''
    return SaveWorldResponse(True, f'SaveWorld: {_summary(spec)}', text)


def _summary(spec: WorldSpec) -> str:
    done = f'saved {len(spec.models)} models at {spec.time:.3f} s'
    return f'{done}; not in it: {"; ".join(spec.faults)}' if spec.faults else done
