"""Resolve the addresses in a model description: package://, file:// and plain paths."""

import os
import re
from collections.abc import Callable
from urllib.parse import unquote

from lxml import etree

from ..core import AbsentError, fault, location

FindPackage = Callable[[str], str | None]  # package name -> its directory, None if unknown

_PACKAGE = re.compile(r'package://([^/\s"\'<>]*)')


class UnknownPackage(AbsentError):  # noqa: N818 (callers handle it as a result)
    """A package:// address names a package that is not found; `package` is its name."""

    def __init__(self, package: str, where: str = '') -> None:
        super().__init__(
            f"{where + ': ' if where else ''}package '{package}' of package://{package}/ is "
            'unknown; build it into the workspace, or add its folder to ROS_PACKAGE_PATH where '
            'the simulator is started'
        )
        self.package = package


def substitute_packages(text: str, find_package: FindPackage) -> str:
    """Return `text` with each package://NAME replaced by the directory of that package.

    A bare absolute path results, with no file:// before it (gazebo_ros_pkgs 2.9.2).

    Raises:
        UnknownPackage: a package is not found.
    """

    def directory(match: re.Match[str]) -> str:
        found = find_package(match[1])
        if not found:
            raise UnknownPackage(match[1])
        return str(found).rstrip('/')

    return _PACKAGE.sub(directory, text)


def substitute_in_tree(root: etree._Element, find_package: FindPackage) -> None:
    """Replace package:// in all attributes and texts below `root`, in place.

    A <mesh> keeps the original address in an extra attribute `uri`.

    Raises:
        UnknownPackage: a package is not found; the message names the line.
    """
    known: dict[str, str | None] = {}

    def find_once(package: str) -> str | None:
        if package not in known:
            known[package] = find_package(package)
        return known[package]

    for element in root.iter(etree.Element):
        try:
            for key, text in element.attrib.items():
                value = str(text)
                if 'package://' in value:
                    element.set(key, substitute_packages(value, find_once))
                    if element.tag == 'mesh' and key == 'filename':
                        element.set('uri', value)
            if element.text and 'package://' in element.text:
                element.text = substitute_packages(element.text, find_once)
        except UnknownPackage as error:
            raise UnknownPackage(error.package, location(element)) from None


def refuse_parent_folders(element: etree._Element, uri: str) -> None:
    """Reject a package:// address that leads out of its package, also if `.` is written %2e.

    Raises:
        ModelError: it has more `..` than folders before them.
    """
    if not uri.startswith('package://'):
        return
    package, _, inner = unquote(uri.removeprefix('package://')).partition('/')
    if os.path.normpath(inner.lstrip('/')).split('/')[0] == '..':
        raise fault(
            element, f"'{uri}' leads out of package '{package}'; '..' is not accepted there"
        )


def file_path(element: etree._Element, uri: str) -> str:
    """Return the absolute path of a file address: file:///path or /path.

    A path is used as written, as in Gazebo; if no such file exists, percent encoding (%20) is
    decoded, as in RViz.

    Args:
        element: the element with the address, for the message.
    Raises:
        AbsentError: the address has any other form.
    """
    path, cure = uri.removeprefix('file://'), 'use package://PACKAGE/file or file:///path'
    if path == uri and '://' in uri:
        scheme = uri.split('://', 1)[0]
        reason = f'{scheme}:// addresses are not read here; {cure}'
        if scheme == 'package':
            reason = 'packages cannot be looked up here; use file:///path'
        raise fault(element, f"'{uri}': {reason}", AbsentError)
    if not os.path.isabs(path):
        raise fault(element, f"'{uri}' is no absolute address; {cure}", AbsentError)
    if '%' in path and not os.path.exists(path):
        path = unquote(path)
    return os.path.normpath(path)
