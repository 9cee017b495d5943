"""Maps as map_server reads them: a picture and its place."""

import json
import os

from ..resources import write_file
from .occupancy_grid import OccupancyGrid

OCCUPIED, FREE = 0, 254  # grey levels, as map_saver writes them
PLACE = """image: {image}
resolution: {resolution!r}
origin: [{x!r}, {y!r}, 0.0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
"""


def write_map(grid: OccupancyGrid, path: str, overwrite: bool = False) -> tuple[str, str]:
    """Write NAME.pgm and NAME.yaml for a path NAME or NAME.yaml; return both paths.

    Raises:
        SimError: a file is there already or cannot be written.
    """
    stem = os.path.abspath(path.removesuffix('.yaml'))
    rows, columns = grid.occupied.shape
    cells = (~grid.occupied[::-1]).astype('u1') * FREE + OCCUPIED  # the top row first
    x, y = grid.origin
    image, place = f'{stem}.pgm', f'{stem}.yaml'
    write_file(image, f'P5\n{columns} {rows}\n255\n'.encode() + cells.tobytes(), overwrite)
    write_file(
        place,
        PLACE.format(
            image=json.dumps(os.path.basename(image)), x=x, y=y, resolution=grid.resolution
        ).encode(),
        overwrite,
    )
    return image, place
