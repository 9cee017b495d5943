"""./rosbots passes on exit codes, and reports unknown commands in one sentence."""

import os
import re
import sys

import pytest
from support import ROOT
from support.programs import ran
from support.surroundings import unshare


def rosbots(*arguments, script='', prefix=(), **environment):
    command = (*prefix, ROOT / 'rosbots', *arguments)
    return ran(*command, input=script, env={**os.environ, **environment})


@pytest.mark.parametrize(
    ('arguments', 'code', 'message'),
    [
        (['help'], 0, ''),
        ([], 0, ''),
        (['fly'], 2, "there is no command 'fly'"),
        (['exec'], 2, 'exec needs a command'),
        (['exec', 'true'], 0, ''),
        (['exec', 'sh', '-c', 'exit 7'], 7, ''),
        (['exec', 'no_such_program'], 127, "no program 'no_such_program'"),
        (['link'], 2, 'link takes one workspace'),
        (['link', '/nowhere'], 2, 'there is no folder /nowhere/src'),
    ],
)
def test_exit_codes_and_error_messages(arguments, code, message):
    result = rosbots(*arguments)
    assert result.returncode == code
    assert message in result.stderr


def test_environment_has_the_packages_and_the_system_python():
    result = rosbots(
        'exec', 'sh', '-c', 'rospack find gazebo_msgs && python3 -c "import rospy, pybullet"'
    )
    assert result.returncode == 0, result.stderr
    assert 'gazebo_msgs' in result.stdout


def test_distutils_is_pythons_own_where_there_is_one():
    program = 'import distutils, setuptools; print(distutils.__file__)'
    result = rosbots(
        'exec',
        '/usr/bin/python3',
        '-W',
        'ignore',
        '-c',
        program,
        prefix=('env', '-u', 'SETUPTOOLS_USE_DISTUTILS'),
    )
    assert result.returncode == 0, result.stderr
    assert ('setuptools' in result.stdout) == (sys.version_info >= (3, 12))


def test_shell_reads_commands_and_has_roscd():
    result = rosbots('shell', script='roscd rosbots_description\npwd -P\nexit 3\n')
    assert result.returncode == 3, result.stderr
    assert result.stdout.strip() == str(ROOT)


def test_rosrun_finds_an_example_once_and_without_a_file_system_loop():
    result = rosbots('exec', 'rosrun', '--prefix', 'echo', 'rosbots_description', 'wander.py')
    assert result.stdout.split() == [str(ROOT / 'scripts' / 'wander.py')]
    assert (result.returncode, result.stderr) == (0, '')


@pytest.fixture
def theirs(tmp_path):
    """Return a sourced workspace with a package of the same name as ours."""
    package = tmp_path / 'src' / 'rosbots_description'
    package.mkdir(parents=True)
    (package / 'package.xml').write_text('<package><name>rosbots_description</name></package>')
    return package


def test_packages_are_linked_except_those_that_the_user_has(tmp_path):
    packages = {path.parent.name for path in ROOT.glob('companions/*/package.xml')}
    source = tmp_path / 'src'
    own = source / 'robots' / 'speech'
    own.mkdir(parents=True)
    (own / 'package.xml').write_text('<package><name>teleop_twist_keyboard</name></package>')
    (source / 'xacro').symlink_to(tmp_path / 'gone')
    result = rosbots('link', str(tmp_path), ROS_PACKAGE_PATH='')
    assert result.returncode == 0, result.stderr
    assert result.stdout.splitlines()[0] == (
        f'teleop_twist_keyboard is yours, in {own}; ours is left out'
    )
    linked = {link.name: link.resolve() for link in source.iterdir() if link.is_symlink()}
    assert linked == {
        name: ROOT / 'companions' / name for name in packages - {'teleop_twist_keyboard'}
    } | {'rosbots_description': ROOT}
    assert 'nothing new' in rosbots('link', str(tmp_path), ROS_PACKAGE_PATH='').stdout


def test_link_is_removed_where_the_user_has_a_package_of_that_name(theirs):
    by_hand = theirs.parent / 'anything'
    by_hand.symlink_to(ROOT)
    message = rosbots('link', str(theirs.parents[1]), ROS_PACKAGE_PATH='').stdout
    assert f'rosbots_description is yours, in {theirs}; ours is left out' in message
    assert not by_hand.is_symlink()
    assert (theirs / 'package.xml').exists()


def test_error_names_what_is_in_the_way_of_a_link(tmp_path):
    (tmp_path / 'src' / 'xacro').mkdir(parents=True)
    result = rosbots('link', str(tmp_path), ROS_PACKAGE_PATH='')
    assert (result.returncode, result.stderr) == (
        2,
        f'rosbots: {tmp_path}/src/xacro is in the way and is not a package of that name\n',
    )


def test_workspace_over_one_with_the_users_robot_gets_no_second_one(theirs, tmp_path):
    source = tmp_path / 'over' / 'src'
    source.mkdir(parents=True)
    (source / 'rosbots_description').symlink_to(ROOT)
    message = rosbots('link', str(source.parent), ROS_PACKAGE_PATH=str(theirs.parent)).stdout
    assert f'rosbots_description is yours, in {theirs}; ours is left out' in message
    assert not (source / 'rosbots_description').exists()
    assert (source / 'rosbots_simulator').exists()


def test_command_in_the_list_installs_the_optional_packages(tmp_path):
    (tmp_path / 'sudo').write_text('#!/bin/sh\necho "$@"\n')
    (tmp_path / 'sudo').chmod(0o755)
    text = (ROOT / 'requirements' / 'optional.apt').read_text()
    (command,) = re.findall('^# All of them: (.*)', text, re.M)
    done = ran('sh', '-c', command, cwd=ROOT, env={'PATH': f'{tmp_path}:/usr/bin:/bin'})
    packages = [line for line in text.splitlines() if line and not line.startswith('#')]
    assert done.stdout.split() == [
        'apt-get',
        'install',
        '-y',
        '--no-install-recommends',
        *packages,
    ]


@pytest.mark.parametrize(
    ('arguments', 'sees_theirs'),
    [
        (('exec', 'rospack'), True),
        (('launch',), True),
        (('shell', '-c', ':'), True),
        (('demo',), False),
        (('test',), False),
    ],
)
def test_users_package_takes_precedence_except_in_demo_and_test(
    arguments, sees_theirs, theirs, tmp_path
):
    # the final exec is replaced to show which package it would use
    instead = tmp_path / 'instead.bash'
    # (a redirection of the set-up is not the final one)
    instead.write_text(
        'exec() { if type -P "$1" > /dev/null; then rospack find rosbots_description; fi; }'
    )
    result = rosbots(*arguments, BASH_ENV=str(instead), ROS_PACKAGE_PATH=str(theirs.parent))
    found = os.path.realpath(result.stdout.strip())
    assert found == str(theirs if sees_theirs else ROOT), result.stderr


@pytest.mark.parametrize('path', ['{0}', '{0}/repository', '{0}/repository/gazebo_plugins'])
def test_file_of_an_unbuilt_package_on_the_path_comes_before_ours(tmp_path, path):
    inner = 'test/test_worlds/gazebo_ros_range.world'  # we have it, too
    folder = tmp_path / 'repository' / 'gazebo_plugins'
    (folder / inner).parent.mkdir(parents=True)
    (folder / inner).touch()
    (folder / 'package.xml').write_text(
        '<package format="2"><name>gazebo_plugins</name><version>1.0.0</version><description>x'
        '</description><maintainer email="a@b.example">a</maintainer><license>BSD</license>'
        '</package>'
    )
    (tmp_path / 'see.launch').write_text(
        f'<launch><param name="found" value="$(find gazebo_plugins)/{inner}"/></launch>'
    )
    result = rosbots(
        'exec',
        'roslaunch',
        '--dump-params',
        str(tmp_path / 'see.launch'),
        ROS_PACKAGE_PATH=path.format(tmp_path),
    )
    assert os.path.realpath(result.stdout.split()[-1]) == str(folder / inner), result.stderr


def test_interactive_shell_keeps_the_workspace_of_bashrc_before_ours(theirs, tmp_path):
    (tmp_path / '.bashrc').write_text(
        f'unset CMAKE_PREFIX_PATH PYTHONPATH; ROS_PACKAGE_PATH={theirs.parent}'
    )
    shell = (
        'bash',
        '--rcfile',
        str(ROOT / 'tools' / 'shell.bashrc'),
        '-i',
        '-c',
        'rospack find rosbots_description; rospack find gazebo_ros; echo $unset',
    )
    result = rosbots('exec', *shell, HOME=str(tmp_path))
    assert result.returncode == 0, result.stderr
    own, gazebo = result.stdout.split()
    assert own == str(theirs)
    assert os.path.realpath(gazebo) == str(ROOT / 'companions' / 'gazebo_ros')


def test_logs_have_a_folder_without_home():
    nothing = '/dev/null/home'
    result = rosbots('exec', 'sh', '-c', 'test -w "$ROS_HOME/log"', HOME=nothing, ROS_HOME='')
    assert result.returncode == 0, result.stderr


def test_file_names_and_text_are_utf8_in_every_locale():
    program = 'import sys; print(sys.getfilesystemencoding(), open(0).encoding)'
    result = rosbots('exec', 'python3', '-c', program, LC_ALL='C', PYTHONUTF8='0')
    assert result.stdout.split() == ['utf-8', 'utf-8']


@pytest.mark.parametrize(('name', 'address'), [('localhost', ''), ('leads.nowhere', 'localhost')])
def test_unresolvable_hostname_is_replaced_by_localhost(name, address):
    rename = f'hostname {name} && exec "$@"'
    renamed = (*unshare('uts'), 'sh', '-c', rename, 'sh')
    result = rosbots('exec', 'printenv', 'ROS_HOSTNAME', prefix=renamed, ROS_HOSTNAME='', ROS_IP='')
    assert result.stdout.strip() == address, result.stderr


# Mounts a full disk on each folder before --, in a private mount namespace.
FILL = """
while [ "$1" != -- ]; do
  mount -t tmpfs -o size=4k full "$1" && head -c 4k /dev/zero > "$1/x" || exit 77
  shift
done
shift
exec "$@"
"""


def on_full_disks(places, *command, **environment):
    fill = (*unshare('mount'), 'sh', '-c', FILL, 'sh', *places, '--')
    done = ran(*fill, *command, env=os.environ | environment)
    if done.returncode == 77:
        pytest.skip(f'this machine lets nobody mount a disk: {done.stderr.strip()}')
    return done


@pytest.mark.parametrize('others', [(), ('/dev/shm',)])
def test_full_temporary_folder_does_no_harm(tmp_path, others):
    result = on_full_disks(
        [tmp_path, *others],
        ROOT / 'rosbots',
        'exec',
        'sh',
        '-c',
        'rospack find gazebo_ros && echo "$TMPDIR"',
        TMPDIR=str(tmp_path),
    )
    assert result.returncode == 0, result.stderr
    found, temporary = result.stdout.splitlines()
    assert found.endswith('gazebo_ros')
    assert temporary == str(tmp_path)  # the user's setting is passed on to programs
    assert result.stderr == ''


def test_error_without_any_writable_folder_names_all_of_them(tmp_path):
    temporary, workspace = tmp_path / 'tmp', tmp_path / 'workspace'
    for place in (temporary, workspace):
        place.mkdir()
    result = on_full_disks(
        [temporary, '/dev/shm', workspace],
        'bash',
        '-euc',
        'source "$ROOT/tools/environment.bash"; source_workspace',
        ROOT=str(ROOT),
        WORKSPACE=str(workspace),
        TMPDIR=str(temporary),
    )
    assert result.returncode == 1
    assert result.stderr == (
        f'rosbots: nothing can be written in {temporary}, /dev/shm and {workspace}; '
        'make room in one of them, or set TMPDIR to a folder that has some\n'
    )
