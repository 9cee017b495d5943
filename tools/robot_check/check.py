#!/usr/bin/env python3
"""Check the packages of a robot with this simulator: `./rosbots check FOLDER [LAUNCH_FILE …]`.

They are built in a workspace of their own over the one here. A launch file passes when a model
besides the ground plane is simulated; then the rostests in the folder run (*.test). Each has a ROS
master of its own.
"""

from __future__ import annotations

import argparse
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from xml.etree import ElementTree
from xml.sax.saxutils import quoteattr

import rospkg

SIMULATES = """<launch>
  <include file={file}>{arguments}</include>
  <test test-name={name} pkg="{package}" type="simulation_runs.py" time-limit="{limit}">
    <param name="patience" value="{patience}"/>
  </test>
</launch>
"""
ROOT = Path(__file__).resolve().parents[2]
MANIFEST = """<package>
  <name>{package}</name> <version>0.0.0</version>
  <description>The test of the launch files.</description>
  <maintainer email="nobody@example.org">nobody</maintainer> <license>none</license>
</package>
"""
PACKAGE = 'rosbots_check'
PATIENCE = 120  # [s], of a machine that is busy


def main(argv: list[str] | None = None) -> int:
    """Build and test the packages in a folder; return the exit code."""
    parser = argparse.ArgumentParser(
        prog='./rosbots check',
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument('folder', type=Path, help='with one or more catkin packages')
    parser.add_argument(
        'launch',
        nargs='*',
        metavar='LAUNCH_FILE|NAME:=VALUE',
        help='launch files of the folder, and arguments of the file before them',
    )
    parser.add_argument('--results', type=Path, help='folder for the reports (JUnit)')
    arguments = parser.parse_intermixed_args(argv)
    folder = arguments.folder.resolve()
    packages = find_packages(folder)
    if not packages:
        parser.error(f'there is no package.xml in {arguments.folder}')
    launches = pair_arguments(arguments.launch)
    for path, _ in launches:
        if not (folder / path).is_file():
            parser.error(f'there is no launch file {path} in {arguments.folder}')
    with tempfile.TemporaryDirectory(prefix='rosbots-check-') as room:
        return check(Path(room), folder, packages, launches, arguments.results)


def find_packages(folder: Path) -> list[Path]:
    """Return the folders of the packages, except below a file CATKIN_IGNORE."""
    manifests = sorted(folder.rglob('package.xml'))
    return [
        path.parent
        for path in manifests
        if not any((parent / 'CATKIN_IGNORE').exists() for parent in path.parents)
    ]


def pair_arguments(words: list[str]) -> list[tuple[str, list[str]]]:
    """Return each launch file with the arguments that follow it."""
    launches: list[tuple[str, list[str]]] = []
    for word in words:
        if ':=' not in word:
            launches.append((word, []))
        elif launches:
            launches[-1][1].append(word)
        else:
            sys.exit(f'./rosbots check: {word} precedes the launch file that it belongs to')
    return launches


def check(
    room: Path,
    folder: Path,
    packages: list[Path],
    launches: list[tuple[str, list[str]]],
    results: Path | None,
) -> int:
    """Do what `main` says, in the empty folder `room`; return the exit code."""
    source = room / 'src'
    source.mkdir()
    for number, package in enumerate(packages):
        (source / f'{number}_{package.name}').symlink_to(package)
    for sentence in missing_packages(packages):
        print(f'    {sentence}', flush=True)
    python = shutil.which('python3') or sys.executable
    print(f'==> building {len(packages)} package{"s"[: len(packages) > 1]}', flush=True)
    if subprocess.run(
        [
            '/usr/bin/catkin_make',
            '-C',
            str(room),
            f'-DPYTHON_EXECUTABLE={python}',
            f'-DPython_EXECUTABLE={python}',
        ],
        check=False,
    ).returncode:
        return 1
    tests = [write_test(room, folder / path, given) for path, given in launches]
    tests += sorted(folder.rglob('*.test'))
    codes = [run_test(room, path, folder) for path in tests]
    if results:
        shutil.copytree(room / 'results', results, dirs_exist_ok=True)
    failed = sum(map(bool, codes))
    print(f'{len(codes) - failed} passed, {failed} failed')
    return 1 if failed or not codes else 0


def missing_packages(packages: list[Path]) -> list[str]:
    """Return a sentence about each ROS package that these need and that is not here."""
    needed: dict[str, str] = {}  # with the first package that needs it
    for folder in packages:
        manifest = ElementTree.parse(folder / 'package.xml').getroot()
        for element in manifest:
            if element.tag in ('depend', 'exec_depend', 'run_depend', 'build_depend'):
                needed.setdefault((element.text or '').strip(), folder.name)
    found = rospkg.RosPack()
    known = {*found.list(), *(manifest_name(folder) for folder in packages)}
    sentences = []
    for name in sorted(needed.keys() - known - {''}):
        debian = optional_packages(name)
        cure = (
            f'install {" ".join(debian)} (requirements/optional.apt)'
            if debian
            else 'if it is one of ROS, see "Other packages of ROS" in doc/gazebo_compatibility.md'
        )
        sentences.append(
            f"{needed[name]} needs '{name}', which is not among the ROS packages here: {cure}"
        )
    return sentences


def manifest_name(folder: Path) -> str:
    """Return the name that a package's manifest gives."""
    return (ElementTree.parse(folder / 'package.xml').findtext('name') or '').strip()


def optional_packages(name: str) -> list[str]:
    """Return Debian's packages of a ROS package, of those in requirements/optional.apt."""
    listed = (ROOT / 'requirements' / 'optional.apt').read_text(encoding='utf-8').splitlines()
    plain = re.escape(name.replace('_', '-'))
    return [line for line in listed if re.fullmatch(rf'(lib|python3-|ros-)?{plain}(-dev)?', line)]


def write_test(room: Path, launch: Path, given: list[str]) -> Path:
    """Write a rostest that passes when the launch file simulates a model; return its path."""
    package = room / 'src' / PACKAGE
    package.mkdir(exist_ok=True)
    (package / 'package.xml').write_text(MANIFEST.format(package=PACKAGE), encoding='utf-8')
    shutil.copy(Path(__file__).with_name('simulation_runs.py'), package)
    pairs = (word.partition(':=') for word in given)
    inside = ''.join(
        f'<arg name={quoteattr(name)} value={quoteattr(value)}/>' for name, _, value in pairs
    )
    path = package / f'{launch.stem}_launch.test'
    path.write_text(
        SIMULATES.format(
            file=quoteattr(str(launch)),
            arguments=inside,
            name=quoteattr(launch.stem),
            package=PACKAGE,
            patience=PATIENCE,
            limit=2 * PATIENCE,
        ),
        encoding='utf-8',
    )
    return path


def run_test(room: Path, path: Path, folder: Path) -> int:
    """Run a rostest in the workspace `room`; return its exit code."""
    name = path.relative_to(folder) if folder in path.parents else path.name
    print(f'==> {name}', flush=True)
    environment = {**os.environ, 'ROS_TEST_RESULTS_DIR': str(room / 'results')}
    environment.pop('ROS_MASTER_URI', None)
    enter = f'source {shlex.quote(str(room))}/devel/setup.bash && exec rostest "$0"'
    return subprocess.run(
        ['bash', '-c', enter, str(path)], env=environment, stdin=subprocess.DEVNULL, check=False
    ).returncode


if __name__ == '__main__':
    sys.exit(main())
