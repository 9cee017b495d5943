"""Programs start with any locale and any standard streams."""

import os
import subprocess
import sys
import textwrap

import pytest
from support import ROOT
from support.programs import python, ran_by_python

# Prints its arguments and encodings; its argument is a file to write.
PROGRAM = textwrap.dedent("""\
    import os, sys
    from rosbots_description.cli.program import run

    def main():
        print('größe', sys.argv[1:], flush=True)
        print('Kürbis', file=sys.stderr)
        with open(sys.argv[1], 'w') as file:
            file.write(f'{sys.getfilesystemencoding()} {os.fstat(1) and os.fstat(2) and "open"}')
        return 7

    sys.exit(run(main))
    """)


@pytest.fixture
def run(tmp_path):
    """Return a function (redirections, variables) -> (exit code, output, errors, file content)."""
    program, seen = tmp_path / 'program.py', tmp_path / 'gesehen ä'
    program.write_text(PROGRAM, encoding='utf-8')

    def run_program(redirections='', **variables):
        python_path = os.pathsep.join([str(ROOT / 'src'), *sys.path])
        done = subprocess.run(
            [
                'bash',
                '-c',
                f'set -o pipefail; "$@" {redirections}',
                'bash',
                sys.executable,
                program,
                seen,
            ],
            env={'PATH': os.environ['PATH'], 'PYTHONPATH': python_path, **variables},
            capture_output=True,
            timeout=60,
            check=False,
        )
        return done.returncode, done.stdout, done.stderr, seen.read_text(encoding='utf-8')

    return run_program


UTF8 = "größe ['".encode()
SEEN = 'utf-8 open'


@pytest.mark.parametrize(
    'variables',
    [
        {},
        {'LANG': 'C'},
        {'LC_ALL': 'C'},
        {'LC_ALL': 'POSIX'},
        {'LC_ALL': 'C.UTF-8'},
        {'LC_ALL': 'C', 'PYTHONUTF8': '0'},
        {'PYTHONUTF8': '0', 'PYTHONCOERCECLOCALE': '0'},
    ],
    ids=str,
)
def test_file_names_and_text_are_utf8_in_every_locale(run, variables):
    code, output, errors, seen = run(**variables)
    assert (code, seen) == (7, SEEN)
    assert output.startswith(UTF8)
    assert errors == 'Kürbis\n'.encode()


def test_output_with_ascii_encoding_gets_escapes(run):
    code, output, errors, seen = run(PYTHONIOENCODING='ascii')
    assert (code, seen) == (7, SEEN)
    assert output.startswith(b"gr\\xf6\\xdfe ['")
    assert errors == b'K\\xfcrbis\n'


def test_process_is_named_after_the_program(tmp_path):
    program = tmp_path / 'gzserver'
    program.write_text(
        textwrap.dedent("""\
        import sys
        from pathlib import Path
        from rosbots_description.cli.program import run

        def main():
            print(Path("/proc/self/comm").read_text(), end='')
            return 0

        sys.exit(run(main))
        """),
        encoding='utf-8',
    )
    done = ran_by_python(program)
    assert (done.returncode, done.stdout) == (0, 'gzserver\n')


THREADS = textwrap.dedent("""\
    import os, sys
    from rosbots_description.cli.program import run

    def main():
        import numpy
        print(len(os.listdir('/proc/self/task')))
        return 0

    sys.exit(run(main))
    """)


def test_numpy_starts_no_threads_of_its_own(monkeypatch):
    monkeypatch.delenv('OPENBLAS_NUM_THREADS', raising=False)
    done = python(THREADS)
    assert (done.returncode, done.stdout) == (0, '1\n')


INTERRUPTED = textwrap.dedent("""\
    import os, signal, sys, time
    from rosbots_description.cli.program import run

    def main():
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(10.0)

    sys.exit(run(main))
    """)


def test_unexpected_ctrl_c_ends_silently():
    done = python(INTERRUPTED)
    assert (done.returncode, done.stderr) == (130, '')


@pytest.mark.parametrize(
    'redirections',
    [
        '>&-',
        '2>&-',
        '<&-',
        '<&- >&-',
        '<&- >&- 2>&-',
        '>/dev/full',
        '>/dev/full 2>&1',
        '2>&1 | true',
    ],
)
def test_closed_or_full_streams_do_not_stop_the_program(run, redirections):
    code, _, errors, seen = run(redirections)
    assert (code, seen) == (7, SEEN)
    assert b'Error' not in errors
