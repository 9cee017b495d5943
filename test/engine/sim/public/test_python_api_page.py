"""The examples of doc/python_api.md run and print what the page shows."""

import re
import subprocess

import pytest
from support import ROOT

PAGE = ROOT / 'doc' / 'python_api.md'
EXAMPLE = re.compile(r'```python\n(.*?)```\n\n```text\n(.*?)```', re.DOTALL)
EXAMPLES = EXAMPLE.findall(PAGE.read_text(encoding='utf-8'))


def test_every_example_has_its_output():
    assert len(EXAMPLES) == PAGE.read_text(encoding='utf-8').count('```python') > 0


@pytest.mark.parametrize(('code', 'printed'), EXAMPLES, ids=range(len(EXAMPLES)))
def test_output_of_an_example_is_that_of_the_page(code, printed, capsys):
    exec(compile(code, str(PAGE), 'exec'), {})
    assert capsys.readouterr().out == printed


@pytest.mark.parametrize('code', [code for code, _ in EXAMPLES], ids=range(len(EXAMPLES)))
def test_example_is_lint_clean(code):
    checked = subprocess.run(
        ['ruff', 'check', '--ignore', 'D100,T201', '--stdin-filename', 'example.py', '-'],
        input=code, cwd=ROOT, capture_output=True, text=True, check=False)
    assert checked.returncode == 0, checked.stdout + checked.stderr
