"""Find models and worlds along search paths, and the description in a model's folder."""

import contextlib
import os
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from lxml import etree

from ..core import AbsentError, NotFoundError, fault, place, shortened
from .safe_io import read_file
from .xml_parser import MAX_XML_BYTES, parse_xml

# Path relative to the model path, e.g. 'box/meshes/box.dae' -> absolute path, or None.
FindModel = Callable[[str], str | None]
# A directory, or a callable that returns directories each time (packages may come and go).
Directories = Iterable[str | os.PathLike[str] | Callable[[], Iterable[str | os.PathLike[str]]]]

_NEWEST = (1, 7)
_MANIFESTS = ('model.config', 'manifest.xml')
_FILES = ('model.config', 'model.sdf')  # either makes a folder a model


class _PathSearch:
    """Looks for relative paths along directories; the first match counts."""

    FOLDERS: tuple[str, ...] = ('',)  # searched in each directory, in this order

    def __init__(self, directories: Directories = ()) -> None:
        """Search these directories."""
        self._directories = tuple(directories)

    def __call__(self, inner: str) -> str | None:
        """Return the absolute path of a file or a folder; None if it is not found."""
        if leaves_folder(inner):
            return None
        for directory in self.directories():
            for folder in self.FOLDERS:
                path = os.path.join(directory, folder, inner)
                if os.path.exists(path):
                    return os.path.abspath(path)
        return None

    def directories(self) -> Iterator[str]:
        """Yield the current directories in order, lazily."""
        for entry in self._directories:
            for path in entry() if callable(entry) else [entry]:
                yield os.fspath(path)


class ModelSearch(_PathSearch):
    """Looks for the part after model:// along the model path, which holds models' folders."""


class FileSearch(_PathSearch):
    """Looks for the part after file:// along the resource path, as GAZEBO_RESOURCE_PATH."""

    FOLDERS = ('', 'models', 'media/models', 'Media/models')  # as Gazebo


# The models of this library, found where the search finds none of that name.
_BUILT_IN = ModelSearch([Path(__file__).resolve().parents[2] / 'models'])
_NO_MODELS = {'sun'}  # lights


def model_names(find_model: FindModel) -> list[str]:
    """Return the names of all models that a search finds, and of the built-in ones.

    A model is a folder with a description. An unreadable directory has none.
    """
    found: set[str] = set()
    for directory in (*getattr(find_model, 'directories', list)(), *_BUILT_IN.directories()):
        with contextlib.suppress(OSError), os.scandir(directory) as entries:
            found |= {
                entry.name
                for entry in entries
                if any(os.path.isfile(os.path.join(entry.path, file)) for file in _FILES)
            }
    return sorted(found - _NO_MODELS)


def searched(find: Callable[[str], str | None]) -> str:
    """Return the directories of a search, for messages; '' if they are unknown."""
    directories = getattr(find, 'directories', None)
    return ', '.join(directories()) if directories else ''


def path_directories(value: str) -> list[str]:
    """Return the directories of a search path such as GAZEBO_MODEL_PATH, without empty ones."""
    return [part for part in value.split(os.pathsep) if part]


def leaves_folder(inner: str) -> bool:
    """Tell whether a relative path would leave its search directory, or is absolute."""
    return not inner.strip('/') or os.path.isabs(inner) or '..' in inner.split('/')


def below_model_path(uri: str) -> str:
    """Return the part after model://; as in Gazebo any number of slashes may follow."""
    return uri.removeprefix('model://').lstrip('/')


class MissingModel(AbsentError):  # noqa: N818 (as UnknownPackage)
    """A model:// address leads nowhere; `model` is the folder that it names."""

    def __init__(self, sentence: str, model: str) -> None:
        super().__init__(sentence)
        self.model = model


def in_models(element: etree._Element, uri: str, find_model: FindModel) -> str:
    """Return the absolute path of a model:// address.

    Args:
        element: the element with the address, for the message.
    Raises:
        MissingModel: nothing is found there.
        ModelError: it names no model, or leaves (`..`) the model path.
    """
    inner = below_model_path(uri)
    if not inner:
        raise fault(element, f"'{uri}' names no model; write model://MODEL/FILE")
    if leaves_folder(inner):
        raise fault(element, f"'{uri}' leaves the model path; '..' is not accepted there")
    found = find_model(inner) or _BUILT_IN(inner)
    if found is None:
        model = inner.split('/')[0]
        sentence = f"'{uri}' {not_on_model_path(find_model, repr(model))}"
        error = MissingModel(str(fault(element, sentence)), model)
        error.place = place(element)
        raise error
    return found


def not_on_model_path(find_model: FindModel, models: str, verb: str = 'is') -> str:
    """Return the end of a sentence about missing models: where was searched, and the cure."""
    places = searched(find_model) or 'which is empty'
    return (
        f'{verb} not to be found along the model path ({places}); add the folder that holds '
        f'{models} to GAZEBO_MODEL_PATH where the simulator is started'
    )


def description_file(path: str, element: etree._Element) -> str:
    """Return the SDF file of a model's folder: the newest version listed in model.config.

    In a folder without model.config it is model.sdf; the path of a file is returned unchanged.

    Raises:
        ModelError: there is no such folder, or no description in it; it names `element`.
    """
    if not os.path.exists(path):
        raise fault(element, f"'{path}' does not exist; check the address")
    if not os.path.isdir(path):
        return path
    for name in _MANIFESTS:
        manifest = os.path.join(path, name)
        if os.path.isfile(manifest):
            return os.path.join(path, _chosen(manifest, element))
    plain = os.path.join(path, 'model.sdf')
    if os.path.isfile(plain):
        return plain
    raise fault(element, f"'{path}' holds neither model.config nor model.sdf; it is no model")


def _chosen(manifest: str, element: etree._Element) -> str:
    root = parse_xml(read_file(manifest, MAX_XML_BYTES), manifest)
    offers = [
        (_version(entry.get('version', '')), (entry.text or '').strip())
        for entry in root.iterfind('sdf')
    ]
    offers = [offer for offer in offers if offer[1] and not leaves_folder(offer[1])]
    if not offers:
        raise fault(element, f"'{manifest}' names no description; add <sdf>model.sdf</sdf>")
    # If all are too new, the oldest has the best chance.
    readable = [offer for offer in offers if offer[0] <= _NEWEST]
    return max(readable)[1] if readable else min(offers)[1]


def _version(text: str) -> tuple[int, ...]:
    parts = text.strip().split('.')
    if not all(part.isdecimal() and len(part) < 10 for part in parts):
        return (0, 0)
    return tuple(int(part) for part in parts)


def find_world(name: str, directories: Iterable[str | os.PathLike[str]] = ()) -> Path:
    """Return the path of a world file: as given, else in `directories`, e.g. 'worlds/empty.world'.

    In each directory the file is searched by its name, with '.world' appended, and below `worlds/`;
    so a directory may be one of GAZEBO_RESOURCE_PATH, or itself contain the world files.
    `directories` is evaluated lazily.

    Raises:
        NotFoundError: there is none; the message lists where it was searched.
    """
    names = [name] if name.endswith(('.world', '.sdf')) else [name, f'{name}.world']
    for path in map(Path, names):
        if os.path.isfile(path):  # False also for names that no file can have
            return path.absolute()
    searched = []
    for directory in directories:
        searched.append(os.fspath(directory))
        for candidate in names:
            for path in _places(Path(directory), candidate):
                if os.path.isfile(path):
                    return path.absolute()
    shown = ', '.join(searched) or 'nowhere else'
    raise NotFoundError(
        f"there is no world file '{shortened(name)}' as given, nor in: {shown}; "
        'check the name, or add its folder to GAZEBO_RESOURCE_PATH'
    )


def _places(directory: Path, name: str) -> list[Path]:
    below = name.removeprefix('worlds/')
    return [directory / name, directory / 'worlds' / below, directory / below]
