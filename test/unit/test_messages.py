"""The demo's messages, generated without a workspace, are those that catkin generates."""

import importlib
import subprocess

import pytest
from support import ROOT
from support.programs import python


@pytest.fixture(scope='module', name='generated')
def fixture_generated(tmp_path_factory):
    """Return a folder with the modules of the messages."""
    folder = tmp_path_factory.mktemp('messages')
    subprocess.run(
        ['/usr/bin/python3', ROOT / 'tools' / 'make_messages.py', ROOT / 'companions', folder],
        check=True,
    )
    return folder


@pytest.mark.parametrize('package', ['gazebo_msgs', 'rosbots_msgs', 'control_msgs'])
def test_generated_messages_have_the_checksums_of_catkins(generated, package):
    files = [
        path
        for kind in ('msg', 'srv')
        for path in sorted((ROOT / 'companions' / package / kind).glob('*.*'))
    ]
    expected = ''
    for path in files:
        module = importlib.import_module(f'{package}.{path.parent.name}')
        expected += f'{path.stem} {getattr(module, path.stem)._md5sum}\n'
    script = (
        f'import sys; sys.path.insert(0, {str(generated)!r})\n'
        f'for kind, name in {[(path.parent.name, path.stem) for path in files]!r}:\n'
        f'    module = __import__(f"{package}.{{kind}}", fromlist=[kind])\n'
        '    assert module.__file__.startswith(sys.path[0])\n'
        '    print(name, getattr(module, name)._md5sum)\n'
    )
    shown = python(script)
    assert files
    assert shown.stdout == expected
