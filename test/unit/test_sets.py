"""Each command installs the set it needs; one table chooses what comes from Debian."""

import re
import runpy
import shutil
from functools import partial

import pytest
from support import ROOT
from support.programs import in_setup, ran

REQUIREMENTS = ROOT / 'requirements'
# Of which commands ask for one.
SETS = ('demo', 'base', 'web', 'gym', 'batch', 'navigation', 'doc', 'test', 'bench')
INNER = 'core'  # which others include


def entries(path):
    lines = (line.partition('#')[0].split() for line in path.read_text().splitlines())
    return [line for line in lines if line]


def lines_of(script, debian='12', architecture='amd64'):
    """Return the lines that a script prints, with the functions of the set-up, on a platform."""
    done = in_setup(f'DEBIAN={debian} ARCHITECTURE={architecture}; {script}')
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def debian_packages(name, **platform):
    return set(lines_of(f'with_included {name}; debian_packages "${{CHOSEN[@]}}"', **platform))


def python_packages(name, **platform):
    lines = lines_of(f'with_included {name}; python_requirements "${{CHOSEN[@]}}"', **platform)
    return {re.split('[=; ]', line)[0] for line in lines}


@pytest.fixture
def sets_of(tmp_path):
    """Return a function that returns the sets which a command asks for, and its exit code."""
    shutil.copy(ROOT / 'rosbots', tmp_path)
    (tmp_path / 'tools').mkdir()
    (tmp_path / 'tools' / 'environment.bash').touch()
    (tmp_path / 'tools' / 'setup.bash').write_text(
        f'SETS=({" ".join(SETS)}); set_up() {{ echo "$@"; exit; }}'
    )

    return partial(ran, tmp_path / 'rosbots')


@pytest.mark.parametrize(
    ('command', 'sets'),
    [
        ('demo', 'demo'),
        ('demo --web', 'web'),
        ('shell', 'base'),
        ('exec true', 'base'),
        ('launch gazebo_ros empty_world.launch', 'base'),
        ('launch gazebo_ros empty_world.launch gui:=false web:=true', 'web'),
        ('launch gazebo_ros empty_world.launch web:=True', 'web'),
        ('launch gazebo_ros empty_world.launch web:=false', 'base'),
        ('batch scenario.yaml', 'batch'),
        ('bench web', 'bench'),
        ('test unit', 'test'),
        ('link workspace', 'base'),
        ('navigation', 'navigation'),
        ('doc', 'doc'),
        ('setup', 'base'),
        ('setup gym web', 'gym web'),
        ('setup --all', ' '.join(SETS)),
    ],
)
def test_command_installs_its_set(sets_of, command, sets):
    assert sets_of(*command.split()).stdout.strip() == sets


def test_unknown_set_is_named_with_the_known_ones(sets_of):
    result = sets_of('setup', 'base', 'moon')
    assert (result.returncode, result.stdout) == (2, '')
    assert result.stderr == (
        "rosbots: there is no set 'moon'; the sets are demo base web gym "
        'batch navigation doc test bench, and --all is all of them\n'
    )


def test_files_are_those_of_the_sets():
    assert {path.stem for path in REQUIREMENTS.glob('*.pip')} == {INNER, *SETS}
    assert {path.stem for path in REQUIREMENTS.glob('*.apt')} <= {INNER, *SETS, 'optional'}


@pytest.mark.parametrize('name', [INNER, *SETS])
def test_first_line_says_what_a_set_is_for_and_how_large_it_is(name):
    (line,) = lines_of(f'purpose {name}')
    assert re.fullmatch(r'[a-z].+: .*\d+ [MG]B of .* packages.*', line)


def test_included_sets_come_first_and_once():
    assert lines_of('with_included gym test; echo "${CHOSEN[@]}"') == [
        'core demo base gym web batch doc test'
    ]


def test_python_packages_are_pinned_or_come_from_debian():
    served = {row[0]: set(row[2:]) for row in entries(REQUIREMENTS / 'debian.txt')}
    for path in REQUIREMENTS.glob('*.pip'):
        for entry in entries(path):
            if entry[0] != '-r' and '==' not in entry[0]:
                assert served[entry[0]] == {'12', '13'}, entry[0]


def test_rows_of_the_table_are_of_packages_in_the_lists():
    names = {
        re.split('==', entry[0])[0]
        for path in REQUIREMENTS.glob('*.pip')
        for entry in entries(path)
    }
    assert {row[0] for row in entries(REQUIREMENTS / 'debian.txt')} <= names


@pytest.mark.parametrize('architecture', ['amd64', 'arm64'])
@pytest.mark.parametrize('debian', ['12', '13'])
def test_a_python_package_comes_from_debian_or_from_pypi(debian, architecture):
    platform = {'debian': debian, 'architecture': architecture}
    packages, modules = debian_packages('web', **platform), python_packages('web', **platform)
    assert ('python3-moderngl' in packages) == (debian == '13') == ('moderngl' not in modules)
    assert ('python3-websockets' in packages) == (debian == '13') == ('websockets' not in modules)
    assert 'python3-numpy' in packages
    assert 'numpy' not in modules
    assert {'pybullet', 'viser'} <= modules


@pytest.mark.parametrize(
    ('platform', 'builds'),
    [
        (('12', 'amd64'), False),
        (('13', 'amd64'), True),
        (('12', 'arm64'), True),
        (('13', 'arm64'), True),
    ],
)
def test_headers_of_python_are_installed_where_something_is_built(platform, builds):
    debian, architecture = platform
    packages = debian_packages('demo', debian=debian, architecture=architecture)
    assert ({'build-essential', 'cmake', 'python3-dev', 'python3-setuptools'} <= packages) == builds


def test_base_has_no_browser_and_no_test_tools():
    everything = debian_packages('test'), python_packages('test')
    for name, of_all in zip(('chromium', 'ray'), everything, strict=True):
        assert name in of_all
    assert not {'chromium', 'catkin-lint', 'python3-pytest', 'xvfb'} & debian_packages('base')
    assert python_packages('base') == {
        'embreex',
        'matplotlib',
        'moderngl',
        'pybullet',
        'pycollada',
        'xacro',
    }


def test_the_demo_needs_no_compiler_no_catkin_and_no_rviz():
    assert not {'build-essential', 'catkin', 'cmake', 'rviz'} & debian_packages('demo')


def test_wheel_is_made_of_the_version_in_the_list():
    version = runpy.run_path(str(ROOT / 'tools' / 'pybullet_build' / 'wheel.py'))['VERSION']
    assert [f'pybullet=={version}'] in entries(REQUIREMENTS / 'core.pip')
