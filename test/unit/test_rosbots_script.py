"""./rosbots passes exit codes on and says in one sentence what it does not know."""

import os
import subprocess

import pytest
from support import ROOT
from support.surroundings import unshare


def rosbots(*arguments, script='', prefix=(), **environment):
    return subprocess.run(
        [*prefix, ROOT / 'rosbots', *arguments],
        input=script,
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


@pytest.mark.parametrize(
    ('arguments', 'code', 'said'),
    [
        (['help'], 0, ''),
        ([], 0, ''),
        (['fly'], 2, "there is no command 'fly'"),
        (['exec'], 2, 'exec needs a command'),
        (['exec', 'true'], 0, ''),
        (['exec', 'sh', '-c', 'exit 7'], 7, ''),
        (['exec', 'no_such_program'], 127, "no program 'no_such_program'"),
    ],
)
def test_exit_codes_and_complaints(arguments, code, said):
    result = rosbots(*arguments)
    assert result.returncode == code
    assert said in result.stderr


def test_the_environment_knows_the_packages_and_the_right_python():
    result = rosbots(
        'exec', 'sh', '-c', 'rospack find gazebo_msgs && python3 -c "import rospy, pybullet"'
    )
    assert result.returncode == 0, result.stderr
    assert 'gazebo_msgs' in result.stdout


def test_a_shell_reads_commands_and_knows_roscd():
    result = rosbots('shell', script='roscd rosbots_description\npwd -P\nexit 3\n')
    assert result.returncode == 3, result.stderr
    assert result.stdout.strip() == str(ROOT)


def test_logs_have_a_folder_without_a_home():
    nothing = '/dev/null/home'
    result = rosbots('exec', 'sh', '-c', 'test -w "$ROS_HOME/log"', HOME=nothing, ROS_HOME='')
    assert result.returncode == 0, result.stderr


def test_names_and_files_are_utf8_in_every_locale():
    program = 'import sys; print(sys.getfilesystemencoding(), open(0).encoding)'
    result = rosbots('exec', 'python3', '-c', program, LC_ALL='C', PYTHONUTF8='0')
    assert result.stdout.split() == ['utf-8', 'utf-8']


@pytest.mark.parametrize(('name', 'address'), [('localhost', ''), ('leads.nowhere', 'localhost')])
def test_a_machine_whose_name_leads_nowhere_is_called_localhost(name, address):
    rename = f'hostname {name} && exec "$@"'
    renamed = (*unshare('uts'), 'sh', '-c', rename, 'sh')
    result = rosbots('exec', 'printenv', 'ROS_HOSTNAME', prefix=renamed, ROS_HOSTNAME='', ROS_IP='')
    assert result.stdout.strip() == address, result.stderr


# Mounts a full disk on each of the folders given before --, in a private view of the file system.
FILL = """
while [ "$1" != -- ]; do
  mount -t tmpfs -o size=4k full "$1" && head -c 4k /dev/zero > "$1/x" || exit 77
  shift
done
shift
exec "$@"
"""


def on_full_disks(places, *command, **environment):
    done = subprocess.run(
        [*unshare('mount'), 'sh', '-c', FILL, 'sh', *places, '--', *command],
        env=os.environ | environment, capture_output=True, text=True, timeout=60, check=False)
    if done.returncode == 77:
        pytest.skip(f'this machine lets nobody mount a disk: {done.stderr.strip()}')
    return done


@pytest.mark.parametrize('others', [(), ('/dev/shm',)])
def test_a_full_folder_for_temporary_files_costs_nothing(tmp_path, others):
    result = on_full_disks([tmp_path, *others], ROOT / 'rosbots', 'exec', 'sh', '-c',
                           'rospack find gazebo_ros && echo "$TMPDIR"', TMPDIR=str(tmp_path))
    assert result.returncode == 0, result.stderr
    found, temporary = result.stdout.splitlines()
    assert found.endswith('gazebo_ros')
    assert temporary == str(tmp_path)  # programs go where their user wants them to
    assert result.stderr == ''


def test_where_nothing_can_be_written_a_sentence_names_the_places(tmp_path):
    temporary, workspace = tmp_path / 'tmp', tmp_path / 'workspace'
    for place in (temporary, workspace):
        place.mkdir()
    result = on_full_disks(
        [temporary, '/dev/shm', workspace], 'bash', '-euc',
        'source "$ROOT/tools/environment.bash"; enter_environment',
        ROOT=str(ROOT), WORKSPACE=str(workspace), TMPDIR=str(temporary))
    assert result.returncode == 1
    assert result.stderr == (
        f'rosbots: nothing can be written in {temporary}, /dev/shm and {workspace}; '
        'make room in one of them, or set TMPDIR to a folder that has some\n')
