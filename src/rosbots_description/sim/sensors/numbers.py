"""Reads numbers from the elements of a <sensor>."""

from ..core import PluginError, parse_number
from ..description import Element

# Gazebo's sensors read a copy of their description that was printed with so many digits: a
# <horizontal_fov> of 1.3962634 rad is 1.39626 rad in every camera_info, and pi / 2 is 1.5708.
DIGITS = 6
MAX_FLOAT32 = 3.4028234e38  # the largest number of the messages of ray sensors


def child_at(element: Element | None, path: str) -> Element | None:
    """Return the first descendant at a path such as 'scan/horizontal'; None if there is none."""
    for tag in path.split('/'):
        element = None if element is None else element.child(tag)
    return element


def number(element: Element | None, path: str, default: float) -> float:
    """Return the number at a path below an element, rounded to `DIGITS` significant digits.

    Raises:
        PluginError: the text is not a finite number.
    """
    child = child_at(element, path)
    if child is None:
        return default
    text = child.attributes.get('value') or child.text
    value = parse_number(text)
    if value is None:
        raise PluginError(f"line {child.line}: <{child.tag}> is '{text}'; it takes a finite number")
    return float(f'{value:.{DIGITS}g}')


def count(element: Element | None, path: str, default: int, most: int) -> int:
    """Return the whole number at a path below an element.

    Raises:
        PluginError: the text is not a number, or it is below 1 or above `most`.
    """
    value, child = number(element, path, default), child_at(element, path)
    if child is not None and not 1.0 <= value <= most:
        raise PluginError(
            f'line {child.line}: <{child.tag}> is {value:g}; it takes a number from 1 to {most}'
        )
    return int(value)
