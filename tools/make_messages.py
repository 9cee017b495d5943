"""Generate the Python modules of the messages in companions/, as catkin does, but without catkin.

usage: make_messages.py COMPANIONS OUTPUT
"""

from __future__ import annotations

import sys
from pathlib import Path

from genpy.generate_initpy import write_modules
from genpy.generator import MsgGenerator, SrvGenerator

SHARE = Path('/usr/share')  # of Debian's message packages
KINDS = {'msg': MsgGenerator, 'srv': SrvGenerator}


def main(companions: Path, output: Path) -> int:
    """Write OUTPUT/PACKAGE/{msg,srv}; return the exit code."""
    found = {path.parent.name: [str(path)]
             for folder in (SHARE, companions) for path in folder.glob('*/msg')}
    code = 0
    for package in sorted(companions.glob('*_msgs')):
        for kind, generator in KINDS.items():
            files = sorted(map(str, package.glob(f'{kind}/*.{kind}')))
            target = output / package.name / kind
            target.mkdir(parents=True, exist_ok=True)
            if files:
                code |= generator().generate_messages(package.name, files, str(target), found)
            write_modules(str(target))
        (output / package.name / '__init__.py').touch()
    return code


if __name__ == '__main__':
    sys.exit(main(*map(Path, sys.argv[1:])))
