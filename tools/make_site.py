#!/usr/bin/env python3
"""Build the documentation as a site: the pages of doc/, and the reference of the Python API.

Links, names of pages and docstrings are checked; a fault ends it with exit code 1.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
START = 'index.html'


def main(argv: list[str] | None = None) -> int:
    """Build it; return the exit code."""
    parser = argparse.ArgumentParser(
        prog='./rosbots doc',
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        'folder',
        nargs='?',
        type=Path,
        metavar='FOLDER',
        default=ROOT / '.ws' / 'site',
        help='where it goes (default: .ws/site)',
    )
    folder = parser.parse_args(argv).folder.resolve()
    # NO_COLOR: the lines may go to a log.
    built = subprocess.run(
        [
            sys.executable,
            '-m',
            'sphinx',
            '--quiet',
            '--fail-on-warning',
            '--builder',
            'html',
            '--conf-dir',
            ROOT / 'doc',
            '--doctree-dir',
            ROOT / '.ws' / 'site_doctrees',
            ROOT,
            folder,
        ],
        env={**os.environ, 'NO_COLOR': '1'},
        check=False,
    ).returncode
    if not built:
        print(f'{folder / START}')
    return built


if __name__ == '__main__':
    sys.exit(main())
