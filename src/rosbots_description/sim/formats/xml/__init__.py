"""Reads XML safely, and words complaints about it."""

from .foreign_markup import foreign_tags, remove_xacro
from .omissions import LeftOut
from .parser import MAX_BYTES, XACRO_CURE, check_bounds, line_of, parse, root_tag, shortened
from .values import (
    HEAVIEST,
    LIGHTEST,
    LONGEST,
    MAX_NOTES,
    MOST_INERT,
    check_name,
    fault,
    is_endless,
    limit_number,
    note,
    number,
    numbers,
    origin,
    owner,
    parse_numbers,
    place,
    positive,
    require_damping,
    require_mass,
    require_near,
    require_size,
    required_name,
    scalar,
    scalar_number,
    scalar_numbers,
    suggestion,
    tag_of,
    to_element,
    truth,
)

__all__ = [
    'HEAVIEST', 'LIGHTEST', 'LONGEST', 'MAX_BYTES', 'MAX_NOTES', 'MOST_INERT', 'XACRO_CURE',
    'LeftOut', 'check_bounds', 'check_name', 'fault', 'foreign_tags', 'is_endless', 'limit_number',
    'line_of', 'note', 'number', 'numbers', 'origin', 'owner', 'parse', 'parse_numbers', 'place',
    'positive', 'remove_xacro', 'require_damping', 'require_mass', 'require_near', 'require_size',
    'required_name', 'root_tag', 'scalar', 'scalar_number', 'scalar_numbers', 'shortened',
    'suggestion', 'tag_of', 'to_element', 'truth',
]
