"""Mutants: one place changed or one statement left out, and the tests that can notice it."""

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


@pytest.fixture(scope='module')
def mutation(module):
    import mutation

    return mutation


def lines(mutation, text):
    tree = ast.parse(text)
    return [list(mutation.changed_line(tree, number)) for number in mutation.places(tree)]


@pytest.mark.parametrize(
    ('text', 'mutated'),
    [
        ('x = 0.2', 'x = 0.4'),
        ('x = 0', 'x = 1'),
        ('x = True', 'x = False'),
        ('x = -y', 'x = +y'),
        ('x = y - z', 'x = y + z'),
        ('x = y < z', 'x = y >= z'),
        ('x = min(y, z)', 'x = max(y, z)'),
        ('x = y and z', 'x = y or z'),
        ('x = y * z', 'x = y / z'),
    ],
)
def test_numbers_signs_comparisons_and_limits_are_changed(mutation, text, mutated):
    assert lines(mutation, text) == [[text, mutated]]


def test_texts_and_names_and_what_only_asserts_are_left_alone(mutation):
    assert (
        lines(
            mutation,
            '"""Text."""\nx = f(y)\nz = "0.2"\nw = zip(x, y, strict=True)\n'
            '@dataclass(frozen=True)\nclass C:\n    pass',
        )
        == []
    )


def test_statements_are_left_out_but_for_docstrings_imports_and_declarations(mutation):
    tree = ast.parse(
        '"""Text."""\nimport a\nif b:\n    c.d()\n    e: int\nelse:\n    f = 1\n'
        'def g():\n    """Text."""\n    return 1'
    )
    assert [mutation.changed_line(tree, number) for number in mutation.statements(tree)] == [
        ('c.d()', 'pass'),
        ('f = 1', 'pass'),
        ('return 1', 'pass'),
    ]


def test_each_mutant_changes_one_place(mutation):
    assert lines(mutation, 'a = 1.0\nb = 3.0 + a') == [
        ['a = 1.0', 'a = 2.0'],
        ['b = 3.0 + a', 'b = 3.0 - a'],
        ['b = 3.0 + a', 'b = 6.0 + a'],
    ]


def test_tests_of_the_files_own_folder_come_first(module):
    path = ROOT / module.PACKAGE / 'sim/physics/bullet/contact_stiffness.py'
    named, unit, engine, others = module.tests_of(path)
    assert named == ['test/unit/sim/physics/bullet/test_contact_stiffness.py']
    for level, own in (('unit', unit), ('engine', engine)):
        assert own
        assert all(Path(name).parts[1:-1] == (level, 'sim', 'physics', 'bullet') for name in own)
    assert 'test/engine/gym/test_parallel.py' in others


def test_every_room_has_mutants(module, mutation):
    for room in module.ROOMS:
        assert any(mutation.places(ast.parse(path.read_bytes())) for path in module.files([room]))


FRICTION_ROLLING = 'sim/physics/bullet/friction_rolling.py'
ITS_TEST = 'test/unit/sim/physics/bullet/test_friction_rolling.py'


@pytest.fixture
def notice(module, monkeypatch):
    """Return how a test notices that a file of the product is changed."""
    monkeypatch.chdir(ROOT)
    loaded = {
        name: sys.modules.pop(name)
        for name in list(sys.modules)
        if name.partition('.')[0] in ('rosbots_description', 'rosbots_simulator', 'test')
    }
    path = ROOT / module.PACKAGE / FRICTION_ROLLING
    before = path.read_bytes()
    yield lambda change, tests, name=ITS_TEST: tests.notice(
        path, ast.parse(change(before.decode())), [name]
    )
    assert path.read_bytes() == before
    sys.modules.update(loaded)


@pytest.mark.parametrize(
    ('change', 'verdict'),
    [
        (lambda text: text, ''),
        (lambda text: text.replace('0.005', '0.01'), f'failed {ITS_TEST}::'),
        (lambda _: 'import os\nos.abort()', 'crashed'),
        (lambda _: 'import os, signal\nos.kill(os.getpid(), signal.SIGXCPU)', 'hung'),
    ],
)
def test_a_mutant_is_noticed_by_a_test_that_fails_crashes_or_hangs(module, notice, change, verdict):
    tests = module.Tests()
    assert notice(change, tests).startswith(verdict)
    assert bool(verdict) == bool(notice(change, tests))


def test_a_test_that_fails_without_a_change_notices_nothing(module, notice, tmp_path):
    broken = tmp_path / 'test_broken.py'
    broken.write_text('def test_it():\n    assert False\n')
    tests = module.Tests()
    assert notice(lambda text: text.replace('0.005', '0.01'), tests, str(broken)) == ''
    assert len(tests.broken) == 1
