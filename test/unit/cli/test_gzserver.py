"""gzserver's command line: Gazebo's options are accepted; those without effect are reported."""

import logging

import pytest
from support import ROOT
from support.programs import python
from support.refusals import exit_code

from rosbots_description.cli.gzserver import main, parser, remarks, split_remappings
from rosbots_description.ros_api.node import node

REQUIREMENTS = ROOT / 'requirements' / 'core.pip'


def _read(line):
    given, unknown = parser().parse_known_args(line.split())
    return given, remarks(given, unknown)


def test_command_line_of_the_launch_file_gives_no_message():
    given, messages = _read('-u --verbose -e ode worlds/empty.world')
    assert given.pause
    assert given.world == 'worlds/empty.world'
    assert messages == ()


def test_plugins_and_lockstep_are_accepted():
    given, messages = _read('-s liba.so -s libb.so --lockstep --minimal_comms --iters 100')
    assert (given.iters, messages) == (100, ())


@pytest.mark.parametrize(
    'option',
    [
        '-p state.log',
        '--play state.log',
        '-o fast',
        '--profile fast',
        '--record_path /tmp/log',
        '--record_period 0.1',
        '--record_encoding zlib',
        '--record_filter robot',
    ],
)
def test_value_of_an_option_is_not_taken_as_the_world(option):
    given, ((level, text),) = _read(f'{option} my.world')
    assert given.world == 'my.world'
    assert level == logging.WARNING
    assert 'not supported' in text


@pytest.mark.parametrize('option', ['-v', '--version'])
def test_version_is_one_line(option, capsys):
    assert exit_code(main, [option]) == 0
    (line,) = capsys.readouterr().out.splitlines()
    assert 'PyBullet' in line


def test_seed_is_used_without_a_message():
    given, unknown = parser().parse_known_args(['--seed', '7'])
    assert (given.seed, remarks(given, unknown)) == (7, ())
    assert parser().parse_args([]).seed == 0


def test_another_engine_gives_an_info_message():
    _, ((level, text),) = _read('-e bullet')
    assert level == logging.INFO
    assert "'bullet'" in text
    assert 'PyBullet' in text


def test_recording_and_unknown_options_are_warnings():
    _, messages = _read('-r --hologram')
    assert [level for level, _ in messages] == [logging.WARNING, logging.WARNING]
    assert '--hologram' in messages[0][1]
    assert 'rosbag' in messages[1][1]


def test_remappings_are_not_options():
    assert split_remappings(['-u', '__name:=gazebo', 'a.world', 'a:=b']) == (
        ['-u', 'a.world'],
        ['__name:=gazebo', 'a:=b'],
    )


@pytest.mark.parametrize(
    ('name', 'said'),
    [
        ('worlds/mud.world', "'worlds/mud.world'"),
        ('x' * 300, 'xxx'),  # longer than any name of a file
        ('a\x1b]0;b\0', 'there is no world file'),
    ],
)
def test_missing_world_is_one_error_line(capsys, name, said):
    assert main([name]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert said in line
    assert line.isprintable()


REQUIRED = [
    line.split(' ')[0]
    for line in REQUIREMENTS.read_text().splitlines()
    if line.startswith(('pybullet', 'pycollada'))
]


@pytest.mark.parametrize('requirement', REQUIRED)
def test_missing_module_is_one_error_line(requirement):
    module = requirement.split('==')[0].replace('pycollada', 'collada')
    program = (
        f"import sys; sys.modules['{module}'] = None; "
        'from rosbots_description.cli.gzserver import main; sys.exit(main([]))'
    )
    ended = python(program)
    assert ended.returncode == 1
    (line,) = ended.stderr.splitlines()
    assert line.endswith(f'pip install {requirement}')


def test_verbose_reaches_the_node(monkeypatch):
    given = []
    monkeypatch.setattr(node, 'run', lambda options, _remappings: given.append(options) or 0)
    main(['--verbose'])
    main([])
    assert [options.verbose for options in given] == [True, False]
