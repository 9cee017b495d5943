"""What stops the set-up is said in one sentence, with the cure."""

import re
import socket
from http.server import BaseHTTPRequestHandler, HTTPServer
from xmlrpc.server import SimpleXMLRPCServer

import pytest
from support import ROOT
from support.programs import bash, in_setup
from support.serving import serving


def set_up(script, workspace):
    """Run a script with the functions of the set-up; return exit code and errors."""
    done = in_setup(f'choose_sets base; {script}', WORKSPACE=str(workspace))
    return done.returncode, done.stderr


@pytest.mark.parametrize(
    ('log', 'sentence'),
    [
        (
            'E: Could not get lock /var/lib/apt/lists/lock. It is held by process 7 (apt-get)',
            'another program is installing packages; run this again when it has ended',
        ),
        (
            'Err:1 http://mirror.example/debian bookworm InRelease\n  Temporary failure '
            "resolving 'x'",
            'a server of packages cannot be reached',
        ),
        (
            'urllib3: Failed to establish a new connection: [Errno -3] Temporary failure in name',
            'a server of packages cannot be reached',
        ),
        ("E: You don't have enough free space in /var/cache/apt/archives/.", 'the disk is full'),
        ('OSError: [Errno 28] No space left on device', 'the disk is full'),
        ("OSError: [Errno 30] Read-only file system: 'lib'", 'a folder cannot be written'),
    ],
)
def test_cause_that_a_log_names_is_the_only_message(tmp_path, log, sentence):
    (tmp_path / 'output').write_text(f'Reading …\n{log}\nE: giving up\n')
    code, errors = set_up(
        f'stop() {{ cat {tmp_path}/output; exit 100; }}; phase Title apt stop', tmp_path
    )
    assert code == 1
    assert errors.startswith(f'rosbots: Title: {sentence}')
    assert errors.endswith(f'(details: {tmp_path}/log/apt.log)\n')
    assert errors.count('\n') == 1


def test_end_of_the_log_is_shown_where_the_cause_is_not_known(tmp_path):
    code, errors = set_up('stop() { seq 100; exit 3; }; phase Title pip stop', tmp_path)
    assert code == 1
    assert f'the end of {tmp_path}/log/pip.log:\n    76\n' in errors


@pytest.mark.parametrize('debian', ['', '11', '14'])
def test_other_systems_are_told_what_they_lack_and_nothing_is_tried(tmp_path, debian):
    code, errors = set_up(
        f'DEBIAN={debian}; missing_packages() {{ printf "catkin\\ncmake\\n"; }}; '
        'system_name() { echo "Ubuntu 24.04 LTS"; }; phase() { echo tried; }; set_up_packages',
        tmp_path,
    )
    assert (code, errors) == (
        1,
        (
            'rosbots: this installs packages on Debian 12 and 13 only (or in a container of it, '
            'see '
            'Containerfile); this machine, Ubuntu 24.04 LTS, lacks catkin cmake\n'
        ),
    )


def test_other_systems_with_all_packages_are_welcome(tmp_path):
    assert set_up('DEBIAN=; missing_packages() { :; }; set_up_packages', tmp_path) == (0, '')


def test_environment_is_of_the_interpreter_that_the_packages_brought(tmp_path):
    """Else the next command would make it anew: before them, a bare machine has no Python."""
    code, errors = set_up(
        'readlink() { echo /usr/bin/python3.99; }; phase() { :; }; '
        'pybullet_wheel() { echo "$WORKSPACE"; }; set_up_python; '
        'mark_all_done python "$(python_fingerprint)"; '
        'grep --quiet --fixed-strings python3.99 "$WORKSPACE"/stamps/{venv,python.base}',
        tmp_path,
    )
    assert (code, errors) == (0, '')


def test_installation_that_apt_get_does_not_complete_is_an_error(tmp_path):
    code, errors = set_up(
        'DEBIAN=13; sudo() { :; }; phase() { :; }; amount() { :; }; '
        'missing_packages() { echo catkin; }; set_up_packages',
        tmp_path,
    )
    assert (code, errors) == (
        1,
        ('rosbots: the installation of Debian packages was interrupted; run this again\n'),
    )


def test_python_is_that_of_the_workspace_under_either_catkin():
    program = f'{(ROOT / ".ws").resolve()}/venv/bin/python'
    cache = (ROOT / '.ws' / 'build' / 'CMakeCache.txt').read_text(encoding='utf-8')
    for name in ('PYTHON_EXECUTABLE', 'Python_EXECUTABLE'):
        assert f'\n{name}:' in cache
        assert f'={program}\n' in cache.partition(f'\n{name}:')[2][:300]
    (line,) = re.findall('^    catkin_make -D.*', (ROOT / 'README.md').read_text('utf-8'), re.M)
    shown = bash(f'catkin_make() {{ echo "$@"; }}; {line}', HOME='/home/me')
    python = '/home/me/rosbots/.ws/venv/bin/python3'
    assert shown.stdout.split() == [
        f'-D{name}_EXECUTABLE={python}' for name in ('PYTHON', 'Python')
    ]


class _Deaf(BaseHTTPRequestHandler):
    """Answers as a web server that knows no POST."""

    def log_message(self, *_):
        """Print nothing."""


def require_master_port(uri, *arguments):
    script = 'source "$ROOT/tools/environment.bash"; require_master_port "$@"'
    done = bash(script, *arguments, ROS_MASTER_URI=uri)
    return done.returncode, done.stderr


def test_port_that_another_program_has_is_named():
    server = HTTPServer(('localhost', 0), _Deaf)
    port = server.server_port
    with serving(server) as address:
        for given in (
            (address, 'gazebo_ros', 'empty_world.launch'),
            ('http://localhost:1', '-p', str(port), 'a.launch'),
        ):
            code, errors = require_master_port(*given)
            assert code == 1
            assert errors == (
                f'rosbots: a program that is no ROS master has port {port}; end it, or choose '
                f'another port: export ROS_MASTER_URI=http://localhost:{port + 1}\n'
            )


def test_master_and_free_port_are_welcome():
    master = SimpleXMLRPCServer(('localhost', 0), logRequests=False)
    master.register_function(lambda caller: (1, '', 7), 'getPid')
    with serving(master) as address:
        assert require_master_port(address) == (0, '')
    with socket.socket() as free:
        free.bind(('localhost', 0))
        assert require_master_port(f'http://localhost:{free.getsockname()[1]}') == (0, '')
    assert require_master_port('http://elsewhere.invalid:11311') == (0, '')
