"""scripts/learn_by_cma.py from its command line to its files, with a few episodes."""

import json
import runpy
import sys

import numpy as np
import pytest
from support import ROOT

SCRIPTS = ROOT / 'scripts'


@pytest.fixture
def learn(monkeypatch, tmp_path):
    """Return the program with few episodes, as a function of its policy's name and processes."""
    monkeypatch.syspath_prepend(str(SCRIPTS))
    import learn_by_cma

    for name, few in (('POPULATION', 4), ('EPISODES', 1), ('TESTS', 2)):
        monkeypatch.setattr(learn_by_cma, name, few)

    def run(name, processes):
        policy, curve = tmp_path / f'{name}.json', tmp_path / f'{name}.png'
        options = '--generations', '1', '--processes', str(processes), '--curve', str(curve)
        monkeypatch.setattr(sys, 'argv', ['learn_by_cma.py', str(policy), *options])
        learn_by_cma.main()
        assert curve.stat().st_size > 1000
        return json.loads(policy.read_text(encoding='utf-8'))['layers']

    yield run
    for module in ('learn_by_cma', 'follow_policy'):
        sys.modules.pop(module, None)


def test_the_same_policy_is_learnt_by_any_number_of_processes(learn, capsys):
    layers = learn('one', 1)
    told = capsys.readouterr().out.splitlines()
    assert len(told) == 2  # a line for the generation, and one for the test
    assert told[-1].endswith(' of 2 reach the goal')
    assert learn('two', 2) == layers
    node = runpy.run_path(str(SCRIPTS / 'follow_policy.py'))
    inputs = node['inputs'](np.full(361, 3.0), 1.0, 1.0, 0.0)
    forward, left = node['outputs'](layers, inputs)
    assert 0.0 <= forward <= 1.0 and abs(left) <= 1.0
