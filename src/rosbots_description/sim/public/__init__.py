"""The public API: a world with its file formats, plugins and engine."""

from ..mapping import OccupancyGrid
from .descriptions import Descriptions
from .world import World

__all__ = ['Descriptions', 'OccupancyGrid', 'World']
