"""Programs that tests run to their end."""

import os
import subprocess
import sys
from pathlib import Path

from . import ROOT
from .patience import PATIENCE


def ran(*command, timeout=2 * PATIENCE, **options):
    """Return a program that has ended, whatever its exit code, with what it has printed.

    Args:
        timeout: [s, wall] ends a hopeless wait.
        options: of `subprocess.run`.
    """
    return subprocess.run(
        command, capture_output=True, text=True, timeout=timeout, check=False, **options
    )


def ran_by_python(*arguments, **options):
    """Run Python with arguments; it can import what this process can."""
    environment = {**os.environ, 'PYTHONPATH': os.pathsep.join(sys.path)}
    return ran(sys.executable, *arguments, env=environment, **options)


def python(code, *arguments):
    """Run Python code with arguments."""
    return ran_by_python('-c', code, *arguments)


def lint_faults(code, name, *options):
    """Return what ruff finds in the text of a module, which need not exist as a file."""
    checked = ran('ruff', 'check', *options, '--stdin-filename', name, '-', input=code, cwd=ROOT)
    return '' if checked.returncode == 0 else checked.stdout + checked.stderr


def bash(script, *arguments, **environment):
    """Run lines of bash, up to the first that fails, in an environment with our ROOT alone."""
    environment = {'ROOT': str(ROOT), 'PATH': '/usr/bin:/bin', **environment}
    return ran('bash', '-euc', script, 'bash', *arguments, env=environment)


def in_setup(script, **environment):
    """Run a script with the functions of the set-up."""
    return bash(f'source "$ROOT/tools/setup.bash"; {script}', **environment)


def is_running(process):
    """Return whether a process runs; a zombie, which nobody has reaped yet, does not."""
    try:
        state = Path(f'/proc/{process}/stat').read_text().rpartition(')')[2].split()[0]
    except (FileNotFoundError, ProcessLookupError):  # the second if it ends while it is read
        return False
    return state != 'Z'
