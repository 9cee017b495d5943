"""Names, numbers, poses and plain elements from parsed XML, and the record of omitted parts."""

from .foreign_markup import foreign_tags, remove_xacro
from .omissions import LeftOut, listed
from .robot_namespace import inject_namespace
from .sensors import read_sensor
from .values import (
    ENDLESS_FRICTION,
    XACRO_CURE,
    boolean,
    check_name,
    is_endless,
    limit_number,
    number,
    numbers,
    origin,
    positive,
    require_damping,
    require_mass,
    require_near,
    require_size,
    required_name,
    scalar,
    scalar_number,
    scalar_numbers,
    tag_of,
    to_element,
    vector,
)

__all__ = [
    'ENDLESS_FRICTION',
    'XACRO_CURE',
    'LeftOut',
    'boolean',
    'check_name',
    'foreign_tags',
    'inject_namespace',
    'is_endless',
    'limit_number',
    'listed',
    'number',
    'numbers',
    'origin',
    'positive',
    'read_sensor',
    'remove_xacro',
    'require_damping',
    'require_mass',
    'require_near',
    'require_size',
    'required_name',
    'scalar',
    'scalar_number',
    'scalar_numbers',
    'tag_of',
    'to_element',
    'vector',
]
