"""Building blocks of panels: their events, text, dropdowns, notices, and the layout."""

from .camera_keys import HANDLERS, CameraKeys
from .choice import Choice
from .descriptions import chosen_links, friction, list_html, parts_html, scoped_name, state_html
from .layout import BAR, LAY_OUT, OPAQUE, PAD, lay_out
from .notices import Notices, left_out, show_notice
from .panel import Allow, Panel, Value, attempt, fill
from .rate_limit import RateLimit
from .reading import ReadingPanel
from .text import STYLE, Rows, Words, markup, plain, table
from .ticker import Ticker
from .world_name import SET_TITLE, WorldName

__all__ = [
    'BAR',
    'HANDLERS',
    'LAY_OUT',
    'OPAQUE',
    'PAD',
    'SET_TITLE',
    'STYLE',
    'Allow',
    'CameraKeys',
    'Choice',
    'Notices',
    'Panel',
    'RateLimit',
    'ReadingPanel',
    'Rows',
    'Ticker',
    'Value',
    'Words',
    'WorldName',
    'attempt',
    'chosen_links',
    'fill',
    'friction',
    'lay_out',
    'left_out',
    'list_html',
    'markup',
    'parts_html',
    'plain',
    'scoped_name',
    'show_notice',
    'state_html',
    'table',
]
