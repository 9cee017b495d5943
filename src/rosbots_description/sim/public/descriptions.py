"""Read a model from a file, an address or a text."""

import os
from collections.abc import Iterable, Mapping

from ..core import Fault, ModelError, Pose, report
from ..description import ModelSpec
from ..formats import expand_xacro, load_sdf, load_urdf, sdf_of_include
from ..resources import (
    MAX_XML_BYTES,
    FileSearch,
    FindModel,
    ModelSearch,
    PackageSearch,
    below_model_path,
    own_name,
    path_directories,
    read_file,
    root_tag,
)

Paths = Iterable[str | os.PathLike[str]]
Description = str | os.PathLike[str]
_TEXT = 'the text'  # the source of a description that is given as such


class Descriptions:
    """Reads models, and resolves package:// and model:// addresses."""

    def __init__(self, package_path: Paths, model_path: Paths) -> None:
        self._package_path = tuple(package_path)
        self.find_model: FindModel = ModelSearch(
            [
                *model_path,
                lambda: path_directories(os.environ.get('GAZEBO_MODEL_PATH', '')),
                os.path.expanduser('~/.gazebo/models'),
            ]
        )
        self.find_file = FileSearch([_resource_path])

    def packages(self, inside: str | None = None) -> PackageSearch:
        """Return the package search for a description in the file `inside`."""
        return PackageSearch(self._package_path, inside)

    def read(
        self, description: Description, name: str, arguments: Mapping[str, str]
    ) -> tuple[ModelSpec, Pose]:
        """Return the model of a URDF, xacro or SDF, and the pose that the description gives it.

        Args:
            name: of the model; '' for the one in the description.
            arguments: for xacro.
        Raises:
            ModelError: it cannot be read or simulated.
        """
        given = os.fspath(description)
        if given.startswith('model://'):
            name = name or below_model_path(given).partition('/')[0]
        text, source, tag = self.text(given, arguments)
        load = load_urdf if tag == 'robot' else load_sdf
        return load(
            text,
            name or own_name(text, source),
            source=source,
            find_package=self.packages(None if source == _TEXT else source),
            find_model=self.find_model,
            find_file=self._files_of(source),
        )

    def text(
        self, description: Description, arguments: Mapping[str, str]
    ) -> tuple[str | bytes, str, str]:
        """Return the XML of a model, with xacro expanded; where it is from; and its root's tag.

        Raises:
            ModelError: it cannot be read, or is not a model.
        """
        given = os.fspath(description)
        if arguments and not given.endswith('.xacro'):
            ignored = ', '.join(map(repr, arguments))
            report(Fault(f'arguments are for xacro files only; {ignored} are ignored'))
        if given.startswith('model://'):
            given = sdf_of_include(given)
        text: str | bytes
        if given.lstrip('\ufeff \t\r\n').startswith('<'):
            text, source = given, _TEXT
        else:
            source = self._path(given)
            text = (
                expand_xacro(source, arguments, self.packages(source))
                if source.endswith('.xacro')
                else read_file(source, MAX_XML_BYTES, 'model file')
            )
        tag = root_tag(text)
        if tag not in ('robot', 'sdf', 'gazebo'):
            raise ModelError(
                f'{source}: it is not a model; a model is XML whose root element is '
                f'<robot> (URDF) or <sdf>, not {f"<{tag}>" if tag else "missing"}'
            )
        return text, source, tag

    def _files_of(self, source: str) -> FileSearch:
        """Return the search for the files of a description; its own folder comes last."""
        if source == _TEXT:
            return self.find_file
        return FileSearch([_resource_path, os.path.dirname(os.path.abspath(source))])

    def _path(self, address: str) -> str:
        """Return the file of an address or a path."""
        if not address.startswith('package://'):
            return address
        package, _, inner = address.removeprefix('package://').partition('/')
        folder = self.packages()(package)
        if folder is None:
            raise ModelError(
                f"package '{package}' of {address} is unknown; add the folder that "
                'holds it to package_path or to ROS_PACKAGE_PATH'
            )
        return os.path.join(folder, inner)


def _resource_path() -> list[str]:
    return path_directories(os.environ.get('GAZEBO_RESOURCE_PATH', ''))
