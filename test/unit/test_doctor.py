"""./rosbots doctor shows what is installed, what is missing and the cure, and installs nothing."""

import io
import os
import re
import runpy
import shutil
import sys

import pytest
from support import ROOT
from support.programs import in_setup, ran

DOCTOR = runpy.run_path(str(ROOT / 'tools' / 'doctor.py'))
ROWS = (
    'platform',
    'clone',
    'versions',
    'set demo',
    'set base',
    'set web',
    'set gym',
    'set batch',
    'set navigation',
    'set doc',
    'set test',
    'set bench',
    'workspace',
    'OpenGL',
    'display',
    'ports',
    'terminal',
)


def doctor(clone, *arguments, **environment):
    return ran(clone / 'rosbots', 'doctor', *arguments, env={**os.environ, **environment})


def in_doctor(script, **environment):
    """Return what a script prints that has the functions of the doctor."""
    return in_setup(f'source "$ROOT/tools/doctor.bash"; {script}', **environment).stdout


@pytest.fixture
def clone(tmp_path):
    """Return a clone in which nothing was set up."""
    made = tmp_path / 'clone'
    made.mkdir()
    shutil.copy(ROOT / 'rosbots', made)
    for folder in ('tools', 'requirements', 'companions', 'scripts'):
        shutil.copytree(ROOT / folder, made / folder, symlinks=True)
    return made


def test_one_screen_of_a_machine_on_which_the_project_runs():
    result = doctor(ROOT)
    assert result.returncode == 0, result.stdout + result.stderr
    lines = result.stdout.splitlines()
    assert tuple(line[:14].rstrip() for line in lines) == ROWS
    assert lines[ROWS.index('set base')].split()[2:] == ['ready']
    assert 'pybullet 3.2.7' in lines[ROWS.index('versions')]


def test_clone_without_set_up_is_told_the_command_and_left_as_it_is(clone):
    before = sorted(clone.rglob('*'))
    result = doctor(clone)
    assert result.returncode == 1
    (base,) = [line for line in result.stdout.splitlines() if line.startswith('set base')]
    assert base.startswith('set base       missing: ')
    assert re.search(r' [1-9] Python packages', base)  # fewer where Debian has more
    assert base.endswith('; ./rosbots setup base')
    assert sorted(clone.rglob('*')) == before


def test_missing_debian_package_is_named():
    line = in_doctor(
        'choose_sets base; debian_packages() { echo no-such-package; }; missing_modules() { :; }; '
        'state base',
        WORKSPACE='/nowhere',
    )
    assert line == (
        'missing: 1 Debian packages (no-such-package), 0 Python packages; ./rosbots setup base\n'
    )


def test_stack_that_is_not_built_is_told_its_command():
    script = (
        'choose_sets navigation; packages_done() {{ :; }}; python_done() {{ :; }}; '
        'navigation_done() {{ {}; }}; state navigation'
    )
    said = [in_doctor(script.format(done), WORKSPACE='/nowhere') for done in ('false', 'true')]
    assert said == ['not built; ./rosbots navigation\n', 'ready\n']


def test_report_names_no_user_no_machine_and_no_folder_of_theirs():
    text = 'CLONE of ada in /home/ada/rosbots on laptop.lan: ROS_IP=laptop.lan /data/x /home/eve/y'
    shown = in_doctor(
        f'id() {{ echo ada; }}; uname() {{ echo laptop.lan; }}; anonymous "{text}"',
        HOME='/home/ada',
    )
    assert shown == ('CLONE of NAME in ~/rosbots on NAME: ROS_IP=NAME /data/x /home/NAME/y\n')


def test_report_is_a_block_to_paste_without_the_path_of_the_clone():
    result = doctor(ROOT, '--report', PYTHONPATH=f'{ROOT}/mine')
    lines = result.stdout.splitlines()
    assert (lines[0], lines[-1]) == ('```text', '```')
    assert str(ROOT) not in result.stdout
    assert 'PYTHONPATH=CLONE/mine' in result.stdout


def test_unknown_option_is_refused():
    result = doctor(ROOT, '--cure')
    assert (result.returncode, result.stdout) == (2, '')
    assert result.stderr == 'rosbots: doctor takes --report or nothing\n'


@pytest.mark.parametrize(
    ('requirement', 'is_missing'),
    [
        ('no_such_package==1.0', True),
        ('pybullet==0.1', True),
        ('pybullet==3.2.7', False),
        ('no_such_package==1.0 ; platform_machine == "z80"', False),
        ('numpy', False),
    ],
)
def test_requirements_that_are_not_installed_are_found(requirement, is_missing):
    expected = [requirement.partition(' ;')[0]] if is_missing else []
    assert DOCTOR['missing']([requirement]) == expected


def test_missing_requirements_are_printed_one_per_line(monkeypatch, capsys):
    monkeypatch.setattr(sys, 'argv', ['doctor.py', 'missing'])
    monkeypatch.setattr(sys, 'stdin', io.StringIO('no_one==1\nnumpy\nno_two==2\n'))
    DOCTOR['main']()
    assert capsys.readouterr().out == 'no_one==1\nno_two==2'
