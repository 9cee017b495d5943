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


@pytest.mark.parametrize(
    ('text', 'place'),
    [
        ('A = 2', (0, {'A'})),
        ('A, B = 2, C', (0, {'A', 'B'})),
        ('class C:\n    a: int = 2', (0, {'C', 'a'})),
        ('def f(a=2):\n    pass', (1, {'f'})),
        ('class C:\n    @cache\n    def f(self):\n        return lambda: 2', (2, {'f'})),
        ('def f():\n    def g():\n        return 2', (2, {'g'})),
    ],
)
def test_a_place_is_in_its_innermost_function_or_else_in_what_it_defines(mutation, text, place):
    tree = ast.parse(text)
    (number,) = mutation.places(tree)
    assert mutation.place_of(tree, number) == place


FRICTION_ROLLING = 'sim/physics/bullet/friction_rolling.py'
ITS_TEST = 'test/unit/sim/physics/bullet/test_friction_rolling.py'
OTHER_TEST = 'test/unit/sim/physics/bullet/test_friction_axes.py'


@pytest.fixture
def fresh_imports(monkeypatch):
    """Let forks import the product anew, as those of the benchmark do."""
    monkeypatch.chdir(ROOT)
    loaded = {
        name: sys.modules.pop(name)
        for name in list(sys.modules)
        if name.partition('.')[0] in ('rosbots_description', 'rosbots_simulator', 'test')
    }
    yield
    sys.modules.update(loaded)


@pytest.fixture
def recorded(module, fresh_imports):
    return module.record([ITS_TEST, OTHER_TEST])


def files_of(names):
    return {name.partition('::')[0] for name in names}


def test_tests_that_call_its_function_can_notice_a_mutant(module, mutation, recorded):
    tests = module.Tests(*recorded)
    path = module.PACKAGE / FRICTION_ROLLING
    tree = ast.parse(path.read_bytes())
    in_function, constant = (
        next(
            module.Mutant(path, tree, number)
            for number in mutation.places(tree)
            if mutation.place_of(tree, number)[1] == {name}
        )
        for name in ('rolling_arm', '_ROLLING_RESISTANCE')
    )
    own, others = tests.of(in_function)
    assert len(own) == 3
    assert files_of(own) == {ITS_TEST}
    assert others == []
    assert tests.of(constant) == (own, [])


def test_calls_of_shared_fixtures_count_for_their_users_and_of_imports_for_nobody(
    module, fresh_imports, tmp_path, monkeypatch
):
    monkeypatch.setattr('forked_tests.ROOT', tmp_path.resolve())
    monkeypatch.chdir(tmp_path)
    Path('src').mkdir()
    Path('src', 'test_it.py').write_text(
        'import pytest\n\n'
        'def imported(): return 1\n'
        'def shared(): return 1\n'
        'ONE = imported()\n'
        "@pytest.fixture(scope='module')\n"
        'def fixture(): return shared()\n'
        'def test_first(fixture): pass\n'
        'def test_second(fixture): pass\n'
        'def test_other(): import sys; sys.settrace(None); assert 0\n'
        'def test_third(fixture): called()\n'
        'def called(): return 1\n'
    )
    records, imported = module.record(['src/test_it.py'])
    named = {name.rpartition('::')[2]: record for name, record in records.items()}
    path = str((tmp_path / 'src' / 'test_it.py').resolve())
    assert [name for name, one in named.items() if (path, 4) in one.calls] == [
        'test_first',
        'test_second',
        'test_third',
    ]
    assert [name for name, one in named.items() if (path, 12) in one.calls] == ['test_third']
    assert (path, 3) in imported
    assert [name for name, one in named.items() if one.failed] == ['test_other']
    assert module.Tests(records, imported).broken == {
        name for name in records if name.endswith('test_other')
    }


def test_every_room_has_mutants(module, mutation):
    for room in module.ROOMS:
        assert any(mutation.places(ast.parse(path.read_bytes())) for path in module.files([room]))


@pytest.fixture
def notice(module, fresh_imports):
    """Return how a test notices that a file of the product is changed."""
    path = module.PACKAGE / FRICTION_ROLLING
    before = path.read_bytes()
    yield lambda change, tests, name: tests.notice_change(
        path, ast.parse(change(before.decode())), [name]
    )
    assert path.read_bytes() == before


NAME = f'{ITS_TEST}::test_only_parts_of_cylinders_alone_have_it_and_the_widest_counts'


@pytest.mark.parametrize(
    ('change', 'verdict'),
    [
        (lambda text: text, ''),
        (lambda text: text.replace('0.005', '0.01'), f'failed {NAME}'),
        (lambda _: 'import os\nos.abort()', 'crashed'),
        (lambda _: 'import pytest\npytest.exit(returncode=4)', 'crashed'),
        (lambda text: text.replace('return _', 'import os; os.abort(); _'), f'crashed {NAME}'),
        (lambda _: 'import os, signal\nos.kill(os.getpid(), signal.SIGXCPU)', 'hung'),
    ],
)
def test_a_mutant_is_noticed_by_a_test_that_fails_crashes_or_hangs(module, notice, change, verdict):
    assert notice(change, module.Tests({}, frozenset()), NAME) == verdict


def test_a_test_that_fails_without_a_change_notices_nothing(module, notice, tmp_path, monkeypatch):
    monkeypatch.setattr('forked_tests.ROOT', tmp_path)
    monkeypatch.chdir(tmp_path)
    Path('test_broken.py').write_text('def test_it():\n    assert False\n')
    tests = module.Tests({}, frozenset())
    name = 'test_broken.py::test_it'
    assert notice(lambda text: text.replace('0.005', '0.01'), tests, name) == ''
    assert tests.broken == {name}
