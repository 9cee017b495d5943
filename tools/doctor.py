"""What only Python knows for ./rosbots doctor: `missing`, `versions` or `opengl`."""

from __future__ import annotations

import platform
import sys
from collections.abc import Iterable
from importlib.metadata import PackageNotFoundError, version

SHOWN = ('pybullet', 'moderngl', 'viser', 'gymnasium', 'ray')


def installed(name: str) -> str:
    """Return the version of a package, '' if it is not installed."""
    try:
        return version(name)
    except PackageNotFoundError:
        return ''


def missing(requirements: Iterable[str]) -> list[str]:
    """Return those requirements, 'NAME==VERSION ; MARKER', that are not installed."""
    found = []
    for line in requirements:
        requirement, _, marker = line.partition(';')
        name, _, wanted = requirement.strip().partition('==')
        if 'platform_machine' in marker and f'"{platform.machine()}"' not in marker:
            continue
        if not installed(name) or (wanted and installed(name) != wanted):
            found.append(requirement.strip())
    return found


def versions() -> str:
    """Return the versions of Python and of packages that decide how the simulator behaves."""
    shown = [f'Python {platform.python_version()}']
    shown += [f'{name} {installed(name)}' for name in SHOWN if installed(name)]
    return ', '.join(shown)


def opengl() -> str:
    """Return what draws pictures, or why nothing does."""
    try:
        from rosbots_description.sim.rendering.gl.context import NoContextError, open_context
    except ImportError as error:
        return f'{error}; ./rosbots setup'
    try:
        _, name, in_software = open_context()
    except NoContextError as error:
        return str(error)
    return f'{name}, in software' if in_software else name


def main() -> None:
    """Print what the first argument names."""
    match sys.argv[1:]:
        case ['missing']:
            lines = (line.strip() for line in sys.stdin)
            print(*missing(lines), sep='\n', end='')
        case ['versions']:
            print(versions())
        case ['opengl']:
            print(opengl())
        case _:
            sys.exit(__doc__)


if __name__ == '__main__':
    main()
