"""Malicious input ends soon, with one error message or a model, and opens no other file.

The cases and their outcomes are those of test/data/hostile/cases.yaml; here parsers and compiler
get them.
"""

import logging
import os
import sys
from contextlib import closing
from unittest.mock import Mock

import pytest
from support import ROOT, package_directory
from support.hostile import FOLDER, cases

from rosbots_description.sim.core.errors import ModelError
from rosbots_description.sim.formats.sdf.sdf import load_sdf
from rosbots_description.sim.formats.sdf.world_file import open_world
from rosbots_description.sim.formats.urdf.urdf import load_urdf
from rosbots_description.sim.meshes.engine_files import EngineFiles
from rosbots_description.sim.meshes.loader import check_mesh
from rosbots_description.sim.physics.bullet.compiler import compile_model
from rosbots_description.sim.resources import scratch
from rosbots_description.sim.resources.search_path import ModelSearch

BUILT_IN = ROOT / 'src' / 'rosbots_description' / 'models'

MAX_LENGTH = 2500  # characters of a sentence
CASES = cases()


class Opened:
    """Records the files that this process opens, by an audit hook."""

    def __init__(self):
        self.paths = []
        self.listening = False
        sys.addaudithook(self._on_event)  # audit hooks cannot be removed

    def _on_event(self, event, arguments):
        if self.listening and event == 'open' and isinstance(arguments[0], str | bytes):
            self.paths.append(os.fsdecode(arguments[0]))
        if self.listening and event.startswith(
            ('socket.connect', 'subprocess.', 'os.system', 'os.exec', 'os.posix_spawn')
        ):
            self.paths.append(event)


@pytest.fixture(scope='module')
def opened():
    for path in (ROOT / 'meshes').glob('*.dae'):
        check_mesh(str(path))  # imports its readers before the tests
    return Opened()


def read(case, folder):
    text = case.text(folder)
    if case.kind == 'world':
        path = folder / case.name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return open_world(path, find_model=ModelSearch([folder]), find_package=package_directory)
    if case.kind == 'sdf':
        spec, _ = load_sdf(
            text, 'hostile', find_model=ModelSearch([folder]), find_package=package_directory
        )
    else:
        spec, _ = load_urdf(text, 'hostile', find_package=package_directory)
    with closing(EngineFiles()) as meshes:
        return compile_model(spec, meshes)


def may_be_opened(path, case, folder):
    # a lazy import, of a codec for example
    return (
        path == case.opens
        or path.startswith((str(folder), str(FOLDER), str(BUILT_IN)))
        or path.endswith('.pyc')
    )


@pytest.mark.parametrize('case', CASES, ids=lambda case: case.name)
def test_outcome_is_that_of_the_table(case, tmp_path, opened, caplog, capfd, monkeypatch):
    monkeypatch.setattr('tempfile.tempdir', str(tmp_path))
    # the only process that reading may start: it removes the folder of files for the engine
    monkeypatch.setattr(scratch, '_removal_at_death', Mock())
    rejection = ''
    opened.paths.clear()
    opened.listening = True
    try:
        read(case, tmp_path)
    except ModelError as error:
        rejection = str(error)
    finally:
        opened.listening = False
    expected = case.parser or case.says
    assert (expected in rejection) if expected else not rejection, rejection
    logged = [(r.levelno, r.getMessage()) for r in caplog.records]
    for level, words in ((logging.WARNING, case.warns), (logging.ERROR, case.logs)):
        assert not words or any(level == at and words in text for at, text in logged), logged
    for sentence in (rejection, *(text for _, text in logged)):
        assert len(sentence) < MAX_LENGTH
        assert '\n' not in sentence
        assert not case.hides or case.hides not in sentence
    assert [path for path in opened.paths if not may_be_opened(path, case, tmp_path)] == []
    assert capfd.readouterr() == ('', '')


def test_every_file_of_the_corpus_is_small_and_in_the_table_once():
    listed = [case.name for case in CASES]
    assert len(set(listed)) == len(listed)
    files = {path.name for path in FOLDER.iterdir()} - {'cases.yaml', 'triangle.obj'}
    assert files <= set(listed)
    assert max(path.stat().st_size for path in FOLDER.iterdir()) < 20_000


@pytest.mark.parametrize('ending', ['urdf', 'sdf', 'dae', 'stl', 'obj', 'world'])
def test_each_kind_has_cases(ending):
    assert any(case.kind == ending for case in CASES)


def test_material_library_outside_of_the_folder_is_not_opened(opened):
    opened.paths.clear()
    opened.listening = True
    check_mesh.__globals__['_ends'].cache_clear()
    check_mesh.__globals__['_read'].cache_clear()
    check_mesh(str(FOLDER / 'library_out_of_folder.obj'))
    opened.listening = False
    assert len(opened.paths) == 1
    assert opened.paths[0].endswith('library_out_of_folder.obj')
