"""Links in the documents have existing targets."""

import re
from pathlib import Path

import pytest
from support import ROOT

DOCUMENTS = [ROOT / 'README.md', ROOT / 'CONTRIBUTING.md', *sorted((ROOT / 'doc').glob('*.md'))]
LINK = re.compile(r'\[[^]]*\]\(([^)\s]+)\)')


def anchors(document: Path) -> set[str]:
    """Return the anchors of a document's headings, as GitHub makes them."""
    titles = re.findall('^#+ (.*)', document.read_text(encoding='utf-8'), re.M)
    return {re.sub(r'[^\w\- ]', '', title.lower()).replace(' ', '-') for title in titles}


@pytest.mark.parametrize('document', DOCUMENTS, ids=lambda path: path.name)
def test_every_link_has_an_existing_target(document):
    targets = [target for target in LINK.findall(document.read_text(encoding='utf-8'))
               if '://' not in target]
    for target in targets:
        name, _, anchor = target.partition('#')
        file = document.parent / name if name else document
        assert file.exists(), target
        assert not anchor or anchor in anchors(file), target


def test_the_readme_names_the_tutorial():
    text = ' '.join((ROOT / 'README.md').read_text(encoding='utf-8').split())
    assert '"ROS truck trolley, part 4: creating a robot simulation in rviz and gazebo"' in text
