"""Generate the code of the messages in companions/, as catkin does, but all in one process.

catkin starts three for each message, which take most of the time of the set-up.

usage: make_messages.py COMPANIONS MODULES [PACKAGE [HEADERS]]
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from genmsg.template_tools import generate_from_file
from genpy.generate_initpy import write_modules
from genpy.generator import MsgGenerator, SrvGenerator

SHARE = Path('/usr/share')  # of Debian's message packages
TEMPLATES = SHARE / 'gencpp'
KINDS = {'msg': MsgGenerator, 'srv': SrvGenerator}
# The messages of an action {0}, beside the three in its file.
ACTION = {
    'Action': '{0}ActionGoal action_goal\n{0}ActionResult action_result\n'
    '{0}ActionFeedback action_feedback\n',
    'ActionGoal': 'Header header\nactionlib_msgs/GoalID goal_id\n{0}Goal goal\n',
    'ActionResult': 'Header header\nactionlib_msgs/GoalStatus status\n{0}Result result\n',
    'ActionFeedback': 'Header header\nactionlib_msgs/GoalStatus status\n{0}Feedback feedback\n',
}


def main(
    companions: Path, modules: Path, package: str = '*_msgs', headers: Path | None = None
) -> int:
    """Write MODULES/PACKAGE/{msg,srv} and, if given, HEADERS/PACKAGE; return the exit code."""
    with tempfile.TemporaryDirectory() as folder:
        return _generate(
            companions, sorted(companions.glob(package)), modules, headers, Path(folder)
        )


def write_action_messages(package: Path, output: Path) -> None:
    """Write the definitions of the messages that make up the actions of a package."""
    output.mkdir(parents=True, exist_ok=True)
    for path in package.glob('action/*.action'):
        name, parts = path.stem, path.read_text(encoding='utf-8').split('\n---')
        texts = dict(zip(('Goal', 'Result', 'Feedback'), parts, strict=True))
        texts |= {kind: text.format(name) for kind, text in ACTION.items()}
        for kind, text in texts.items():
            (output / f'{name}{kind}.msg').write_text(text, encoding='utf-8')


def _generate(
    companions: Path, packages: list[Path], modules: Path, headers: Path | None, actions: Path
) -> int:
    for package in packages:
        write_action_messages(package, actions / package.name / 'msg')
    found: dict[str, list[str]] = {}
    for folder in (SHARE, companions, actions):
        for path in folder.glob('*/msg'):
            found.setdefault(path.parent.name, []).append(str(path))
    code = 0
    for package in packages:
        name = package.name
        for kind, generator in KINDS.items():
            files = sorted(
                str(path)
                for folder in (package, actions / name)
                for path in folder.glob(f'{kind}/*.{kind}')
            )
            target = modules / name / kind
            target.mkdir(parents=True, exist_ok=True)
            if files:
                code |= generator().generate_messages(name, files, str(target), found)
            write_modules(str(target))
            if headers is not None:
                _write_headers(name, files, headers / name, found)
        (modules / name / '__init__.py').touch()
    return code


def _write_headers(
    package: str, files: list[str], output: Path, found: dict[str, list[str]]
) -> None:
    folders = [f'{name}:{folder}' for name, paths in found.items() for folder in paths]
    message, service = ({f'{kind}.h.template': '@NAME@.h'} for kind in KINDS)
    for file in files:
        generate_from_file(file, package, str(output), str(TEMPLATES), folders, message, service)


if __name__ == '__main__':
    sys.exit(main(*map(Path, sys.argv[1:3]), *sys.argv[3:4], *map(Path, sys.argv[4:])))  # type: ignore[arg-type]
