"""Maps and what navigation publishes, while it is looked at; and the true map."""

import numpy as np

from ...sim.core import Pose
from ...sim.description import ShownGrid, ShownReading
from ..clients.save_map import true_map
from ..messages import MAP_TYPES, map_cells
from .readings import RosReadings
from .topic_graph import TopicGraph
from .worlds import RosWorlds

OCCUPIED = 100  # as in nav_msgs/OccupancyGrid


class RosMaps(RosReadings):
    """Topics of maps, paths, poses and goals."""

    def __init__(self, graph: TopicGraph) -> None:
        super().__init__(graph, MAP_TYPES)

    def true_map(self, height: float) -> ShownReading:
        """Return what the world occupies at a height [m], models with joints left out.

        Raises:
            SimError: the simulator does not answer, or there is no such map.
        """
        grid = true_map(RosWorlds().save()[0], height)
        rows, columns = grid.occupied.shape
        x, y = grid.origin
        return ShownReading(
            words=f'{columns} x {rows} cells, {grid.occupied.sum()} of them occupied',
            grid=ShownGrid(
                map_cells(grid.occupied.astype(np.int8) * OCCUPIED),
                grid.resolution,
                Pose((x, y, 0.0)),
            ),
        )
