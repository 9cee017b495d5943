"""Maps: which cells of a horizontal section through a world are occupied."""

from .map_files import write_map
from .occupancy_grid import OccupancyGrid, occupancy_grid

__all__ = ['OccupancyGrid', 'occupancy_grid', 'write_map']
