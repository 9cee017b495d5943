"""./rosbots passes exit codes on and says in one sentence what it does not know."""

import subprocess

import pytest
from support import ROOT


def rosbots(*arguments, script=''):
    return subprocess.run(
        [ROOT / 'rosbots', *arguments],
        input=script,
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
