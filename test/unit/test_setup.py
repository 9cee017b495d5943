"""pip installs the same packages as ./rosbots."""

import re
import runpy

import setuptools
from support import ROOT


def arguments(monkeypatch, folder):
    """Return the arguments of setup() in the setup.py of a folder."""
    called = {}
    monkeypatch.setattr(setuptools, 'setup', lambda **given: called.update(given))
    monkeypatch.chdir(folder)
    runpy.run_path('setup.py')
    return called


def test_requirements_are_those_of_the_sets(monkeypatch):
    called = arguments(monkeypatch, ROOT)
    for name, requirements in {
        'core': called['install_requires'],
        **called['extras_require'],
    }.items():
        text = (ROOT / 'requirements' / f'{name}.pip').read_text(encoding='utf-8')
        assert requirements
        assert len(requirements) == len(re.findall('^[A-Za-z]', text, re.M))
        tested = [one.replace('~=', '==') for one in requirements]
        assert all(re.search(f'^{re.escape(one)}(  #|$)', text, re.M) for one in tested)
        assert not [one for one in requirements if '==' in one.partition(';')[0]]
    assert {'batch', 'gym', 'web'} == set(called['extras_require'])


def test_the_companion_installs_the_same_packages_under_its_own_name(monkeypatch):
    ours = arguments(monkeypatch, ROOT)
    theirs = arguments(monkeypatch, ROOT / 'companions' / 'rosbots_simulator')
    assert theirs['name'] == 'rosbots_simulator'
    assert theirs['packages'] == [
        name.replace('rosbots_description', 'rosbots_simulator') for name in ours['packages']
    ]
    assert [folder for folder, _ in theirs['data_files']] == ['share/rosbots_simulator/']


def test_robot_is_installed_where_its_uris_point(monkeypatch):
    files = dict(arguments(monkeypatch, ROOT)['data_files'])
    assert 'urdf/rosbots.xacro' in files['share/rosbots_description/urdf']
    assert 'meshes/base.dae' in files['share/rosbots_description/meshes']
