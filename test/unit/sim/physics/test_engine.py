"""The protocol of engines: each of them has all of it, and the simulator asks for no more."""

import ast
import inspect

import pytest
from support import LIBRARY
from support.fake_engine import FakeEngine

from rosbots_description.sim.physics.bullet.engine import Engine
from rosbots_description.sim.physics.engine import PhysicsEngine

METHODS = [name for name in vars(PhysicsEngine) if not name.startswith('_')]


def parameters(function):
    return [(one.name, one.kind, one.default)
            for one in inspect.signature(function).parameters.values()]


@pytest.mark.parametrize('engine', [Engine, FakeEngine])
@pytest.mark.parametrize('name', METHODS)
def test_an_engine_has_what_the_protocol_says(engine, name):
    wanted, found = getattr(PhysicsEngine, name), inspect.getattr_static(engine, name)
    if isinstance(wanted, property):
        assert not callable(found)
    else:
        assert parameters(found) == parameters(wanted)


def test_an_engine_offers_nothing_that_the_protocol_does_not_name():
    offered = {name for name in dir(Engine) if not name.startswith('_')}
    assert offered <= set(METHODS)


def test_the_simulator_asks_an_engine_for_nothing_else():
    asked = {
        node.attr
        for room in ('runtime', 'plugins')
        for path in (LIBRARY / 'sim' / room).rglob('*.py')
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.Attribute)
        and isinstance(node.value, ast.Name | ast.Attribute)
        and getattr(node.value, 'attr', getattr(node.value, 'id', '')) == 'engine'
    }
    assert 'step' in asked
    assert asked <= set(METHODS)
