"""The commands of the README, as printed."""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def code_blocks(heading):
    """Return the indented blocks of a section."""
    (section,) = re.findall(rf'^## {re.escape(heading)}\n(.*?)^## ', _text(), re.M | re.S)
    blocks = re.findall(r'(?:^ {4}.*\n)+', section, re.M)
    return [re.sub('^ {4}', '', block, flags=re.M) for block in blocks]


def steps():
    """Return the commands of the tutorial by number of the step."""
    rows = re.findall(r'^\| (\d) \| (.*?) \| ', _text(), re.M)
    return {int(number): re.findall('`(.*?)`', typed) for number, typed in rows}


def _text():
    return (ROOT / 'README.md').read_text(encoding='utf-8')
