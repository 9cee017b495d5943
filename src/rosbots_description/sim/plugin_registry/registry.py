"""Which class stands for which plugin library."""

from collections.abc import Callable

_PLUGINS: dict[str, type] = {}


def register(filename: str) -> Callable[[type], type]:
    """Return a class decorator that makes a plugin loadable by the file name descriptions use."""

    def add(cls: type) -> type:
        if filename in _PLUGINS:
            raise ValueError(f'{filename} is already registered by {_PLUGINS[filename].__name__}')
        _PLUGINS[filename] = cls
        return cls

    return add


def plugin_class(filename: str) -> type | None:
    """Return the class for a library's file name, with or without a path or `.so`; else None."""
    return _PLUGINS.get(library_name(filename))


def library_name(filename: str) -> str:
    """Return a library's file name as `known_filenames` has it; '' for an empty one."""
    name = filename.rsplit('/', 1)[-1].strip()
    if not name:
        return ''
    name = name if name.endswith('.so') else f'{name}.so'
    return name if name.startswith('lib') else f'lib{name}'


def known_filenames() -> list[str]:
    """Return the file names of all plugins, sorted."""
    return sorted(_PLUGINS)
