"""The Python examples of the documents run and print what the page shows."""

import ast
import inspect
import re

import pytest
from support import ROOT
from support.programs import lint_faults

from rosbots_description.sim import Joint, Link, Model, World
from rosbots_description.sim.controllers import ControllerManager, JointTrajectoryController
from rosbots_description.sim.plugins import Drive

PAGES = [ROOT / 'doc' / 'python_api.md', ROOT / 'doc' / 'gym.md']
EXAMPLE = re.compile(r'```python\n(.*?)```\n\n```text\n(.*?)```', re.DOTALL)
EXAMPLES = [
    pytest.param(page, code, printed, id=f'{page.stem}-{number}')
    for page in PAGES
    for number, (code, printed) in enumerate(EXAMPLE.findall(page.read_text(encoding='utf-8')))
]

OWNERS = {
    'world': World,
    'robot': Model,
    'link': Link,
    'joint': Joint,
    'drive': Drive,
    'manager': ControllerManager,
    'arm': JointTrajectoryController,
}
CALLS = re.compile(r'`(\w*)\.(\w+)\(([^`()]*)\)`')


def calls_of_tables():
    """Yield the calls in the first column of the tables: owner, method, arguments."""
    for line in PAGES[0].read_text(encoding='utf-8').splitlines():
        owner = ''
        for name, method, arguments in CALLS.findall(line.split(' | ')[0]):
            owner = name or owner
            if line.startswith('|') and owner in OWNERS:
                yield owner, method, arguments.split(', ') if arguments else []


def test_tables_name_arguments_as_they_are():
    calls = [*calls_of_tables()]
    assert len(calls) > 20
    for owner, method, arguments in calls:
        signature = inspect.signature(getattr(OWNERS[owner], method))
        named = {one.partition('=')[0]: one.partition('=')[2] for one in arguments}
        positional = [name for name, default in named.items() if default != '…']
        taken = [name for name in signature.parameters if name != 'self']
        assert taken[: len(positional)] == positional, (owner, method)
        assert {*named} <= {*taken}, (owner, method)
        for name, default in named.items():
            if default not in ('', '…'):
                assert signature.parameters[name].default == ast.literal_eval(default), (
                    owner,
                    method,
                    name,
                )


def test_every_example_has_its_output():
    blocks = sum(page.read_text(encoding='utf-8').count('```python') for page in PAGES)
    assert len(EXAMPLES) == blocks > len(PAGES)


@pytest.mark.parametrize(('page', 'code', 'printed'), EXAMPLES)
def test_output_of_an_example_is_that_of_the_page(page, code, printed, capsys):
    exec(compile(code, str(page), 'exec'), {'__name__': 'example'})
    assert capsys.readouterr().out == printed


@pytest.mark.parametrize(('_page', 'code', '_printed'), EXAMPLES)
def test_example_is_lint_clean(_page, code, _printed):
    assert not lint_faults(code, 'example.py', '--ignore', 'ANN,D100,D107,T201')
