"""Models in the crash sandbox: accepted, rejected, and no process left behind."""

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
from support import box_urdf, burn, mesh_spec, robot_spec, urdf_spec
from support.refusals import sentence_of

from rosbots_description.sim.core import Fault, process_watch, report
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
MASS = Inertial(1.0, ixx=1.0, iyy=1.0, izz=1.0)
DIVERGING = ModelSpec(
    'wide',
    (LinkSpec('near', inertial=MASS), LinkSpec('far', Pose((1e150, 0.0, 0.0)), MASS)),
    (JointSpec('joint', REVOLUTE, 'near', 'far'),),
)
SHORT = 0.2  # [s] for a model that does not finish
LONG = 50.0  # [s] never reached


class OddEngine(Engine):
    """An engine that calls functions when models other than the ground are added, and at steps."""

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
    """A sandbox with its own engine; counts the tests that it starts."""

    def __init__(self, **odds):
        self._count = mmap.mmap(-1, 8)  # shared with the children
        does = odds.pop('does', lambda: None)

        def counted():
            self._count[0] += 1
            does()

        self.engine = OddEngine(counted, **odds)
        self._sandbox = CrashSandbox(self.engine, Engine)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._sandbox.close()
        self.engine.close()

    @property
    def process(self):
        return self._sandbox._children._server.process

    @property
    def trials(self):
        return self._count[0]

    def require(self, spec=CRATE, **options):
        model = self.engine.compile(spec)
        self._sandbox.require(model, PhysicsSettings(), **options)


def allow(monkeypatch, processor):
    """Allow a test `processor` seconds of processor time, for any model."""
    monkeypatch.setattr(crash_sandbox, 'MIN_ALLOWANCE', processor)
    monkeypatch.setattr(crash_sandbox, 'PER_PART', 0.0)
    monkeypatch.setattr(crash_sandbox, 'PER_BYTE', 0.0)


def steps_of_a_test(does=lambda: None, at_step=lambda: None):
    """Return the number of steps of the engine in the test of a crate."""
    steps = mmap.mmap(-1, 1)  # shared with the child

    def count():
        steps[0] += 1
        at_step()

    with Sandbox(does=does, at_step=count) as sandbox:
        sandbox.require()
    return steps[0]


def fault_of(does, spec=CRATE):
    with Sandbox(does=does) as sandbox:
        return sentence_of(ModelError, sandbox.require, spec)


def passes(spec, does=lambda: None):
    with Sandbox(does=does) as sandbox:
        sandbox.require(spec)


@pytest.fixture(autouse=True)
def fixture_nothing_is_left(no_collection):
    before = os.listdir('/proc/self/fd')
    yield
    assert os.listdir('/proc/self/fd') == before
    with contextlib.suppress(ChildProcessError):  # no child at all
        assert os.waitpid(-1, os.WNOHANG) == (0, 0)


def test_equal_content_is_tested_once_whatever_its_name_and_visuals():
    with Sandbox() as sandbox:
        sandbox.require()
        assert sandbox.trials == 1
        (link,) = CRATE.links
        sandbox.require(
            replace(
                CRATE,
                name='other',
                location='elsewhere',
                left_out=('a plugin',),
                links=(replace(link, visuals=()),),
            )
        )
        assert sandbox.trials == 1
        heavier = replace(link, inertial=replace(link.inertial, mass=3.0))
        sandbox.require(replace(CRATE, links=(heavier,)))
        assert sandbox.trials == 2


def test_mesh_is_identified_by_the_content_of_its_file(tmp_path):
    with Sandbox() as sandbox:
        for size in (1.0, 1.0, 2.0):
            sandbox.require(mesh_spec(tmp_path / 'part.obj', size))
        assert sandbox.trials == 2


def test_oldest_accepted_contents_are_forgotten_first(monkeypatch):
    monkeypatch.setattr(crash_sandbox, 'REMEMBERED', 1)
    static = replace(CRATE, static=True)
    with Sandbox() as sandbox:
        for spec, tried in ((CRATE, 1), (static, 2), (static, 2), (CRATE, 3)):
            sandbox.require(spec)
            assert sandbox.trials == tried


def test_robot_of_the_article_is_accepted():
    passes(robot_spec())


def test_coincident_boxes_are_accepted():
    box = replace(CRATE.links[0], self_collide=True, visuals=())
    passes(ModelSpec('heap', tuple(replace(box, name=f'box{i}') for i in range(50))))


@pytest.mark.parametrize('number', [signal.SIGSEGV, signal.SIGBUS, signal.SIGABRT, signal.SIGFPE])
def test_model_that_crashes_the_engine_is_rejected(number):
    assert fault_of(lambda: os.kill(os.getpid(), number)) == (
        "model 'crate' is rejected: tested in a process of its own, it crashed the physics "
        f'engine ({number.name}); leave out parts of it to find the one that does it, meshes first'
    )


def test_model_that_hangs_the_engine_is_rejected(monkeypatch):
    allow(monkeypatch, SHORT)
    assert f'needed more than {SHORT} s of processor time for it;' in fault_of(
        lambda: burn(math.inf)
    )


def test_model_that_blocks_the_engine_is_rejected(monkeypatch):
    monkeypatch.setattr(fork_server, 'POLL_PERIOD', 0.02)
    assert 'the physics engine hung for 10 s;' in fault_of(signal.pause)


@pytest.mark.parametrize('share', ['PER_PART', 'PER_BYTE'])
def test_time_limit_grows_with_the_size_of_the_model(share, monkeypatch, tmp_path):
    spec = mesh_spec(tmp_path / 'part.obj')
    with Sandbox(does=lambda: burn(2.0 * SHORT)) as sandbox:
        allow(monkeypatch, SHORT)
        with pytest.raises(ModelError, match='of processor time'):
            sandbox.require(spec)
        monkeypatch.setattr(crash_sandbox, share, LONG)
        sandbox.require(spec)


def test_sandbox_makes_twenty_steps(monkeypatch):
    monkeypatch.setattr(crash_sandbox, 'BUDGET', math.inf)
    assert steps_of_a_test() == 20


def test_sandbox_makes_fewer_steps_with_a_slow_model():
    assert steps_of_a_test(at_step=lambda: burn(crash_sandbox.BUDGET)) == 1


def test_sandbox_makes_a_step_with_a_model_slow_to_add():
    assert steps_of_a_test(does=lambda: burn(crash_sandbox.BUDGET)) == 1


def in_the_background(stack, call):
    """Start a call on another thread, joined at the end."""
    thread = threading.Thread(target=call)
    thread.start()
    stack.callback(thread.join)
    return thread


def test_several_models_are_tested_in_parallel(tmp_path):
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
        sandbox = stack.enter_context(CrashSandbox(engine, Engine))

        def require(spec):
            sandbox.require(engine.compile(spec), PhysicsSettings())

        other = in_the_background(stack, lambda: require(lingering))
        stack.callback(wait.unlink)
        require(CRATE)
        require(CRATE)
        assert other.is_alive()


def test_request_for_content_under_test_waits_for_its_result():
    with contextlib.ExitStack() as stack:
        sandbox = stack.enter_context(Sandbox(does=lambda: time.sleep(SHORT)))
        for _ in range(3):
            in_the_background(stack, sandbox.require)
        stack.pop_all().close()
    assert sandbox.trials == 1


def test_run_without_a_waiting_client_is_cancelled(monkeypatch):
    monkeypatch.setattr(fork_server, 'POLL_PERIOD', 0.02)
    monkeypatch.setattr(process_watch, 'MAX_SLEEPING_POLLS', 10**6)
    with Sandbox(does=signal.pause) as sandbox:
        for _ in range(2):
            with pytest.raises(ModelError, match="'crate' is rejected: its client has"):
                sandbox.require(is_wanted=lambda: False)


def test_model_that_ends_the_process_is_rejected():
    assert 'it ended the process (exit code 3)' in fault_of(lambda: os._exit(3))


def test_model_that_diverges_at_once_is_rejected():
    with pytest.raises(ModelError, match='its pose or velocity was not finite'):
        passes(DIVERGING)


def test_rejected_model_is_tested_again():
    with Sandbox(does=lambda: os.kill(os.getpid(), signal.SIGSEGV)) as sandbox:
        for tried in (1, 2):
            with pytest.raises(ModelError):
                sandbox.require()
            assert sandbox.trials == tried


def test_output_and_log_of_a_test_are_discarded(capfd, caplog):
    def chatter():
        os.write(1, b'b3Warning: no inertial')
        os.write(2, b'Fatal Python error')
        report(Fault('lost'))

    passes(CRATE, chatter)
    assert capfd.readouterr() == ('', '')
    assert caplog.text == ''


def test_model_is_accepted_with_a_warning_if_no_process_can_be_made(caplog, monkeypatch):
    def none(*_arguments, **_options):
        raise OSError(errno.EAGAIN, os.strerror(errno.EAGAIN))

    monkeypatch.setattr(fork_server.os, 'posix_spawn', none)
    with Sandbox() as sandbox:
        os.kill(sandbox.process, signal.SIGKILL)
        sandbox.require()
    assert (
        "model 'crate' was not tested in the sandbox, since the operating system failed "
        '(Resource temporarily unavailable)' in caplog.text
    )


def test_killed_sandbox_is_started_again_and_still_rejects(caplog):
    with Sandbox() as sandbox:
        os.kill(sandbox.process, signal.SIGKILL)
        sandbox.require()
        with pytest.raises(ModelError, match='its pose or velocity was not finite'):
            sandbox.require(DIVERGING)
    assert caplog.messages == [
        'the process crash_sandbox has ended (killed by signal 9); it is started again'
    ]


@pytest.mark.parametrize(
    'fault',
    [
        OSError(number, os.strerror(number))
        for number in (errno.EISDIR, errno.EMFILE, errno.ENOMEM, errno.ENOSPC)
    ]
    + [MemoryError()],
)
def test_failure_of_the_operating_system_is_reported_as_such(fault):
    def fail():
        raise fault

    reason = getattr(fault, 'strerror', None) or 'Cannot allocate memory'
    assert fault_of(fail) == (
        "model 'crate' is rejected: it could not be tested before, since the operating "
        f'system failed ({reason}); fix that and spawn the model again'
    )


def test_kill_for_lack_of_memory_is_reported_as_a_failure_of_the_system():
    sentence = fault_of(lambda: os.kill(os.getpid(), signal.SIGKILL))
    assert 'the operating system failed (it killed the process (SIGKILL)' in sentence


def test_lack_of_memory_is_reported():
    def eat():
        resource.setrlimit(resource.RLIMIT_AS, (0, resource.RLIM_INFINITY))
        bytearray(1 << 28)

    assert 'the operating system failed (Cannot allocate memory)' in fault_of(eat)


@pytest.mark.parametrize('spare', [0, 1])  # for the model's description, and for reading it
def test_lack_of_file_descriptors_is_reported(spare):
    def use_up():
        taken = [os.open(os.devnull, os.O_RDONLY) for _ in range(100)]  # fills gaps too
        resource.setrlimit(resource.RLIMIT_NOFILE, (taken[-1] + 1, 1 << 12))
        for descriptor in taken[:spare]:
            os.close(descriptor)

    assert 'the operating system failed (Too many open files)' in fault_of(use_up)


def test_error_names_a_folder_in_the_place_of_a_mesh_file(tmp_path):
    with Sandbox() as sandbox:
        model = sandbox.engine.compile(mesh_spec(tmp_path / 'part.obj'))
        (file,) = model.files
        os.unlink(file)
        os.mkdir(file)
        with pytest.raises(ModelError, match=f'system failed .Is a directory: {file}'):
            sandbox._sandbox.require(model, PhysicsSettings())


def test_model_is_tested_again_after_a_failure_of_the_system(tmp_path):
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


def test_sandbox_does_not_change_the_world():
    motions = []
    for tries in (False, True):
        with closing(World()) as world, CrashSandbox(world.engine, Engine) as sandbox:
            add_empty_world(world)
            crate = world.spawn(CRATE, 'crate', Pose((0.1, 0.2, 0.7)))
            world.run(200)
            if tries:
                sandbox.require(world.compile(CRATE), world.physics)
            world.run(200)
            motions.append(world.engine.motion(crate.body))
    assert motions[0] == motions[1]


def test_models_are_tested_while_the_world_runs():
    with closing(World()) as world, CrashSandbox(world.engine, Engine) as sandbox:
        add_empty_world(world)
        world.spawn(CRATE, 'crate', Pose((0.0, 0.0, 0.7)))
        goes_on = threading.Event()
        (link,) = CRATE.links

        def try_some():
            for mass in range(1, 21):
                spec = replace(
                    CRATE, links=(replace(link, inertial=replace(link.inertial, mass=mass)),)
                )
                sandbox.require(world.compile(spec), world.physics)
            goes_on.set()

        other = threading.Thread(target=try_some)
        other.start()
        while other.is_alive():
            world.run(1)
        assert goes_on.is_set()
