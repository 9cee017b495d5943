"""Namespaces of one command: its own mounts, network or host name."""

import os

import pytest

from .programs import ran

# Root may unshare, unless a container forbids it; other users need a user namespace.
_OWN = () if os.geteuid() == 0 else ('--map-root-user',)


def unshare(*kinds: str) -> tuple[str, ...]:
    """Return the prefix of a command that runs it in new namespaces: mount, net, uts.

    Skips the test where the machine does not permit it.
    """
    command = ('unshare', *_OWN, *(f'--{kind}' for kind in kinds))
    done = ran(*command, 'true')
    if done.returncode:
        pytest.skip(f'this machine does not permit it: {done.stderr.strip()}')
    return command
