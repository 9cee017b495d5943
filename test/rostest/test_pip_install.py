#!/usr/bin/env python3
"""`pip install` into an empty venv gives a library without ROS.

It takes half a minute, mostly downloads; it is skipped without a package index.
"""

import json
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from importlib.metadata import distribution
from pathlib import Path
from urllib.parse import urlsplit
from urllib.request import url2pathname

import rostest
from programs import ran_merged

ROOT = Path(__file__).resolve().parents[2]
PARTS = (
    'LICENSE',
    'package.xml',
    'pyproject.toml',
    'setup.cfg',
    'setup.py',
    'meshes',
    'requirements',
    'src',
    'urdf',
)
PATIENCE = 800.0  # [s, wall]
NO_INDEX = re.compile(r'Temporary failure in name resolution|NewConnectionError|ProxyError')
EXAMPLE = re.compile(r'```python\n(.*?)```\n\n```text\n(.*?)```', re.DOTALL)


def wheels():
    """Return pip's options to find the wheel of PyBullet that set-up has made.

    Where PyPI has a wheel, pip prefers that; elsewhere it would build one, for ten minutes.
    """
    origin = distribution('pybullet').read_text('direct_url.json')  # of PEP 610
    if origin is None:
        return ()
    wheel = Path(url2pathname(urlsplit(json.loads(origin)['url']).path))
    return ('--find-links', str(wheel.parent))


class PipInstallTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        source = cls.folder / 'source'  # a copy, since building leaves files behind
        source.mkdir()
        for part in PARTS:
            if (ROOT / part).is_dir():
                shutil.copytree(
                    ROOT / part,
                    source / part,
                    ignore=shutil.ignore_patterns('__pycache__', '*.egg-info'),
                )
            else:
                shutil.copy(ROOT / part, source)
        cls.venv = cls.folder / 'venv'
        subprocess.run(['/usr/bin/python3', '-m', 'venv', str(cls.venv)], check=True)
        installed = cls.run_python(
            *('-m', 'pip', 'install', '--disable-pip-version-check', '--no-input'),
            *wheels(),
            f'{source}[gym]',
        )
        if installed.returncode and NO_INDEX.search(installed.stdout):
            print('SKIPPED pip_install: no package index can be reached')
            raise unittest.SkipTest('no package index can be reached')
        assert installed.returncode == 0, installed.stdout

    @classmethod
    def run_python(cls, *arguments):
        """Run the Python of the venv, without this source tree on its path."""
        return cls.run_there('python', '-I', *arguments)

    @classmethod
    def run_there(cls, program, *arguments):
        """Run a program of the venv, without ROS."""
        environment = {'PATH': '/usr/bin:/bin', 'HOME': str(cls.folder)}
        command = (str(cls.venv / 'bin' / program), *arguments)
        return ran_merged(*command, cwd=cls.folder, env=environment, timeout=PATIENCE)

    def test_all_imports_are_declared(self):
        checked = self.run_python('-m', 'pip', '--disable-pip-version-check', 'check')
        self.assertEqual(checked.returncode, 0, checked.stdout)
        modules = [
            '.'.join(path.relative_to(ROOT / 'src').with_suffix('').parts).removesuffix('.__init__')
            for folder in ('sim', 'gym')
            for path in (ROOT / 'src' / 'rosbots_description' / folder).rglob('*.py')
            if path.stem != 'window'  # which needs [web]
        ]
        imported = self.run_python(
            '-c',
            'import importlib, sys\n'
            'for name in sys.argv[1:]: importlib.import_module(name)\n'
            'assert "rospy" not in sys.modules',
            *modules,
        )
        self.assertEqual((imported.returncode, imported.stdout), (0, ''))

    def test_types_worlds_and_robot_are_installed(self):
        (package,) = self.venv.glob('lib/python3*/site-packages/rosbots_description')
        for part in ('py.typed', 'worlds/room.world', 'config/gzclient.rviz'):
            self.assertTrue((package / part).is_file(), part)
        share = self.venv / 'share' / 'rosbots_description'
        for part in ('package.xml', 'meshes/base.dae', 'urdf/rosbots.xacro'):
            self.assertTrue((share / part).is_file(), part)

    def test_the_program_is_installed_and_says_what_it_lacks(self):
        ran = self.run_there('rosbots-view', 'room')
        self.assertEqual(ran.returncode, 1, ran.stdout)
        self.assertIn("pip install 'rosbots_description[web]'", ran.stdout)

    def test_the_examples_of_the_pages_run(self):
        pages = [
            (ROOT / 'doc' / name).read_text(encoding='utf-8')
            for name in ('python_api.md', 'gym.md')
        ]
        examples = [one for page in pages for one in EXAMPLE.findall(page)]
        self.assertEqual(len(examples), sum(page.count('```python') for page in pages))
        for code, printed in examples:
            ran = self.run_python('-c', f'import logging; logging.disable()\n{code}')
            self.assertEqual((ran.returncode, ran.stdout), (0, printed))


if __name__ == '__main__':
    rostest.rosrun('rosbots_description', 'pip_install', PipInstallTest, sys.argv)
