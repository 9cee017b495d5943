"""Models in the crash sandbox: who passes, who does not, and that nothing is left."""

import contextlib
import errno
import math
import mmap
import os
import resource
import signal
import threading
import time
from contextlib import closing
from dataclasses import replace

import pytest
from support import box_urdf, robot_spec, urdf_spec

from rosbots_description.sim.core.errors import ModelError
from rosbots_description.sim.core.transforms import Pose
from rosbots_description.sim.description.model_spec import (
    REVOLUTE,
    Inertial,
    JointSpec,
    LinkSpec,
    ModelSpec,
)
from rosbots_description.sim.description.physics_settings import PhysicsSettings
from rosbots_description.sim.physics import crash_sandbox, fork_server
from rosbots_description.sim.physics.bullet.engine import Engine
from rosbots_description.sim.physics.crash_sandbox import CrashSandbox
from rosbots_description.sim.runtime.empty_world import add_empty_world
from rosbots_description.sim.runtime.world import World

CRATE = urdf_spec(box_urdf('1 1 1', 2.0), 'crate')
SHORT = 0.3  # [s] for a model that is never done with
LONG = 50.0  # [s] never reached


class OddEngine(Engine):
    """An engine that does things when models but the ground come, and step."""

    def __init__(self, does=lambda: None, at_step=lambda: None):
        super().__init__(PhysicsSettings())
        self._does, self._at_step = does, at_step

    def add(self, model, pose):
        if model.spec.links[0].name != 'link':
            self._does()
        return super().add(model, pose)

    def step(self, steps):
        for _ in range(steps):
            self._at_step()
            super().step(1)


class Sandbox:
    """A sandbox with an engine of its own; counts the trials it begins."""

    def __init__(self, **odds):
        self._count = mmap.mmap(-1, 8)  # shared with the children
        does = odds.pop('does', lambda: None)

        def counted():
            self._count[0] += 1
            does()

        self.engine = OddEngine(counted, **odds)
        self._sandbox = CrashSandbox(self.engine)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._sandbox.close()
        self.engine.close()

    @property
    def trials(self):
        return self._count[0]

    def require(self, spec=CRATE, **options):
        model = self.engine.compile(spec)
        self._sandbox.require(model, PhysicsSettings(), **options)


def burn(seconds):
    """Use up so much of this process's time on the processor."""
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass


def allow(monkeypatch, processor):
    """Let a trial take so much processor time [s], whatever it is of."""
    monkeypatch.setattr(crash_sandbox, 'MIN_ALLOWANCE', processor)
    monkeypatch.setattr(crash_sandbox, 'PER_PART', 0.0)
    monkeypatch.setattr(crash_sandbox, 'PER_BYTE', 0.0)


def steps_of_a_trial(does=lambda: None, at_step=lambda: None):
    """Return how many steps the engine makes with a crate."""
    steps = mmap.mmap(-1, 1)  # shared with the child

    def count():
        steps[0] += 1
        at_step()

    with Sandbox(does=does, at_step=count) as sandbox:
        sandbox.require()
    return steps[0]


def fault_of(does, spec=CRATE):
    with Sandbox(does=does) as sandbox, pytest.raises(ModelError) as caught:
        sandbox.require(spec)
    return str(caught.value)


def passes(spec, does=lambda: None):
    with Sandbox(does=does) as sandbox:
        sandbox.require(spec)


@pytest.fixture(autouse=True)
def fixture_nothing_is_left():
    before = os.listdir('/proc/self/fd')
    yield
    assert os.listdir('/proc/self/fd') == before
    with contextlib.suppress(ChildProcessError):  # there is none at all
        assert os.waitpid(-1, os.WNOHANG) == (0, 0)


def test_a_content_is_tried_once_whatever_it_is_called_and_looks_like():
    with Sandbox() as sandbox:
        sandbox.require()
        assert sandbox.trials == 1
        (link,) = CRATE.links
        sandbox.require(replace(CRATE, name='other', location='elsewhere',
                                links=(replace(link, visuals=()),)))
        assert sandbox.trials == 1
        heavier = replace(link, inertial=replace(link.inertial, mass=3.0))
        sandbox.require(replace(CRATE, links=(heavier,)))
        assert sandbox.trials == 2


def mesh_spec(source):
    return urdf_spec(box_urdf('1 1 1', 2.0).replace(
        '<box size="1 1 1"/>', f'<mesh filename="file://{source}"/>'))


def test_a_mesh_is_known_by_what_its_file_holds(tmp_path):
    source = tmp_path / 'part.stl'
    with Sandbox() as sandbox:
        for height in (1.0, 1.0, 2.0):
            source.write_text(tetrahedron(height))
            sandbox.require(mesh_spec(source))
        assert sandbox.trials == 2


def tetrahedron(height):
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, height)]
    faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
    loops = (''.join(f'vertex {x} {y} {z}\n' for x, y, z in map(corners.__getitem__, face))
             for face in faces)
    return 'solid t\n' + ''.join(
        f'facet normal 0 0 0\nouter loop\n{loop}endloop\nendfacet\n' for loop in loops
    ) + 'endsolid t\n'


def test_the_contents_that_passed_first_are_forgotten_first(monkeypatch):
    monkeypatch.setattr(crash_sandbox, 'REMEMBERED', 1)
    static = replace(CRATE, static=True)
    with Sandbox() as sandbox:
        for spec, tried in ((CRATE, 1), (static, 2), (static, 2), (CRATE, 3)):
            sandbox.require(spec)
            assert sandbox.trials == tried


def test_the_robot_of_the_article_passes():
    passes(robot_spec())


def test_a_heap_of_boxes_in_one_place_passes():
    box = replace(CRATE.links[0], self_collide=True, visuals=())
    passes(ModelSpec('heap', tuple(replace(box, name=f'box{i}') for i in range(50))))


@pytest.mark.parametrize('number', [signal.SIGSEGV, signal.SIGBUS, signal.SIGABRT, signal.SIGFPE])
def test_a_model_that_crashes_the_engine_is_refused(number):
    assert fault_of(lambda: os.kill(os.getpid(), number)) == (
        "model 'crate' is rejected: tested in a process of its own, it crashed the physics "
        f'engine ({number.name}); leave out parts of it to find the one that does it, meshes first')


def test_a_model_that_is_never_done_with_is_refused(monkeypatch):
    allow(monkeypatch, SHORT)
    assert f'needed more than {SHORT} s of processor time for it;' in fault_of(
        lambda: burn(math.inf))


def test_a_model_that_sleeps_for_ever_is_refused(monkeypatch):
    monkeypatch.setattr(fork_server, 'POLL_PERIOD', 0.02)
    assert 'the physics engine hung for 10 s;' in fault_of(signal.pause)


@pytest.mark.parametrize('share', ['PER_PART', 'PER_BYTE'])
def test_a_model_may_take_the_longer_the_more_it_holds(share, monkeypatch, tmp_path):
    source = tmp_path / 'part.stl'
    source.write_text(tetrahedron(1.0))
    with Sandbox(does=lambda: burn(2.0 * SHORT)) as sandbox:
        allow(monkeypatch, SHORT)
        with pytest.raises(ModelError, match='of processor time'):
            sandbox.require(mesh_spec(source))
        monkeypatch.setattr(crash_sandbox, share, LONG)
        sandbox.require(mesh_spec(source))


def test_a_model_makes_twenty_steps(monkeypatch):
    monkeypatch.setattr(crash_sandbox, 'BUDGET', math.inf)
    assert steps_of_a_trial() == 20


def test_a_model_that_is_slow_to_step_makes_fewer():
    assert steps_of_a_trial(at_step=lambda: burn(crash_sandbox.BUDGET)) == 1


def test_a_model_that_is_slow_to_bring_in_makes_a_step_all_the_same():
    assert steps_of_a_trial(does=lambda: burn(crash_sandbox.BUDGET)) == 1


def in_the_background(stack, call):
    """Begin a call on another thread, which is awaited at the end."""
    thread = threading.Thread(target=call)
    thread.start()
    stack.callback(thread.join)
    return thread


def test_a_model_does_not_wait_for_the_trial_of_another(tmp_path):
    wait = tmp_path / 'wait'
    wait.touch()
    (link,) = CRATE.links
    lingering = replace(CRATE, links=(replace(link, name='lingering'),))

    class Lingering(OddEngine):
        def add(self, model, pose):
            while model.spec.links[0].name == 'lingering' and wait.exists():
                time.sleep(0.01)
            return super().add(model, pose)

    with contextlib.ExitStack() as stack:
        engine = stack.enter_context(closing(Lingering()))
        sandbox = stack.enter_context(CrashSandbox(engine))

        def require(spec):
            sandbox.require(engine.compile(spec), PhysicsSettings())

        other = in_the_background(stack, lambda: require(lingering))
        stack.callback(wait.unlink)
        require(CRATE)
        require(CRATE)
        assert other.is_alive()


def test_who_asks_for_what_is_being_tried_waits_for_that():
    with contextlib.ExitStack() as stack:
        sandbox = stack.enter_context(Sandbox(does=lambda: time.sleep(SHORT)))
        for _ in range(3):
            in_the_background(stack, sandbox.require)
        stack.pop_all().close()
    assert sandbox.trials == 1


def test_a_trial_that_nobody_waits_for_is_given_up(monkeypatch):
    monkeypatch.setattr(fork_server, 'POLL_PERIOD', 0.02)
    monkeypatch.setattr(fork_server, 'MAX_SLEEPING_POLLS', 10**6)
    with Sandbox(does=signal.pause) as sandbox:
        for _ in range(2):
            with pytest.raises(ModelError, match="'crate' is rejected: its client has"):
                sandbox.require(is_wanted=lambda: False)


def test_a_model_that_ends_the_process_is_refused():
    assert 'it ended the process (exit code 3)' in fault_of(lambda: os._exit(3))


def test_a_model_that_is_lost_at_once_is_refused():
    heavy = Inertial(1.0, ixx=1.0, iyy=1.0, izz=1.0)
    links = (LinkSpec('near', inertial=heavy), LinkSpec('far', Pose((1e150, 0.0, 0.0)), heavy))
    spec = ModelSpec('wide', links, (JointSpec('joint', REVOLUTE, 'near', 'far'),))
    with pytest.raises(ModelError, match='its pose or velocity was not finite'):
        passes(spec)


def test_a_model_that_failed_is_tried_again():
    with Sandbox(does=lambda: os.kill(os.getpid(), signal.SIGSEGV)) as sandbox:
        for tried in (1, 2):
            with pytest.raises(ModelError):
                sandbox.require()
            assert sandbox.trials == tried


def test_nothing_of_a_trial_is_seen(capfd, caplog):
    def chatter():
        os.write(1, b'b3Warning: no inertial')
        os.write(2, b'Fatal Python error')
        crash_sandbox.logger.error('lost')

    passes(CRATE, chatter)
    assert capfd.readouterr() == ('', '')
    assert caplog.text == ''


def test_where_no_process_can_be_made_a_model_passes_with_a_warning(caplog):
    with Sandbox() as sandbox:
        os.kill(sandbox._sandbox._children._server, signal.SIGKILL)
        sandbox.require()
    assert "model 'crate' was not tested in the sandbox, since the operating system failed " \
        '(the fork server does not answer)' in caplog.text


@pytest.mark.parametrize('fault', [
    OSError(number, os.strerror(number))
    for number in (errno.EISDIR, errno.EMFILE, errno.ENOMEM, errno.ENOSPC)
] + [MemoryError()])
def test_a_failure_of_the_system_is_blamed_on_nobody_else(fault):
    def fail():
        raise fault

    reason = getattr(fault, 'strerror', None) or 'Cannot allocate memory'
    assert fault_of(fail) == (
        "model 'crate' is rejected: it could not be tested before, since the operating "
        f'system failed ({reason}); fix that and spawn the model again')


def test_a_trial_that_the_system_kills_for_want_of_memory_is_blamed_on_nobody_else():
    sentence = fault_of(lambda: os.kill(os.getpid(), signal.SIGKILL))
    assert 'the operating system failed (it killed the process (SIGKILL)' in sentence


def test_a_process_out_of_memory_says_so():
    def eat():
        resource.setrlimit(resource.RLIMIT_AS, (0, resource.RLIM_INFINITY))
        bytearray(1 << 28)

    assert 'the operating system failed (Cannot allocate memory)' in fault_of(eat)


@pytest.mark.parametrize('spare', [0, 1])  # to describe the model, and to read what describes it
def test_a_process_without_file_handles_says_so(spare):
    def use_up():
        taken = [os.open(os.devnull, os.O_RDONLY) for _ in range(100)]  # gaps are filled, too
        resource.setrlimit(resource.RLIMIT_NOFILE, (taken[-1] + 1, 1 << 12))
        for descriptor in taken[:spare]:
            os.close(descriptor)

    assert 'the operating system failed (Too many open files)' in fault_of(use_up)


def test_a_folder_where_the_file_of_a_mesh_was_is_named(tmp_path):
    source = tmp_path / 'part.stl'
    source.write_text(tetrahedron(1.0))
    with Sandbox() as sandbox:
        model = sandbox.engine.compile(mesh_spec(source))
        (file,) = model.files
        os.unlink(file)
        os.mkdir(file)
        with pytest.raises(ModelError, match=f'system failed .Is a directory: {file}'):
            sandbox._sandbox.require(model, PhysicsSettings())


def test_a_model_whose_trial_the_system_disturbed_is_tried_again(tmp_path):
    disturbed = tmp_path / 'disturbed'
    disturbed.touch()

    def fail():
        if disturbed.exists():
            raise OSError(errno.EMFILE, os.strerror(errno.EMFILE))

    with Sandbox(does=fail) as sandbox:
        with pytest.raises(ModelError):
            sandbox.require()
        disturbed.unlink()
        sandbox.require()


def test_a_trial_leaves_the_world_as_it_is():
    motions = []
    for tries in (False, True):
        with closing(World()) as world, CrashSandbox(world.engine) as sandbox:
            add_empty_world(world)
            crate = world.spawn(CRATE, 'crate', Pose((0.1, 0.2, 0.7)))
            world.run(200)
            if tries:
                sandbox.require(world.compile(CRATE), world.physics)
            world.run(200)
            motions.append(world.engine.motion(crate.body))
    assert motions[0] == motions[1]


def test_models_are_tried_while_the_world_goes_on():
    with closing(World()) as world, CrashSandbox(world.engine) as sandbox:
        add_empty_world(world)
        world.spawn(CRATE, 'crate', Pose((0.0, 0.0, 0.7)))
        goes_on = threading.Event()
        (link,) = CRATE.links

        def try_some():
            for mass in range(1, 21):
                spec = replace(CRATE, links=(
                    replace(link, inertial=replace(link.inertial, mass=mass)),))
                sandbox.require(world.compile(spec), world.physics)
            goes_on.set()

        other = threading.Thread(target=try_some)
        other.start()
        while other.is_alive():
            world.run(1)
        assert goes_on.is_set()
