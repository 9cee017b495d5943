"""The Python examples of the documents run and print what the page shows."""

import re
import subprocess

import pytest
from support import ROOT

PAGES = [ROOT / 'doc' / 'python_api.md', ROOT / 'doc' / 'gym.md']
EXAMPLE = re.compile(r'```python\n(.*?)```\n\n```text\n(.*?)```', re.DOTALL)
EXAMPLES = [
    pytest.param(page, code, printed, id=f'{page.stem}-{number}')
    for page in PAGES
    for number, (code, printed) in enumerate(EXAMPLE.findall(page.read_text(encoding='utf-8')))]


def test_every_example_has_its_output():
    blocks = sum(page.read_text(encoding='utf-8').count('```python') for page in PAGES)
    assert len(EXAMPLES) == blocks > len(PAGES)


@pytest.mark.parametrize(('page', 'code', 'printed'), EXAMPLES)
def test_output_of_an_example_is_that_of_the_page(page, code, printed, capsys):
    exec(compile(code, str(page), 'exec'), {'__name__': 'example'})
    assert capsys.readouterr().out == printed


@pytest.mark.parametrize(('_page', 'code', '_printed'), EXAMPLES)
def test_example_is_lint_clean(_page, code, _printed):
    checked = subprocess.run(
        ['ruff', 'check', '--ignore', 'ANN,D100,D107,T201', '--stdin-filename', 'example.py', '-'],
        input=code, cwd=ROOT, capture_output=True, text=True, check=False)
    assert checked.returncode == 0, checked.stdout + checked.stderr
