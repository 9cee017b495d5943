"""Programs of packages: where they are, and what they print."""

import os
import subprocess
from contextlib import suppress
from functools import cache
from pathlib import Path

import rosgraph
import rosnode
from roslib.packages import find_node

HOPELESS = 60.0  # [s, wall] for a program that was told to end


@cache
def find_program(package, name):
    """Return the path of a program, as `rosrun` finds it; that asks anew, for half a second."""
    found = find_node(package, name)
    assert found, f'no program {name} in {package}'
    return found[0]


def ran(*command, stderr=subprocess.PIPE, timeout=3.0 * HOPELESS, check=False, **options):
    """Return a program that has ended, with the texts that it has printed.

    Args:
        options: of `subprocess.run`.
    """
    return subprocess.run(
        command,
        stdout=subprocess.PIPE,
        stderr=stderr,
        text=True,
        timeout=timeout,
        check=check,
        **options,
    )


def ran_merged(*command, **options):
    """Return such a program, with its errors among its output; it has no input."""
    return ran(*command, stdin=subprocess.DEVNULL, stderr=subprocess.STDOUT, **options)


def end(process):
    """End a program, if it still runs, so that it takes leave of the ROS master.

    Of a killed one the master keeps the address. When its name is registered again, the master
    shuts down whatever program has that address by then, perhaps one of another test.
    """
    if process.poll() is None:
        process.terminate()
        with suppress(subprocess.TimeoutExpired):
            process.wait(HOPELESS)
        process.kill()
    process.wait()


def kill_node(process, name):
    """Kill a node, like a crash, and remove it from the ROS master, as `rosnode cleanup` does.

    The master would go on to call its address, perhaps that of a node of another test by then.
    """
    process.kill()
    process.wait()
    rosnode.cleanup_master_blacklist(rosgraph.Master('/test'), [name])


def memory_of(pid):
    """Return the resident memory of a process [bytes]."""
    pages = int(Path(f'/proc/{pid}/statm').read_text(encoding='ascii').split()[1])
    return pages * os.sysconf('SC_PAGE_SIZE')


def keep(printed, name, process):
    """Add what a program has printed to the logs, which tools/rostests.py searches for errors."""
    if printed and (folder := os.environ.get('ROS_LOG_DIR')):
        log = Path(folder, f'{name.strip("/")}-{process.pid}-printed.log')
        log.write_text(printed, encoding='utf-8')
