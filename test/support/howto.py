"""The modules that the pages doc/howto_*.md print."""

import importlib.util
import re
import sys

from . import ROOT

_BLOCK = re.compile(r'```python\n# src/(\S+)\.py\n(.*?)```', re.DOTALL)


def printed_modules(page):
    """Return the text of each module of a page by its path in src, without its ending."""
    return dict(_BLOCK.findall((ROOT / 'doc' / page).read_text(encoding='utf-8')))


def import_printed(path, source, folder, monkeypatch):
    """Import a module, of a file in `folder`, under the name of its path until the test ends."""
    name = path.replace('/', '.')
    file = folder / f'{name}.py'
    file.write_text(source, encoding='utf-8')
    spec = importlib.util.spec_from_file_location(name, file)
    module = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, name, module)
    spec.loader.exec_module(module)
