"""Resolve the addresses in descriptions to files; the one place that knows how Gazebo does it.

The table is in doc/gazebo_compatibility.md, under Addresses.
"""

import os
from collections.abc import Iterator
from dataclasses import dataclass

from lxml import etree

from ..core import AbsentError, fault
from .safe_io import within
from .search_path import FileSearch, FindModel, in_models, searched
from .uris import FindPackage, file_path, refuse_parent_folders, substitute_packages

_MATERIALS = 'media/materials/scripts'  # scripts there need no <uri>


@dataclass(frozen=True)
class Addresses:
    """Resolves addresses of every kind.

    Attributes:
        find_model: for model://.
        find_package: for package://; None if there are no packages.
        find_file: for relative file://.
    """

    find_model: FindModel
    find_package: FindPackage | None = None
    find_file: FileSearch = FileSearch()  # noqa: RUF009 (it is immutable)

    def path(self, element: etree._Element, uri: str, directory: str = '', home: str = '') -> str:
        """Return the absolute path of an address in `element`.

        Args:
            directory: folder of the file with the address; '' if it is in no file.
            home: the folder that relative addresses must not leave; '' for no such limit.
        Raises:
            AbsentError: nothing is found there.
            ModelError: it leaves (`..`) a model, a package or `home`.
        """
        if uri.startswith('model://'):
            return in_models(element, uri, self.find_model)
        if uri.startswith('package://'):
            refuse_parent_folders(element, uri)
            if self.find_package is not None:
                uri = substitute_packages(uri, self.find_package)
            return file_path(element, uri)
        inner = uri.removeprefix('file://')
        if '://' in inner or os.path.isabs(inner):
            return file_path(element, uri)
        beside = self._beside(element, uri, directory, home) if directory else ''
        if uri == inner and os.path.exists(beside):
            return beside  # without file:// the file's own folder comes first
        found = self.find_file(inner)
        if found is None and beside and os.path.exists(beside):
            return beside
        if found is None:
            places = ', '.join(filter(None, (searched(self.find_file), directory)))
            raise fault(
                element,
                f"'{uri}' is not to be found in: {places or 'no folder, as none is given'}; add "
                'the folder that holds it to GAZEBO_RESOURCE_PATH where the simulator is started, '
                'or use package://PACKAGE/file or file:///path',
                AbsentError,
            )
        return found

    def material_folders(self) -> Iterator[str]:
        """Yield the folders of scripts whose materials are found by their name alone."""
        for directory in self.find_file.directories():
            path = os.path.join(directory, _MATERIALS)
            if os.path.isdir(path):
                yield path

    def _beside(self, element: etree._Element, uri: str, directory: str, home: str) -> str:
        path = os.path.normpath(os.path.join(directory, uri.removeprefix('file://')))
        if home and not within(path, home):
            raise fault(element, f"'{uri}' leads out of '{home}'; '..' is not accepted there")
        return path
