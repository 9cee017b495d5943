"""Hostile scenarios are refused in a sentence, and cost neither hours nor gigabytes."""

import fcntl
import os
import time
import tracemalloc

import pytest

from rosbots_description.batch import Condition, ScenarioError, ScenarioFile, local_ray
from rosbots_description.batch.yaml_file import read_yaml

PROCESSOR, MEMORY = 5.0, 100e6  # [s], [bytes] any of these may cost; an attack takes much more


@pytest.fixture(autouse=True)
def costs():
    """Limit what a test may use."""
    tracemalloc.start()
    begin = time.process_time()
    yield
    assert time.process_time() - begin < PROCESSOR
    assert tracemalloc.get_traced_memory()[1] < MEMORY
    tracemalloc.stop()


@pytest.mark.parametrize(
    'text',
    [
        '9 ** 9 ** 9 > 1',
        '9 ** 999999999 > 1',
        '3999999 ** 3999999 > 1',
        '0.1 ** -9999 > 1',
        '(1 << 99999999) > 1',
        "'a' * 999999999 == 'b'",
        "'%999999999d' % 1 == 1",
        "'%s' % x == 1",
        "'a'.ljust(999999999) == 1",
        "'a'.zfill(999999999) == 1",
        "'a'.join('bc') == 1",
        "f'{1:999999999d}' == 1",
        "f'{abs}' == 1",
        '().__class__',
        'abs.__self__',
        'x.__class__',
        "'{0.__class__}'.format(x)",
        '__import__("os").system("id")',
        'open("/etc/passwd")',
        'exec("1")',
        'eval("1")',
        'globals()',
        'print(1)',
        '[one for one in range(9)]',
        '[1] * 999999999',
        '(1,) * 999999999',
        '{1: 2}[1]',
        'lambda: 1',
        'min(*[1, 2])',
        'min(x=1)',
        'abs(abs)',
        'x := 1',
        'x; x',
        'import os',
        'sqrt(-1)',
        'max("a" * 90000) * 90000 * 90000 == 1',
        '1 @ 2',
        '-' * 900 + '1',
        '(' * 400 + '1' + ')' * 400,
        '1' * 5000,
        'True and ' * 200 + 'True',
        'a\0b',
        'x.real',
        "'abc'[0]",
        '`id`',
        '$(id)',
        '~x',
        'x if x',
        'yield x',
        'await x',
    ],
)
def test_hostile_condition_is_refused(text):
    with pytest.raises(ValueError, match='condition'):
        Condition(text, ['x']).fault({'x': 1.0})


NINE = ', '.join(9 * ['*{}'])
BOMB = 'a0: &a0 [x, x, x]\n' + ''.join(
    f'a{n}: &a{n} [{NINE.format(*9 * [f"a{n - 1}"])}]\n' for n in range(1, 25)
)
DURATION = 'duration: 1.0\n'


@pytest.mark.parametrize(
    'text',
    [
        BOMB,
        DURATION + 'models: &a [*a]',
        DURATION + 'record: &a {x: *a}',
        DURATION + 'models: ' + '[' * 5000 + ']' * 5000,
        DURATION + 'record: ' + '{a: ' * 5000 + '1' + '}' * 5000,
        DURATION + 'models: ' + '[' * 60 + ']' * 60,
        DURATION + 'seed: ' + '9' * 5000,
        DURATION + 'parameters: {x: ' + '9' * 400 + '}',
        DURATION + '? [a]\n: 1',
        DURATION + '1: 2',
        'duration: 2001-01-01',
        'duration: 1.0e+300',
        'duration: 1.0e+9\nperiod: 0.01',
        'duration: 1.0e+12\nperiod: 1.0e-300',
        'duration: .inf',
        'duration: .nan',
        'duration: -1.0',
        'duration: !!python/object/apply:os.system [id]',
        '!!python/object/new:os.system [id]',
        'duration: !!python/name:os.system',
        'duration: !!binary aWQ=',
        'duration: [1.0',
        'duration: 1.0\n\tworld: x',
        'duration: \0',
        DURATION + 'parameters: {x: {uniform: [-1.0e+308, 1.0e+308]}}',
        DURATION + 'parameters: {x: {uniform: [1, 2, 3, 4, 5]}}',
        DURATION + 'parameters: {x: {bytes: [999999999]}}',
        DURATION + 'parameters: {x: {integers: [0, 1.0e+30]}}',
        DURATION + 'parameters: {x: {grid: []}}',
        DURATION + 'parameters: {__class__.x: 1}',
        DURATION + 'parameters: {x: {grid: [[1, 2]]}}',
        DURATION + 'repeat: 99999999999',
        DURATION + 'repeat: -1',
        DURATION + 'seed: true',
        DURATION + 'conditions: ["().__class__.__bases__"]\nconditions2: 1',
        DURATION + 'conditions: ["__import__"]',
        DURATION + 'world: $x',
        DURATION + 'world: ${x.__class__}',
        DURATION + 'models: [{name: a, file: b, text: c}]',
        DURATION + 'commands: [{at: 1.0e+300, topic: /t}]',
    ],
)
def test_hostile_scenario_is_refused_in_a_sentence(tmp_path, text):
    path = tmp_path / 'hostile.yaml'
    path.write_text(text)
    with pytest.raises(ScenarioError) as caught:
        ScenarioFile.read(path)
    assert str(caught.value).startswith(str(path))
    assert len(str(caught.value)) < 2000


@pytest.mark.parametrize(
    'make',
    [
        os.mkfifo,
        os.mkdir,
        lambda path: path.symlink_to('/dev/zero'),
        lambda path: path.symlink_to(path.name),
        lambda path: path.write_bytes(b'\xff\xfe\0' * 99),
        lambda path: os.truncate(path.write_text('') or path, 1 << 40),
        lambda path: None,
    ],
)
def test_what_is_no_file_of_text_is_refused(tmp_path, make):
    path = tmp_path / 'hostile.yaml'
    make(path)
    with pytest.raises(ScenarioError, match=r'hostile.yaml cannot be read: '):
        ScenarioFile.read(path)


def test_aliases_are_accepted(tmp_path):
    path = tmp_path / 'alias.yaml'
    path.write_text('a: &a [1, 2]\nb: [*a, *a]\n')
    assert read_yaml(path) == {'a': [1, 2], 'b': [[1, 2], [1, 2]]}


@pytest.fixture
def ray_place(tmp_path, monkeypatch):
    monkeypatch.setattr(local_ray, '_MAX_PLACE', 1000)
    monkeypatch.setattr(local_ray.tempfile, 'gettempdir', lambda: str(tmp_path))
    monkeypatch.setattr(local_ray.tempfile, 'tempdir', str(tmp_path))
    return tmp_path


def planted_pipe(folder, _target):
    (folder / 'rbx').mkdir()
    os.mkfifo(folder / 'rbx' / 'rosbots.lock')  # opening it would wait for a writer


def planted_link_to_a_folder(folder, target):
    (target / 'rosbots.lock').touch()
    (folder / 'rbx').symlink_to(target)


def planted_link_to_a_file(folder, target):
    (folder / 'rbx').mkdir()
    (folder / 'rbx' / 'rosbots.lock').symlink_to(target / 'kept')


def planted_foreign_folder(folder, _target):
    (folder / 'rbx').mkdir()
    (folder / 'rbx' / 'rosbots.lock').touch()
    os.chown(folder / 'rbx', 65534, 65534)


def planted_folder_in_use(folder, _target):
    (folder / 'rbx').mkdir()
    held = (folder / 'rbx' / 'rosbots.lock').open('w')
    fcntl.flock(held, fcntl.LOCK_EX)
    return held


@pytest.mark.parametrize(
    'plant',
    [
        planted_link_to_a_folder,
        planted_link_to_a_file,
        planted_foreign_folder,
        planted_folder_in_use,
        lambda folder, _target: (folder / 'rbx').touch(),
    ],
)
def test_what_another_program_planted_is_left_alone(ray_place, tmp_path_factory, plant):
    if plant is planted_foreign_folder and os.getuid():
        pytest.skip('only root gives files to other users')
    target = tmp_path_factory.mktemp('target')
    (target / 'kept').write_text('kept')
    held = plant(ray_place, target)
    with local_ray.own_folder():
        pass
    assert (target / 'kept').read_text() == 'kept'
    assert (ray_place / 'rbx').exists()
    if held:
        held.close()


def test_pipe_in_place_of_a_lock_does_not_stop_a_batch(ray_place):
    planted_pipe(ray_place, None)
    with local_ray.own_folder() as place:
        assert os.stat(place).st_mode & 0o777 == 0o700


def test_folder_of_a_killed_batch_is_removed(ray_place):
    (ray_place / 'rbx').mkdir()
    (ray_place / 'rbx' / 'rosbots.lock').touch()
    with local_ray.own_folder():
        assert not (ray_place / 'rbx').exists()
