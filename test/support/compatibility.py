"""The tables of doc/gazebo_compatibility.md."""

from . import ROOT


def rows(section):
    """Return (name, state, remark) of each row of the table below a heading."""
    text = (ROOT / 'doc' / 'gazebo_compatibility.md').read_text(encoding='utf-8')
    lines = text.split(f'\n## {section}\n')[1].split('\n## ')[0].splitlines()
    cells = [line.strip('|').split('|') for line in lines if line.startswith('| `')]
    return [(name.strip(' `'), state.strip(), how.strip()) for name, state, how in cells]
