"""What an uploaded xacro can reach and use up: nothing."""

import os
import socket
import threading

import pytest
from support.patience import wait_until

from rosbots_description.ros_api.window import xacro_sandbox
from rosbots_description.ros_api.window.library import RosLibrary
from rosbots_description.sim.core import SimError
from rosbots_description.sim.resources import MAX_XML_BYTES

HEAD = '<robot name="a" xmlns:xacro="http://www.ros.org/wiki/xacro">'
SECRET = 'open-sesame'
# From any value to any function of Python, without a name that xacro hides.
SYSTEM = (
    "[c for c in ().__class__.__bases__[0].__subclasses__() if c.__name__ == '_wrap_close']"
    '[0].__init__.__globals__'
)


def escape(command):
    """Return an expression of xacro that runs a command."""
    return f"${{{SYSTEM}['popen']('{command}').read()}}"


@pytest.fixture(autouse=True)
def secret(tmp_path, monkeypatch):
    """A file of the user, and a variable of the user's environment."""
    path = tmp_path / 'secret.yaml'
    path.write_text(f'key: {SECRET}\n')
    (tmp_path / 'secret.xacro').write_text(f'{HEAD}<link name="{SECRET}"/></robot>')
    monkeypatch.setenv('A_SECRET', SECRET)
    return path


def told(inner, head=HEAD):
    """Return what a file with this inside expands to, or what is said of it."""
    try:
        return RosLibrary().file('a.xacro', f'{head}{inner}</robot>'.encode()).xml
    except SimError as error:
        assert '\n' not in str(error)
        return str(error)


@pytest.mark.parametrize(
    'inner',
    [
        "<link name=\"${load_yaml('PATH')['key']}\"/>",
        "<link name=\"${xacro.load_yaml('PATH')['key']}\"/>",
        '<link name="${load_yaml(\'FOLDER/../FOLDER/secret.yaml\')}"/>',
        '<link name="${load_yaml(\'/proc/self/environ\')}"/>',
        '<link name="${load_yaml(\'/proc/1/environ\')}"/>',
        '<link name="${load_yaml(\'/proc/self/root/PATH\')}"/>',
        '<link name="${load_yaml(\'/upload/../../../..PATH\')}"/>',
        '<xacro:include filename="FOLDER/secret.xacro"/>',
        '<xacro:include filename="FOLDER/*.xacro"/>',
        '<xacro:include filename="/proc/self/root/FOLDER/secret.xacro"/>',
        '<xacro:include filename="../../../../FOLDER/secret.xacro"/>',
        '<xacro:include filename="$(find xacro)/../../../../../../../../FOLDER/secret.xacro"/>',
        '<link name="$(env A_SECRET)"/>',
        '<link name="$(optenv A_SECRET none)"/>',
        '<xacro:arg name="x" default="$(env A_SECRET)"/><link name="$(arg x)"/>',
        '<link name="$(eval env(\'A_SECRET\'))"/>',
        f'<link name="{escape("cat PATH")}"/>',
        f'<link name="{escape("env; set; cat /proc/*/environ")}"/>',
        f'<link name="{escape("cat /proc/*/root/PATH; find / -name secret.yaml")}"/>',
        f'<link name="${{str({SYSTEM}[\'environ\'])}}"/>',
        f"<link name=\"${{{SYSTEM}['open']('PATH', 0)}}\"/>",
    ],
)
def test_files_and_environment_of_the_user_are_not_read(secret, inner):
    inner = inner.replace('FOLDER', str(secret.parent)).replace('PATH', str(secret))
    assert SECRET not in told(inner)


def test_other_folders_of_modules_are_not_read(secret, monkeypatch):
    monkeypatch.syspath_prepend(secret.parent)
    assert SECRET not in told(f'<xacro:include filename="{secret.parent}/secret.xacro"/>')
    assert SECRET not in told(f'<link name="{escape(f"cat {secret}")}"/>')


@pytest.mark.parametrize(
    'command',
    [
        'touch FOLDER/made',
        'echo made > FOLDER/made',
        'touch /upload/made && ls /upload',
        'touch /tmp/made && echo it was',
        'touch /usr/made /made /dev/made && echo it was',
        'rm -r FOLDER',
        'mkdir -p FOLDER/made',
        'mount -t tmpfs none /usr && echo it was made',
        'kill -9 PID',
        'kill -9 -1',
        'dd if=/dev/zero of=/dev/shm/made count=1 && echo it was made',
    ],
)
def test_nothing_is_written_and_nobody_else_is_killed(secret, command):
    command = command.replace('FOLDER', str(secret.parent)).replace('PID', str(os.getpid()))
    said = told(f'<link name="{escape(command.replace("&", "&amp;"))}"/>')
    assert 'made' not in said
    assert sorted(one.name for one in secret.parent.iterdir()) == ['secret.xacro', 'secret.yaml']


def test_there_is_no_network_not_even_this_machine():
    with socket.create_server(('127.0.0.1', 0)) as server:
        server.settimeout(0.2)
        port = server.getsockname()[1]
        told(f'<link name="{escape(f"echo x > /dev/tcp/127.0.0.1/{port}")}"/>')
        told(
            '<link name="${' + SYSTEM + "['popen']('python3 -c \\'import socket; "
            f'socket.create_connection((\\"127.0.0.1\\", {port}))' + "\\'').read()}\"/>"
        )
        with pytest.raises(TimeoutError):
            server.accept()


def test_the_sandbox_does_run_what_it_holds():
    """So that the attempts above do not fail for another reason."""
    assert 'name="here\n"' in told(f'<link name="{escape("echo here")}"/>').replace('&#10;', '\n')


@pytest.mark.parametrize(
    'inner',
    [
        '<link name="${[0]*10**12}"/>',
        '<link name="${\'x\'*10**10}"/>',
        f'<link name="${{\'x\'*{2 * MAX_XML_BYTES}}}"/>',
        f'<link name="{escape("yes")}"/>',
        '<xacro:macro name="m"><xacro:m/></xacro:macro><xacro:m/>',
        '<xacro:property name="a" value="${a}"/><link name="${a}"/>',
        '<xacro:include filename="upload.xacro"/>',
    ],
)
def test_what_takes_too_much_is_rejected_in_a_sentence(inner):
    assert told(inner).startswith("'a.xacro': xacro rejects it: ")


@pytest.mark.parametrize(
    'inner', ['<link name="${7**10**9}"/>', f'<link name="{escape("sleep 1000")}"/>']
)
def test_what_takes_too_long_is_ended(monkeypatch, inner):
    monkeypatch.setattr(xacro_sandbox, 'PATIENCE', 3.0)
    assert told(inner).endswith('it takes too much time, memory or output')


def test_what_it_leaves_behind_is_ended_with_it(monkeypatch):
    monkeypatch.setattr(xacro_sandbox, 'PATIENCE', 3.0)
    before = threading.active_count()
    told(f'<link name="{escape("sleep 987 &amp; setsid sleep 987 &amp; echo x")}"/>')
    wait_until(lambda: not any('987' in one for one in command_lines()), 'its end')
    assert threading.active_count() == before


def command_lines():
    for process in os.listdir('/proc'):
        if process.isdigit():
            try:
                with open(f'/proc/{process}/cmdline', encoding='utf-8') as file:
                    parts = file.read().split('\0')
            except OSError:
                continue
            if parts[0] == 'sleep':
                yield from parts[1:]


def test_files_of_packages_can_be_included():
    said = told('<xacro:include filename="$(find rosbots_description)/urdf/rosbots.xacro"/>')
    assert '<link name="base_link"' in said


@pytest.mark.parametrize(
    ('program', 'reason'),
    [
        ('', 'there is no program bwrap (Debian package bubblewrap)'),
        (
            '#!/bin/sh\necho "bwrap: no namespaces here" >&2\nexit 1\n',
            'bwrap does not work here (bwrap: no namespaces here)',
        ),
    ],
)
def test_without_a_sandbox_a_sentence_says_why(tmp_path, monkeypatch, program, reason):
    xacro_sandbox._unusable.cache_clear()
    monkeypatch.setattr(
        xacro_sandbox.shutil,
        'which',
        lambda name: None if name == 'bwrap' and not program else f'/usr/bin/{name}',
    )
    folder = tmp_path / 'bin'
    folder.mkdir()
    (folder / 'bwrap').write_text(program)
    (folder / 'bwrap').chmod(0o755)
    monkeypatch.setenv('PATH', f'{folder}:{os.environ["PATH"]}')
    try:
        said = told('<link name="a"/>')
    finally:
        xacro_sandbox._unusable.cache_clear()
    assert said == (
        "'a.xacro': xacro files can run code, so they are expanded in a sandbox only, "
        f'and {reason}; expand it with rosrun xacro xacro, and upload the URDF'
    )
