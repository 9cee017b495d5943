"""YAML files of limited size, however it is written."""

import os
import stat
from pathlib import Path

import yaml

MAX_BYTES, MAX_VALUES = 2_000_000, 1_000_000  # of a file; of its content, aliases written out
_MAX_DEPTH = 50  # of lists and mappings in each other
_TOO_DEEP = f'its lists and mappings are nested more than {_MAX_DEPTH} times'


def read_yaml(path: str | os.PathLike[str]) -> object:
    """Return the content of a YAML file: plain values only.

    Raises:
        OSError: it cannot be read.
        ValueError: it is no regular file, not YAML, or too large; the message says which.
    """
    state = os.stat(path)
    if not stat.S_ISREG(state.st_mode):
        raise ValueError('it is not a file')
    if state.st_size > MAX_BYTES:
        raise ValueError(f'it has {state.st_size} bytes; at most {MAX_BYTES} are accepted')
    text = Path(path).read_text(encoding='utf-8')
    try:
        _require_shallow(text)
        content = yaml.safe_load(text)
    except yaml.YAMLError as error:
        raise ValueError(f'it is not YAML: {" ".join(str(error).split())}') from None
    _require_size(content)
    return content


def _require_shallow(text: str) -> None:
    """Raise a ValueError if lists and mappings are too deep; that costs the loader hours."""
    depth = 0
    for event in yaml.parse(text, Loader=yaml.SafeLoader):
        if isinstance(event, yaml.CollectionStartEvent):
            depth += 1
        elif isinstance(event, yaml.CollectionEndEvent):
            depth -= 1
        if depth > _MAX_DEPTH:
            raise ValueError(_TOO_DEEP)


def _require_size(content: object) -> None:
    """Raise a ValueError if content is too large or too deep with all aliases written out."""
    sizes: dict[int, int] = {}  # by id: an alias is the same object

    def size(value: object, depth: int) -> int:
        if not isinstance(value, dict | list):
            return 1
        if depth > _MAX_DEPTH:  # as it is in a list that contains itself
            raise ValueError(_TOO_DEEP)
        if id(value) not in sizes:
            inner = value.values() if isinstance(value, dict) else value
            sizes[id(value)] = 1 + sum(size(one, depth + 1) for one in inner)
        return sizes[id(value)]

    if size(content, 0) > MAX_VALUES:
        raise ValueError(f'it has more than {MAX_VALUES} values, with its aliases written out')
