"""Which class stands for which plugin library, and for which type of sensor."""

from collections.abc import Callable

_PLUGINS: dict[str, type] = {}  # those of models
_SENSOR_PLUGINS: dict[str, type] = {}
_SENSORS: dict[str, type] = {}  # by type


def register(filename: str) -> Callable[[type], type]:
    """Return a class decorator that registers a plugin under its library's file name."""
    return _adder(_PLUGINS, filename)


def register_in_sensor(filename: str) -> Callable[[type], type]:
    """Return a class decorator as `register` does, for a plugin that stands in a <sensor>."""
    return _adder(_SENSOR_PLUGINS, filename)


def register_sensor(kind: str) -> Callable[[type], type]:
    """Return a class decorator that makes sensors of a type measure."""
    return _adder(_SENSORS, kind)


def _adder(classes: dict[str, type], name: str) -> Callable[[type], type]:
    def add(cls: type) -> type:
        if name in classes:
            raise ValueError(f'{name} is already registered by {classes[name].__name__}')
        classes[name] = cls
        return cls

    return add


def plugin_class(filename: str) -> type | None:
    """Return the class for a library's file name, with or without a path or `.so`; else None."""
    return _PLUGINS.get(library_name(filename))


def sensor_plugin_class(filename: str) -> type | None:
    """Return the class for the library of a plugin in a <sensor>, as `plugin_class` does."""
    return _SENSOR_PLUGINS.get(library_name(filename))


def sensor_class(kind: str) -> type | None:
    """Return the class for a type of sensor, e.g. 'ray'; None if nothing measures as that does."""
    return _SENSORS.get(kind)


def library_name(filename: str) -> str:
    """Return a library's file name as `known_filenames` has it; '' for an empty one."""
    name = filename.rsplit('/', 1)[-1].strip()
    if not name:
        return ''
    name = name if name.endswith('.so') else f'{name}.so'
    return name if name.startswith('lib') else f'lib{name}'


def known_filenames() -> list[str]:
    """Return the file names of all plugins, sorted."""
    return sorted({*_PLUGINS, *_SENSOR_PLUGINS})
