"""Trials of models in child processes: who passes, who does not, and that nothing is left."""

import contextlib
import errno
import math
import mmap
import os
import resource
import signal
import socket
import threading
import time
from dataclasses import replace
from functools import partial

import pytest
from support import box_urdf, empty_world, robot_spec, urdf_spec

from rosbots_description.sim.core.errors import ModelError
from rosbots_description.sim.core.transforms import IDENTITY, Pose
from rosbots_description.sim.description.built_in import GROUND_PLANE
from rosbots_description.sim.description.model_spec import (
    REVOLUTE,
    Box,
    Collision,
    Inertial,
    JointSpec,
    LinkSpec,
    ModelSpec,
    Surface,
)
from rosbots_description.sim.description.physics_settings import PhysicsSettings
from rosbots_description.sim.meshes.store import MeshStore
from rosbots_description.sim.physics.bullet import crash_sandbox, occluded_shapes
from rosbots_description.sim.physics.bullet.crash_sandbox import Trials
from rosbots_description.sim.physics.bullet.engine import Engine
from rosbots_description.sim.physics.bullet.generated_urdf import mesh_needs

CRATE = urdf_spec(box_urdf('1 1 1', 2.0), 'crate')
SHORT = 0.3  # [s] for a model that is never done with
LONG = 50.0  # [s] never reached


def engine_that(does=lambda: None, at_step=lambda: None):
    """Return what opens an engine that does things when models but the ground come, and step."""

    class Odd(Engine):
        def add(self, spec, pose):
            if spec is not GROUND_PLANE:
                does()
            return super().add(spec, pose)

        def step(self, steps):
            for _ in range(steps):
                at_step()
                super().step(1)

    return partial(Odd, PhysicsSettings())


def burn(seconds):
    """Use up so much of this process's time on the processor."""
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass


def allow(monkeypatch, processor, wall):
    """Let a trial take so much time [s], whatever it is of."""
    monkeypatch.setattr(crash_sandbox, 'LEAST', processor)
    monkeypatch.setattr(crash_sandbox, 'FOR_A_PART', 0.0)
    monkeypatch.setattr(crash_sandbox, 'FOR_A_BYTE', 0.0)
    monkeypatch.setattr(crash_sandbox, 'PATIENCE', wall / processor)


def steps_of_a_trial(at_start=lambda: None, at_step=lambda: None):
    """Return how many steps the engine makes with a crate."""
    steps = mmap.mmap(-1, 1)  # shared with the child

    def count():
        steps[0] += 1
        at_step()

    require(Trials(engine_that(at_start, count)))
    return steps[0]


def require(trials, spec=CRATE, files=None):
    trials.require(spec, files or {})


def fault_of(does):
    with pytest.raises(ModelError) as caught:
        require(Trials(engine_that(does)))
    return str(caught.value)


@pytest.fixture(name='forks')
def fixture_forks(monkeypatch):
    """A list that grows with each process made."""
    made, fork = [], os.fork

    def counted():
        child = fork()
        if child:
            made.append(child)
        return child

    monkeypatch.setattr(crash_sandbox.os, 'fork', counted)
    return made


@pytest.fixture(autouse=True)
def fixture_nothing_is_left():
    before = os.listdir('/proc/self/fd')
    yield
    assert os.listdir('/proc/self/fd') == before
    with contextlib.suppress(ChildProcessError):  # there is none at all
        assert os.waitpid(-1, os.WNOHANG) == (0, 0)


def test_a_content_is_tried_once_whatever_it_is_called_and_looks_like(forks):
    trials = Trials(engine_that())
    require(trials)
    assert len(forks) == 1
    (link,) = CRATE.links
    require(trials, replace(CRATE, name='other', links=(replace(link, visuals=()),)))
    assert len(forks) == 1
    heavier = replace(link, inertial=replace(link.inertial, mass=3.0))
    require(trials, replace(CRATE, links=(heavier,)))
    assert len(forks) == 2


def test_a_mesh_is_known_by_what_its_file_holds(forks, tmp_path):
    trials, meshes = Trials(engine_that()), MeshStore()
    source = tmp_path / 'part.stl'
    try:
        for height in (1.0, 1.0, 2.0):
            source.write_text(tetrahedron(height))
            spec = urdf_spec(box_urdf('1 1 1', 2.0).replace(
                '<box size="1 1 1"/>', f'<mesh filename="file://{source}"/>'))
            mesh = spec.links[0].collisions[0].geometry
            file = meshes.collision_hull(mesh.path, mesh.scale)
            require(trials, spec, {(mesh, False): file})
    finally:
        meshes.close()
    assert len(forks) == 2


def tetrahedron(height):
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, height)]
    faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)]
    loops = (''.join(f'vertex {x} {y} {z}\n' for x, y, z in map(corners.__getitem__, face))
             for face in faces)
    return 'solid t\n' + ''.join(
        f'facet normal 0 0 0\nouter loop\n{loop}endloop\nendfacet\n' for loop in loops
    ) + 'endsolid t\n'


def test_the_contents_that_passed_first_are_forgotten_first(forks, monkeypatch):
    monkeypatch.setattr(crash_sandbox, 'REMEMBERED', 1)
    trials = Trials(engine_that())
    static = replace(CRATE, static=True)
    for spec, tried in ((CRATE, 1), (static, 2), (static, 2), (CRATE, 3)):
        require(trials, spec)
        assert len(forks) == tried


def test_the_robot_of_the_article_passes():
    spec, meshes = robot_spec(), MeshStore()
    try:
        files = {(collision.geometry, False): meshes.collision_hull(collision.geometry.path)
                 for link in spec.links for collision in link.collisions
                 if hasattr(collision.geometry, 'path')}
        require(Trials(engine_that()), spec, files)
    finally:
        meshes.close()


@pytest.mark.parametrize('number', [signal.SIGSEGV, signal.SIGBUS, signal.SIGABRT, signal.SIGFPE])
def test_a_model_that_crashes_the_engine_is_refused(number):
    assert fault_of(lambda: os.kill(os.getpid(), number)) == (
        "model 'crate' is not brought in: tried in a process of its own, it crashed the physics "
        f'engine ({number.name}); leave out parts of it to find the one that does it, meshes first')


def test_a_model_that_is_never_done_with_is_refused(monkeypatch):
    allow(monkeypatch, SHORT, LONG)
    assert f'was not done with it after {SHORT} s of processor time;' in fault_of(
        lambda: burn(math.inf))


def test_a_model_that_sleeps_for_ever_is_refused(monkeypatch):
    allow(monkeypatch, LONG, SHORT)
    assert f'was not done with it after {SHORT} s;' in fault_of(signal.pause)


def test_a_model_that_has_to_wait_for_the_processor_passes(monkeypatch):
    allow(monkeypatch, 0.5, LONG)
    require(Trials(engine_that(lambda: time.sleep(0.6))))


@pytest.mark.parametrize('share', ['FOR_A_PART', 'FOR_A_BYTE'])
def test_a_model_may_take_the_longer_the_more_it_holds(share, monkeypatch, tmp_path):
    source = tmp_path / 'part.stl'
    source.write_text(tetrahedron(1.0))
    spec = urdf_spec(box_urdf('1 1 1', 2.0).replace(
        '<box size="1 1 1"/>', f'<mesh filename="file://{source}"/>'))
    files = {(spec.links[0].collisions[0].geometry, False): str(source)}
    trials = Trials(engine_that(lambda: burn(SHORT)))
    allow(monkeypatch, SHORT, LONG)
    with pytest.raises(ModelError, match='of processor time'):
        require(trials, spec, files)
    monkeypatch.setattr(crash_sandbox, share, LONG)
    require(trials, spec, files)


def test_a_model_makes_twenty_steps(monkeypatch):
    monkeypatch.setattr(crash_sandbox, 'BUDGET', math.inf)
    assert steps_of_a_trial() == 20


def test_a_model_that_is_slow_to_step_makes_fewer():
    assert steps_of_a_trial(at_step=lambda: burn(crash_sandbox.BUDGET)) == 1


def test_a_model_that_is_slow_to_bring_in_makes_a_step_all_the_same():
    assert steps_of_a_trial(at_start=lambda: burn(crash_sandbox.BUDGET)) == 1


def test_a_model_that_passed_does_not_wait_for_the_trial_of_another(tmp_path, forks):
    wait = tmp_path / 'wait'

    def linger():
        while wait.exists():
            time.sleep(0.01)

    trials = Trials(engine_that(linger))
    require(trials)
    wait.touch()
    other = threading.Thread(target=require, args=[trials, replace(CRATE, static=True)])
    other.start()
    while len(forks) < 2:
        time.sleep(0.01)
    require(trials)
    assert other.is_alive()
    wait.unlink()
    other.join()


def test_a_model_that_ends_the_process_is_refused():
    assert 'it ended the process (exit code 3)' in fault_of(lambda: os._exit(3))


def test_a_model_that_the_engine_cannot_be_asked_about_is_refused():
    # Each surface of its own becomes a link to PyBullet, which loads more than it can tell about.
    shapes = tuple(Collision(f'c{i}', Box((0.1, 0.1, 0.1)), surface=Surface(mu=i / 200))
                   for i in range(200))
    link = LinkSpec('link', inertial=Inertial(1.0, ixx=1.0, iyy=1.0, izz=1.0), collisions=shapes)
    with pytest.raises(ModelError, match='the physics engine failed: error.*getBase'):
        require(Trials(engine_that()), ModelSpec('rough', (link,)))


def test_a_model_that_is_lost_at_once_is_refused():
    heavy = Inertial(1.0, ixx=1.0, iyy=1.0, izz=1.0)
    links = (LinkSpec('near', inertial=heavy), LinkSpec('far', Pose((1e150, 0.0, 0.0)), heavy))
    spec = ModelSpec('wide', links, (JointSpec('joint', REVOLUTE, 'near', 'far'),))
    with pytest.raises(ModelError, match='its pose or velocity was no finite number'):
        require(Trials(engine_that()), spec)


def test_a_model_that_failed_is_tried_again(forks):
    trials = Trials(engine_that(lambda: os.kill(os.getpid(), signal.SIGSEGV)))
    for tried in (1, 2):
        with pytest.raises(ModelError):
            require(trials)
        assert len(forks) == tried


def test_nothing_of_a_trial_is_seen(capfd, caplog):
    def chatter():
        os.write(1, b'b3Warning: no inertial')
        os.write(2, b'Fatal Python error')
        crash_sandbox.logger.error('lost')

    require(Trials(engine_that(chatter)))
    assert capfd.readouterr() == ('', '')
    assert caplog.text == ''


def test_ctrl_c_reaches_the_parent_only():
    def interrupt():
        for number in (signal.SIGINT, signal.SIGTERM):
            os.kill(os.getpid(), number)

    require(Trials(engine_that(interrupt)))


def test_connections_are_not_held_open_by_a_trial():
    with contextlib.ExitStack() as stack:
        ends = [stack.enter_context(end) for end in socket.socketpair()]

        def look():
            for end in ends:
                with pytest.raises(OSError, match='Bad file descriptor'):
                    os.fstat(end.fileno())

        require(Trials(engine_that(look)))


def test_where_no_process_can_be_made_a_model_passes_with_a_warning(monkeypatch, caplog):
    def full():
        raise OSError(errno.EAGAIN, os.strerror(errno.EAGAIN))

    monkeypatch.setattr(crash_sandbox.os, 'fork', full)
    require(Trials(engine_that()))
    assert "model 'crate' comes in without being tested, since the operating system failed " \
        '(Resource temporarily unavailable)' in caplog.text


@pytest.mark.parametrize('fault', [
    OSError(number, os.strerror(number))
    for number in (errno.EISDIR, errno.EMFILE, errno.ENOMEM, errno.ENOSPC)
] + [MemoryError()])
def test_a_failure_of_the_system_is_blamed_on_nobody_else(fault):
    def fail():
        raise fault

    reason = getattr(fault, 'strerror', None) or 'Cannot allocate memory'
    assert fault_of(fail) == (
        "model 'crate' is not brought in: it could not be tested before, since the operating "
        f'system failed ({reason}); mend that and spawn the model again')


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
    with pytest.raises(ModelError, match=f'system failed .Is a directory: {tmp_path}'):
        require(Trials(engine_that()), files={('mesh', False): str(tmp_path)})


def test_a_model_whose_trial_the_system_disturbed_is_tried_again(tmp_path):
    disturbed = tmp_path / 'disturbed'
    disturbed.touch()

    def fail():
        if disturbed.exists():
            raise OSError(errno.EMFILE, os.strerror(errno.EMFILE))

    trials = Trials(engine_that(fail))
    with pytest.raises(ModelError):
        require(trials)
    disturbed.unlink()
    require(trials)


def test_a_long_complaint_comes_through_as_far_as_there_is_room():
    def complain():
        raise ModelError('x' * 2 * crash_sandbox._ROOM)

    assert 'xxx' in fault_of(complain)


def test_an_engine_that_was_emptied_moves_things_as_a_new_one_does():
    def fall(engine):
        engine.add(GROUND_PLANE, IDENTITY)
        crate = engine.add(CRATE, Pose((0.1, 0.2, 0.7)))
        engine.step(400)
        return engine.motion(crate)

    engines = [engine_that()(None, None) for _ in range(2)]
    try:
        first, second = engines
        expected = fall(first)
        second.add(replace(CRATE, static=True), Pose((0.0, 0.0, 0.5)))  # in the way, if it stayed
        second.step(7)
        assert fall(second.emptied(None, None)) == expected
    finally:
        for engine in engines:
            engine.close()


def test_a_trial_leaves_the_world_as_it_is():
    motions = []
    for tries in (False, True):
        with empty_world() as world:
            crate = world.spawn(CRATE, 'crate', Pose((0.1, 0.2, 0.7)))
            world.run(200)
            if tries:
                require(Trials(world.engine.emptied))
            world.run(200)
            motions.append(world.engine.motion(crate.body))
    assert motions[0] == motions[1]


def test_models_are_tried_while_the_world_goes_on():
    with empty_world() as world:
        world.spawn(CRATE, 'crate', Pose((0.0, 0.0, 0.7)))
        trials, goes_on = Trials(world.engine.emptied), threading.Event()
        (link,) = CRATE.links

        def try_some():
            for mass in range(1, 21):
                require(trials, replace(CRATE, links=(
                    replace(link, inertial=replace(link.inertial, mass=mass)),)))
            goes_on.set()

        other = threading.Thread(target=try_some)
        other.start()
        while other.is_alive():
            world.run(1)
        assert goes_on.is_set()


def test_what_takes_long_to_find_out_is_found_out_before_the_trial():
    occluded_shapes._inner.cache_clear()
    with empty_world() as world:
        spec = robot_spec()
        files = {(mesh, exact): world.meshes.collision_hull(mesh.path, mesh.scale)
                 for mesh, exact in mesh_needs(spec)}
        require(Trials(world.engine.emptied), spec, files)
        known = occluded_shapes._inner.cache_info().currsize
        world.spawn(spec, 'robot', Pose((0.0, 0.0, 0.5)))
        assert occluded_shapes._inner.cache_info().currsize == known > 0


def test_what_cannot_be_found_out_before_is_left_to_the_trial(monkeypatch):
    def fails(*_):
        raise ValueError

    monkeypatch.setattr(crash_sandbox, 'grouped', fails)
    require(Trials(engine_that()))
    monkeypatch.setattr('rosbots_description.sim.physics.bullet.body_maker.grouped', fails)
    with pytest.raises(ModelError, match='the physics engine failed: ValueError'):
        require(Trials(engine_that()), replace(CRATE, static=True))
