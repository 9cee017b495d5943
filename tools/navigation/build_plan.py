#!/usr/bin/env python3
"""Say which packages of the navigation stack are built and in which order, and what of them.

`build_plan.py SOURCES` reads targets.yaml and the manifests below a folder. It prints a line for
each package: its name, its folder, and the targets that are built of it.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path

import yaml
from catkin_pkg.package import Package
from catkin_pkg.packages import find_packages
from catkin_pkg.topological_order import topological_order_packages

TARGETS = Path(__file__).with_name('targets.yaml')


class PlanError(Exception):
    """A sentence about sources that cannot be built."""


def build_plan(
    sources: Path, targets: Mapping[str, Collection[str]]
) -> Iterator[tuple[str, Path, Collection[str]]]:
    """Yield name, folder and targets of each package, those that others depend on first.

    Raises:
        PlanError: a package is not among the sources, or packages depend on each other in a circle.
    """
    packages = find_packages(str(sources))
    for package in packages.values():
        package.evaluate_conditions({**os.environ, 'ROS_PYTHON_VERSION': '3', 'ROS_VERSION': '1'})
    by_name = {package.name: package for package in packages.values()}
    for name in targets:
        if name not in by_name:
            raise PlanError(f'there is no package {name} in {sources}')
    needed = _with_dependencies(targets, by_name)
    for path, package in topological_order_packages(packages, whitelisted=needed):
        if path is None:
            raise PlanError(f'these packages depend on each other in a circle: {package}')
        yield package.name, sources / path, targets.get(package.name, ())


def _with_dependencies(names: Collection[str], packages: Mapping[str, Package]) -> set[str]:
    """Return the packages and those among the sources that they need to be built and to run."""
    needed, rest = set[str](), list(names)
    while rest:
        name = rest.pop()
        if name not in needed and name in packages:
            needed.add(name)
            package = packages[name]
            rest += [
                each.name
                for each in (
                    *package.buildtool_depends,
                    *package.build_depends,
                    *package.exec_depends,
                )
                if each.evaluated_condition
            ]
    return needed


def main() -> int:
    """Print the plan; return the exit code."""
    try:
        targets = yaml.safe_load(TARGETS.read_text(encoding='utf-8'))
        for name, folder, built in build_plan(Path(sys.argv[1]), targets):
            print(name, folder, *built)
    except PlanError as error:
        sys.stderr.write(f'rosbots: {error}\n')
        return 1
    return 0


if __name__ == '__main__':
    sys.exit(main())
