"""The layers: who may import what, and that the simulator needs no ROS."""

import ast
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

SOURCE = Path(__file__).resolve().parents[2] / 'src'
PACKAGE = SOURCE / 'rosbots_description'
MESSAGES = re.compile(r'\w+_(msgs|srvs)')


def files(folder='.'):
    found = sorted((PACKAGE / folder).rglob('*.py'))
    assert found
    return {path.relative_to(PACKAGE).as_posix(): ast.parse(path.read_text()) for path in found}


def imported(tree):
    """The packages that a module imports from outside, at its top or later."""
    names = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names |= {alias.name.split('.')[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            names.add(node.module.split('.')[0])
    return names


def imported_layers(tree):
    """The parts of our package that a module names: cli, ros_api, sim."""
    words = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import | ast.ImportFrom):
            names = [getattr(node, 'module', None) or '', *(alias.name for alias in node.names)]
            words |= {word for name in names for word in name.split('.')}
    return words & {'cli', 'ros_api', 'sim'}


def test_pybullet_is_imported_in_one_place():
    assert [path for path, tree in files().items() if 'pybullet' in imported(tree)] == [
        'sim/physics/bullet/client.py']


def test_only_what_makes_moves_and_draws_bodies_uses_pybullet():
    using = [path for path, tree in files().items()
             if any(isinstance(node, ast.Name) and node.id == 'pybullet'
                    or isinstance(node, ast.alias) and node.name == 'pybullet'
                    for node in ast.walk(tree))]
    assert using == [
        'sim/physics/bullet/body_maker.py', 'sim/physics/bullet/client.py', 'sim/rendering/canvas.py', 'sim/physics/bullet/engine.py',
        'sim/physics/bullet/fast_rotation.py', 'sim/physics/bullet/contact_slip.py', 'sim/physics/bullet/collision_filter.py',
    ]


def test_only_ros_api_imports_rospy():
    using = [path for path, tree in files().items() if 'rospy' in imported(tree)]
    assert using
    assert all(path.startswith('ros_api/') for path in using)


def test_the_simulator_imports_no_messages():
    found = {(path, name) for path, tree in files('sim').items()
             for name in imported(tree) if MESSAGES.fullmatch(name)}
    assert not found


def test_no_module_imports_this_library_by_a_name():
    using = [path for path, tree in files().items()
             if imported(tree) & {'rosbots_description', 'rosbots_simulator'}]
    assert using == []  # a user's own package may have the one, and the other is only a link


@pytest.mark.parametrize('layer, above', [('sim', {'ros_api', 'cli'}), ('ros_api', {'cli'})])
def test_no_layer_imports_one_above_it(layer, above):
    assert not {path for path, tree in files(layer).items() if imported_layers(tree) & above}


def test_the_simulator_needs_no_ros():
    modules = [f'rosbots_description.{path[:-3].replace("/", ".")}' for path in files('sim')]
    program = ("import importlib, sys; sys.modules['rospy'] = None\n"
               'for name in sys.argv[1:]: importlib.import_module(name)\n'
               "print(*(name for name in sys.modules if name.endswith(('_msgs', '_srvs'))))")
    ended = subprocess.run(
        [sys.executable, '-c', program, *modules], capture_output=True, text=True, timeout=60,
        env={**os.environ, 'PYTHONPATH': os.pathsep.join([str(SOURCE), *sys.path])}, check=False)
    assert (ended.returncode, ended.stdout.strip(), ended.stderr) == (0, '', '')
