"""Runner of the benchmark's parts: names, durations, progress and cleanup."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from support import ROOT
from support.programs import ran

BENCHMARK = ROOT / 'benchmark'
DEADLINE = 60.0  # [s, wall] timeout of what usually takes a second
RUNNER = """
import pathlib, sys
sys.path.insert(0, {benchmark!r})
import run
run.FOLDER, run.PARTS, run.REMINDER = pathlib.Path({folder!r}), {{'part': 7.0}}, 0.0
sys.exit(run.main(sys.argv[1:]))
"""
# Leaves a file and an orphan in a session of its own that ignores signals.
STUBBORN = """
import os, signal, sys, tempfile, time
handle, name = tempfile.mkstemp()
if os.fork() == 0:
    os.setsid()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    if os.fork() == 0:
        print(os.getpid(), name)
        time.sleep(100.0)
    os._exit(0)
os.wait()
{end}
"""


@pytest.fixture
def run(monkeypatch):
    """Return the module."""
    monkeypatch.syspath_prepend(str(BENCHMARK))
    import run

    return run


def runner(folder, *arguments):
    """Start the runner with `folder` as the folder of parts."""
    program = RUNNER.format(benchmark=str(BENCHMARK), folder=str(folder))
    return subprocess.Popen(
        [sys.executable, '-c', program, *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | {'PYTHONPATH': str(ROOT / 'src')},
    )


def is_running(pid):
    return Path(f'/proc/{pid}').exists()


@pytest.mark.parametrize('number', [signal.SIGTERM, signal.SIGINT])
def test_a_signal_leaves_no_process_and_no_file(tmp_path, number):
    (tmp_path / 'part.py').write_text(STUBBORN.format(end='time.sleep(100.0)'))
    process = runner(tmp_path)
    assert process.stdout.readline() == '== part, about 7 s\n'
    pid, name = process.stdout.readline().split()
    assert is_running(pid)
    process.send_signal(number)
    _, complaints = process.communicate(timeout=DEADLINE)
    assert process.returncode == 128 + number
    assert 'Traceback' not in complaints
    assert not is_running(pid)
    assert not os.path.exists(name)
    assert not os.path.exists(os.path.dirname(name))


def test_orphans_of_a_part_end_with_it(tmp_path):
    (tmp_path / 'part.py').write_text(STUBBORN.format(end='sys.exit(3)'))
    process = runner(tmp_path)
    printed, _ = process.communicate(timeout=DEADLINE)
    assert process.returncode == 3
    assert not is_running(printed.splitlines()[-1].split()[0])


def test_progress_is_shown_while_a_part_is_silent(tmp_path):
    (tmp_path / 'part.py').write_text('import time\ntime.sleep(2.5)\nprint("result")\n')
    printed, progress = runner(tmp_path).communicate(timeout=DEADLINE)
    assert printed.splitlines() == ['== part, about 7 s', 'result']
    assert progress.splitlines()[0] == 'part: 1 s of about 7 s'


def test_arguments_after_a_single_part_are_passed_to_it(tmp_path):
    (tmp_path / 'part.py').write_text('import sys\nprint(sys.argv[1:])\n')
    process = runner(tmp_path, 'part', '--seconds', '3')
    printed, _ = process.communicate(timeout=DEADLINE)
    assert printed.splitlines()[-1] == "['--seconds', '3']"


@pytest.mark.parametrize(
    ('arguments', 'parts', 'own'),
    [
        ([], ['fidelity', 'physics'], []),
        (['speed', 'veer'], ['speed', 'veer'], []),
        (['fidelity', 'a.csv', 'b.csv'], ['fidelity'], ['a.csv', 'b.csv']),
        (['soak', '--seconds', '20'], ['soak'], ['--seconds', '20']),
    ],
)
def test_parts_are_separated_from_arguments(run, arguments, parts, own):
    chosen, given = run.chosen(arguments)
    assert chosen[:2] == parts
    assert given == own


def test_soak_runs_only_by_name(run):
    assert 'soak' not in run.chosen([])[0]


def test_error_about_an_unknown_part_lists_the_known_ones(run, capsys):
    assert run.main(['sped', 'speed']) == 2
    said = capsys.readouterr().err
    assert "there is no benchmark 'sped'; there are: fidelity " in said


def test_estimate_for_soak_follows_its_argument(run):
    assert run.duration('soak', ['--seconds', '20']) == pytest.approx(80.0)
    assert run.duration('soak', []) > 600.0


def test_help_readme_and_contributing_list_every_part(run):
    texts = [
        ran(ROOT / 'rosbots', 'help').stdout,
        *((ROOT / name).read_text(encoding='utf-8') for name in ('README.md', 'CONTRIBUTING.md')),
    ]
    for text in texts:
        lines = ' '.join(line for line in text.splitlines() if 'bench' in line)
        for part in (*run.PARTS, *run.LONG):
            assert part in lines
    for part in (*run.PARTS, *run.LONG):
        assert (BENCHMARK / f'{part}.py').is_file()
