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
    name = filename.rsplit('/', 1)[-1]
    if not name.endswith('.so'):
        name += '.so'
    return _PLUGINS.get(name) or _PLUGINS.get('lib' + name)


def known_filenames() -> list[str]:
    """Return the file names of all plugins, sorted."""
    return sorted(_PLUGINS)
