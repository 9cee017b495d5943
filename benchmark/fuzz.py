#!/usr/bin/env python3
"""Search for input that breaks a reader, a service or the engine: the tests' own generators.

Each property test tries a thousand examples, others each time, instead of the same forty. What
fails is reduced to a small example, which becomes a test once its cause is mended. Arguments are
pytest's, such as files, or -k 'properties and meshes'.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def main(arguments: list[str]) -> int:
    """Run the property tests with the profile of test/conftest.py; return pytest's exit code."""
    own = arguments or ['-k', 'properties', 'test/unit', 'test/engine']
    return subprocess.run(
        [sys.executable, '-m', 'pytest', '-q', '-n', 'auto', '--hypothesis-profile=search', *own],
        cwd=ROOT,
        check=False,
    ).returncode


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
