"""The engine protocol: engines implement all of it, and the simulator uses nothing else."""

import ast
import inspect

import pytest
from support import LIBRARY
from support.fake_engine import FakeEngine

from rosbots_description.sim.physics.bullet.engine import Engine
from rosbots_description.sim.physics.engine import PhysicsEngine

METHODS = [name for name in vars(PhysicsEngine) if not name.startswith('_')]


def parameters(function):
    return [
        (one.name, one.kind, one.default) for one in inspect.signature(function).parameters.values()
    ]


@pytest.mark.parametrize('engine', [Engine, FakeEngine])
@pytest.mark.parametrize('name', METHODS)
def test_engine_implements_the_protocol(engine, name):
    wanted, found = getattr(PhysicsEngine, name), inspect.getattr_static(engine, name)
    if isinstance(wanted, property):
        assert not callable(found)
    else:
        assert parameters(found) == parameters(wanted)


def test_engine_has_no_public_method_outside_the_protocol():
    offered = {name for name in dir(Engine) if not name.startswith('_')}
    assert offered <= set(METHODS)


def test_simulator_uses_only_the_protocol():
    requested = {
        node.attr
        for room in ('runtime', 'plugins')
        for path in (LIBRARY / 'sim' / room).rglob('*.py')
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.Attribute)
        and isinstance(node.value, ast.Name | ast.Attribute)
        and getattr(node.value, 'attr', getattr(node.value, 'id', '')) == 'engine'
    }
    assert 'step' in requested
    assert requested <= set(METHODS)
