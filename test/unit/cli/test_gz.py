"""The command line of gz, as far as it needs no simulator."""

import pytest
from support import ROOT
from support.refusals import exit_code

from rosbots_description.cli import gz

WORLD = '<sdf version="1.6"><world name="w">{}</world></sdf>'
MODEL = '<model name="m"><link name="l"/></model>'
URDF = (
    '<robot name="r"><link name="l"><inertial><mass value="1"/>'
    '<inertia ixx="1" iyy="1" izz="1"/></inertial></link></robot>'
)
NO_MASTER = 'http://localhost:9'  # the port of the service "discard"


def test_help_names_every_command_and_gazebos_long_options(capsys):
    for command, option in (
        ('model', '--spawn-file FILE'),
        ('world', '--multi-step N'),
        ('sdf', '--check FILE'),
        ('stats', '--duration SECONDS'),
        ('topic', '--echo TOPIC'),
        ('physics', '--update-rate HZ'),
    ):
        assert exit_code(gz.main, ['help', command]) == 0
        assert option in capsys.readouterr().out


@pytest.mark.parametrize('command', gz.NOT_HERE)
def test_a_command_that_is_not_there_says_so_in_one_sentence(command, capsys):
    for arguments in ([command, '-x', 'any'], ['help', command]):
        assert gz.main(arguments) == 1
        printed = capsys.readouterr()
        assert printed.out == ''
        assert printed.err.startswith(f'gz {command}: this command of Gazebo is not supported; ')
        assert printed.err.count('\n') == 1


@pytest.mark.parametrize(
    ('arguments', 'complaint'),
    [
        ([], 'required: COMMAND'),
        (['fly'], "invalid choice: 'fly'"),
        (['world'], 'world: nothing to do'),
        (['world', '-p', '2'], 'invalid choice: '),
        (['world', '-m', '-1'], "'-1' is not a number of steps"),
        (['model', '-x', '1'], 'the name of a model is needed: -m NAME'),
        (['model', '-m', 'box'], 'model: nothing to do'),
        (['model', '-m', 'box', '-x', 'far'], "'far' is not a finite number"),
        (['model', '-l', '-d'], 'not allowed with'),
        (['physics', '-g', '1,2'], 'is not three numbers with commas'),
        (['sdf'], 'one of the arguments'),
        (['stats', '-d', 'nan'], "'nan' is not a finite number"),
    ],
)
def test_wrong_usage_ends_with_2_and_names_the_option(arguments, complaint, capsys):
    assert exit_code(gz.main, arguments) == 2
    assert complaint in capsys.readouterr().err


@pytest.mark.parametrize('arguments', [['sdf', '-d'], ['sdf', '-c', 'x.sdf'], ['topic', '-v']])
def test_an_option_that_is_not_there_says_so(arguments, capsys):
    assert gz.main(arguments) == 1
    assert 'supported' in capsys.readouterr().err


@pytest.mark.parametrize(
    'arguments',
    [
        ['stats'],
        ['world', '-p', '1'],
        ['model', '-l'],
        ['topic', '-l'],
        ['physics', '-i', '3'],
        ['world', '-p', '0'],
        ['model', '-m', 'box', '-x', '0'],
        ['physics', '-u', '0'],
        ['model', '-w', 'default', '-l'],
        ['physics', '-w', 'default', '-i', '3'],
        ['stats', '-w', 'default'],
        ['topic', '-w', 'default', '-l'],
        ['world', '-w', 'default', '-p', '1'],
    ],
)
def test_without_a_master_one_sentence_says_what_to_start(arguments, monkeypatch, capsys):
    monkeypatch.setenv('ROS_MASTER_URI', NO_MASTER)
    monkeypatch.setattr('rospy.signal_shutdown', lambda _reason: None)  # not of this process
    assert gz.main(arguments) == 1
    error = capsys.readouterr().err
    assert error.startswith(f'gz {arguments[0]}: there is no ROS master at {NO_MASTER}')
    assert 'roslaunch gazebo_ros empty_world.launch' in error
    assert error.count('\n') == 1


@pytest.mark.parametrize('text', [WORLD.format(MODEL), f'<sdf version="1.6">{MODEL}</sdf>', URDF])
def test_a_check_of_a_valid_description_says_that_it_is_complete(text, tmp_path, capsys):
    file = tmp_path / 'file'
    file.write_text(text)
    assert gz.main(['sdf', '-k', str(file)]) == 0
    assert capsys.readouterr().out == 'Check complete\n'


@pytest.mark.parametrize(
    ('text', 'complaint'),
    [
        ('<sdf version="1.6"><model name="m"/></sdf>', 'the model has no <link>'),
        (WORLD.format('<model/>'), 'is read without 1 of its parts'),
        ('<robot><link/></robot>', 'line 1'),
        ('not XML', 'line 1'),
    ],
)
def test_a_check_fails_with_file_and_line(text, complaint, tmp_path, capsys):
    file = tmp_path / 'file'
    file.write_text(text)
    assert gz.main(['sdf', '-k', str(file)]) == 1
    error = capsys.readouterr().err
    assert error.startswith(f'gz sdf: {file}')
    assert complaint in error


def test_a_file_that_is_not_there_is_named(capsys):
    assert gz.main(['sdf', '-p', '/nowhere.sdf']) == 1
    assert '/nowhere.sdf' in capsys.readouterr().err


def test_an_sdf_is_printed_as_it_is_and_a_urdf_is_converted(tmp_path, capsys):
    (tmp_path / 'w').write_text(WORLD.format(MODEL))
    (tmp_path / 'r').write_text(URDF)
    assert gz.main(['sdf', '-p', str(tmp_path / 'w')]) == 0
    assert capsys.readouterr().out == WORLD.format(MODEL) + '\n'
    assert gz.main(['sdf', '-p', str(tmp_path / 'r')]) == 0
    converted = capsys.readouterr().out
    assert '<model name="r">' in converted
    (tmp_path / 'r').write_text(converted)
    assert gz.main(['sdf', '-k', str(tmp_path / 'r')]) == 0


def test_gazebos_programs_are_installed_to_the_path():
    rules = (ROOT / 'companions' / 'gazebo_ros' / 'CMakeLists.txt').read_text(encoding='utf-8')
    (on_path,) = (
        block
        for block in rules.split('catkin_install_python(')
        if 'CATKIN_GLOBAL_BIN_DESTINATION' in block
    )
    assert {line.strip() for line in on_path.splitlines() if 'scripts/' in line} == {
        f'scripts/{name}' for name in ('gazebo', 'gz', 'gzclient', 'gzserver')
    }
