"""Strategies for requests and messages, built from their definitions and serialized once."""

from functools import cache
from io import BytesIO

from genpy import Duration, Message, Time
from hypothesis import strategies as st
from roslib.message import get_message_class

NUMBERS = (
    st.sampled_from(
        (
            0.0,
            -0.0,
            1.0,
            -1.0,
            0.5,
            1e-3,
            1e9,
            -1e9,
            1e16,
            1e154,
            1e308,
            -1e308,
            5e-324,
            float('nan'),
            float('inf'),
            float('-inf'),
        )
    )
    | st.floats(-10.0, 10.0)
    | st.floats()
)
TEXTS = st.sampled_from(
    (
        '',
        ' ',
        '::',
        'a::b',
        '::box',
        'box::',
        '\x00',
        'box\x00',
        '\n',
        'ünï',
        '🤖',
        'a' * 100_000,
        '%s%n',
        '/',
        '~',
        '../..',
        '<robot/>',
        'nan',
    )
) | st.text(st.characters(blacklist_categories=('Cs',)), max_size=10)
_BITS = {f'{sign}int{bits}': (sign, bits) for sign in ('', 'u') for bits in (8, 16, 32, 64)}
_BITS |= {'byte': ('', 8), 'char': ('u', 8)}
_MOST = 2**31 - 1


@cache
def messages(message_class: type, names: tuple[str, ...]) -> st.SearchStrategy:
    """Return a strategy for a message or request.

    Args:
        names: names of existing things, which strings take often.
    """
    fields = zip(message_class.__slots__, message_class._slot_types, strict=True)
    parts = {name: _values(kind, names) for name, kind in fields}
    return st.fixed_dictionaries(parts).map(lambda values: as_sent(message_class(**values)))


def as_sent(message: Message) -> Message:
    """Return the message serialized and deserialized, as after a connection."""
    stream = BytesIO()
    message.serialize(stream)
    return type(message)().deserialize(stream.getvalue())


def _values(kind: str, names: tuple[str, ...]) -> st.SearchStrategy:
    if kind.endswith(']'):
        item, _, size = kind[:-1].partition('[')
        least, most = (int(size), int(size)) if size else (0, 3)
        return st.lists(_values(item, names), min_size=least, max_size=most)
    if kind in _BITS:
        sign, bits = _BITS[kind]
        least, most = (0, 2**bits - 1) if sign else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
        return st.sampled_from((0, 1, 2, 50, least, most)) | st.integers(least, most)
    match kind:
        case 'bool':
            return st.booleans()
        case 'string':
            return st.sampled_from(names) | TEXTS if names else TEXTS
        case 'float64':
            return NUMBERS
        case 'float32':
            return NUMBERS.filter(lambda number: abs(number) < 3e38 or number - number != 0.0)
        case 'time':
            parts = st.tuples(st.integers(0, 3) | st.just(_MOST), st.integers(0, 999_999_999))
            return parts.map(lambda pair: Time(*pair))
        case 'duration':
            parts = st.tuples(
                st.sampled_from((-1, 0, 1, _MOST, -_MOST - 1)) | st.integers(-3, 3),
                st.integers(0, 999_999_999),
            )
            return parts.map(lambda pair: Duration(*pair))
    return messages(get_message_class(kind), names)
