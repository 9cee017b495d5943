"""Mutants: one place changed, which tests find, and the tests that can notice it."""

import ast
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope='module')
def module():
    sys.path.insert(0, str(ROOT / 'benchmark'))
    import mutants

    yield mutants
    sys.path.remove(str(ROOT / 'benchmark'))


def lines(module, text):
    tree = ast.parse(text)
    return [list(module.changed_line(tree, number)) for number in module.places(tree)]


@pytest.mark.parametrize(('text', 'mutated'), [
    ('x = 0.2', 'x = 0.4'), ('x = 0', 'x = 1'), ('x = True', 'x = False'), ('x = -y', 'x = +y'),
    ('x = y - z', 'x = y + z'), ('x = y < z', 'x = y >= z'), ('x = min(y, z)', 'x = max(y, z)'),
    ('x = y and z', 'x = y or z'), ('x = y * z', 'x = y / z'),
])
def test_numbers_signs_comparisons_and_limits_are_changed(module, text, mutated):
    assert lines(module, text) == [[text, mutated]]


def test_texts_and_names_are_left_alone(module):
    assert lines(module, '"""Text."""\nx = f(y)\nz = "0.2"\nw = zip(x, y, strict=True)') == []


def test_each_mutant_changes_one_place(module):
    assert lines(module, 'a = 1.0\nb = 3.0 + a') == [
        ['a = 1.0', 'a = 2.0'], ['b = 3.0 + a', 'b = 3.0 - a'], ['b = 3.0 + a', 'b = 6.0 + a']]


def test_tests_of_the_files_own_folder_come_first(module):
    path = ROOT / module.PACKAGE / 'sim/physics/bullet/contact_stiffness.py'
    named, unit, engine, others = module.tests_of(path)
    assert named == ['test/unit/sim/physics/bullet/test_contact_stiffness.py']
    for level, own in (('unit', unit), ('engine', engine)):
        assert own
        assert all(Path(name).parts[1:-1] == (level, 'sim', 'physics', 'bullet') for name in own)
    assert 'test/engine/gym/test_parallel.py' in others


def test_every_room_has_mutants(module):
    for room in module.ROOMS:
        assert any(module.places(ast.parse(path.read_bytes())) for path in module.files([room]))


@pytest.mark.parametrize(('change', 'noticed'), [
    (lambda text: text, False), (lambda text: text.replace('0.005', '0.01'), True),
    (lambda _: 'import os\nos.abort()', True),
])
def test_a_mutant_is_noticed_by_a_test_that_fails_or_crashes_in_a_fork(module, change, noticed):
    path = ROOT / module.PACKAGE / 'sim/physics/bullet/friction_rolling.py'
    tests = [['test/unit/sim/physics/bullet/test_friction_rolling.py']]
    before = path.read_bytes()
    changed = ast.parse(change(path.read_text()))
    loaded = {name: sys.modules.pop(name) for name in list(sys.modules)
              if name.partition('.')[0] in ('rosbots_description', 'rosbots_simulator', 'test')}
    try:
        assert module.is_noticed(path, changed, tests) == noticed
    finally:
        sys.modules.update(loaded)
    assert path.read_bytes() == before
