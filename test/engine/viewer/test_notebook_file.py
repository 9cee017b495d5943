"""The notebook of the documents runs from top to bottom, and its cells show what they promise."""

import ast
import json

import pytest
from support import ROOT

from rosbots_description.sim import SimError

NOTEBOOK = ROOT / 'doc' / 'notebook.ipynb'


def run(source, names):
    """Run a cell; return the value of its last line, if that is an expression, as a notebook."""
    tree = ast.parse(source)
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, str(NOTEBOOK), 'exec'), names)
    if last is None:
        return None
    return eval(compile(ast.Expression(last.value), str(NOTEBOOK), 'eval'), names)


def test_the_notebook_shows_a_page_a_pose_and_a_recording():
    cells = json.loads(NOTEBOOK.read_text(encoding='utf-8'))['cells']
    names = {'__name__': 'notebook'}
    shown = [run(''.join(cell['source']), names) for cell in cells if cell['cell_type'] == 'code']
    page, pose, recording, _ = shown
    assert page._repr_html_().startswith('<iframe ')
    assert pose.position[0] > 0.5
    assert 'srcdoc' in recording._repr_html_()
    with pytest.raises(SimError, match='closed'):
        names['world'].run(1)


def test_the_notebook_is_stored_without_outputs():
    cells = json.loads(NOTEBOOK.read_text(encoding='utf-8'))['cells']
    assert [cell for cell in cells if cell.get('outputs')] == []
    assert NOTEBOOK.stat().st_size < 10_000
