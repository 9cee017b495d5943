"""Surroundings that only one command sees: file systems, a network, a name of its own."""

import os
import subprocess

import pytest

# Root may do it, unless in a container that forbids it; others need to become root of their own.
_OWN = () if os.geteuid() == 0 else ('--map-root-user',)


def unshare(*kinds: str) -> tuple[str, ...]:
    """Return the beginning of a command that gets its own of each kind: mount, net, uts.

    The test is skipped where the machine does not permit it.
    """
    command = ('unshare', *_OWN, *(f'--{kind}' for kind in kinds))
    done = subprocess.run([*command, 'true'], capture_output=True, text=True, check=False)
    if done.returncode:
        pytest.skip(f'this machine does not permit it: {done.stderr.strip()}')
    return command
