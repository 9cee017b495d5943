"""Hostile input in a child process: refused in one sentence, or simulated with finite numbers."""

import logging
import math
import os
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any

import yaml

from rosbots_description.batch import ScenarioError, ScenarioFile
from rosbots_description.batch.simulation import simulate
from rosbots_description.sim import SimError, World

from .invariants import check_sentence, numbers_in
from .isolation import Child, limit_memory

STEPS = 50
MEMORY = 512 * 2**20  # [bytes] of address space that a document may need
REFUSED, SIMULATED = 'refused', 'simulated'
SHORT = STEPS * 0.001  # [s]


class Trials:
    """Reads documents, each in a world of its own; lives in a child.

    Each method returns `REFUSED` or `SIMULATED`. It raises whatever is no exception of ours, also
    one that a world has logged, and an AssertionError for a number that is not finite.
    """

    def __init__(self, prepare: Callable[[], None] = lambda: None) -> None:
        self._logged: list[logging.LogRecord] = []
        handler = logging.Handler()
        handler.emit = self._logged.append  # type: ignore[method-assign]
        logging.getLogger().handlers = [handler]
        self._folder = tempfile.TemporaryDirectory()
        prepare()
        limit_memory(MEMORY)

    def model(self, text: str, arguments: dict[str, str] | None = None) -> str:
        """Spawn a model above the ground."""
        with World.empty() as world:
            return self._tried(lambda: world.spawn(text, 'it', z=1.0, arguments=arguments), world)

    def world(self, text: str) -> str:
        """Open a world file."""
        path = self._write('it.world', text)
        worlds: list[World] = []
        try:
            return self._tried(lambda: worlds.append(World.from_file(path)), worlds)
        finally:
            for world in worlds:
                world.close()

    def mesh(self, suffix: str, content: bytes | str) -> str:
        """Spawn a model whose shape is a mesh file."""
        path = self._write(f'mesh{suffix}', content)
        shape = f'<geometry><mesh filename="file://{path}"/></geometry>'
        with World.empty() as world:
            spawn = (
                f'<robot name="it"><link name="a"><inertial><mass value="1"/><inertia ixx="1" '
                'iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial><visual>'
                f'{shape}</visual><collision>{shape}</collision></link></robot>'
            )
            verdict = self._tried(lambda: world.spawn(spawn, z=1.0), world)
            return REFUSED if world.model('it').spec.left_out else verdict

    def scenario(self, document: Any) -> str:
        """Read a scenario, and make the first of its runs, but a short one."""
        path = self._write('it.yaml', yaml.safe_dump(document, allow_unicode=True))
        try:
            file = ScenarioFile.read(path)
            file = ScenarioFile({**document, 'duration': SHORT}, self._folder.name)
        except ScenarioError as error:
            check_sentence(error)
            return REFUSED
        row = simulate(file, 0)
        assert all(map(math.isfinite, numbers_in(row))), row
        error, _, _ = row['reason'].partition(': ')
        assert not error.endswith('Error'), row['reason']
        self._check_log()
        return REFUSED if row['outcome'] == 'error' else SIMULATED

    def _tried(self, act: Callable[[], Any], world: World | list[World]) -> str:
        try:
            act()
        except SimError as error:
            check_sentence(error)
            return REFUSED
        for one in world if isinstance(world, list) else [world]:
            one.run(STEPS)
            assert all(map(math.isfinite, numbers_in(list(_states(one)))))
        self._check_log()
        return SIMULATED

    def _check_log(self) -> None:
        """Check that the log has sentences and no traceback."""
        logged, self._logged[:] = self._logged[:], []
        for record in logged:
            assert record.exc_info is None, record.exc_text or record.exc_info
            check_sentence(Exception(record.getMessage()))

    def _write(self, name: str, content: bytes | str) -> str:
        path = os.path.join(self._folder.name, name)
        with open(path, 'wb') as file:
            file.write(
                content if isinstance(content, bytes) else content.encode('utf-8', 'surrogatepass')
            )
        return path


def _states(world: World) -> Iterator[Any]:
    for model in world.models.values():
        yield model.state()
        for part in (*model.links.values(), *model.joints.values()):
            yield part.state()


class Fuzzer:
    """Runs trials in a child that is replaced when one has failed; counts their verdicts."""

    def __init__(self, prepare: Callable[[], None] = lambda: None) -> None:
        self._make = lambda: Trials(prepare)
        self._child = Child(self._make)
        self.verdicts: Counter[str] = Counter()

    def __enter__(self) -> 'Fuzzer':
        return self

    def __exit__(self, *exception: object) -> None:
        self._child.__exit__(*exception)

    def judge(self, kind: str, *arguments: Any) -> None:
        """Make a trial; the name is that of a method of `Trials`."""
        try:
            self.verdicts[self._child.call(kind, *arguments)] += 1
        except AssertionError:
            self._child.__exit__()
            self._child = Child(self._make)
            raise

    def require_both(self) -> None:
        """Assert that documents were refused and that others were simulated."""
        assert set(self.verdicts) == {REFUSED, SIMULATED}, self.verdicts
