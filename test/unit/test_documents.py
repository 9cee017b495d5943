"""Links in the documents have existing targets."""

import re
from pathlib import Path

import pytest
from support import ROOT

from rosbots_description import batch, gym, sim

DOCUMENTS = [ROOT / 'README.md', ROOT / 'CONTRIBUTING.md', *sorted((ROOT / 'doc').glob('**/*.md'))]
LINK = re.compile(r'\[[^]]*\]\(([^)\s]+)\)')


def anchors(document: Path) -> set[str]:
    """Return the anchors of a document's headings, as GitHub makes them."""
    titles = re.findall('^#+ (.*)', document.read_text(encoding='utf-8'), re.M)
    return {re.sub(r'[^\w\- ]', '', title.lower()).replace(' ', '-') for title in titles}


@pytest.mark.parametrize('document', DOCUMENTS, ids=lambda path: path.name)
def test_every_link_has_an_existing_target(document):
    targets = [
        target
        for target in LINK.findall(document.read_text(encoding='utf-8'))
        if '://' not in target
    ]
    for target in targets:
        name, _, anchor = target.partition('#')
        file = document.parent / name if name else document
        assert file.exists(), target
        assert not anchor or anchor in anchors(file), target


@pytest.mark.parametrize('room', [sim, gym, batch], ids=lambda room: room.__name__)
def test_the_api_reference_has_every_public_name(room):
    (section,) = re.findall(
        rf'^## {re.escape(room.__name__)}\n(.*?)^```$',
        (ROOT / 'doc' / 'api.md').read_text(encoding='utf-8'),
        re.M | re.S,
    )
    named = set(re.findall(r'^\.\. auto\w+:: (\S+)', section, re.M))
    assert named == set(room.__all__) or named == {room.__name__}


def test_the_readme_names_the_tutorial():
    text = ' '.join((ROOT / 'README.md').read_text(encoding='utf-8').split())
    assert '"ROS truck trolley, part 4: creating a robot simulation in rviz and gazebo"' in text


@pytest.mark.parametrize('page', ['architecture', 'inside_the_server'])
def test_a_page_about_the_code_names_files_that_exist(page):
    text = (ROOT / 'doc' / f'{page}.md').read_text(encoding='utf-8')
    package = ROOT / 'src' / 'rosbots_description'
    names = set(re.findall(r'`([\w./]+\.py)`', text)) - {'__init__.py'}
    assert len(names) > 15
    assert not [
        name
        for name in sorted(names)
        if not (ROOT / name).is_file() and not list(package.glob(f'**/{name}'))
    ]


def test_the_architecture_names_classes_and_methods_that_exist():
    text = (ROOT / 'doc' / 'architecture.md').read_text(encoding='utf-8')
    code = '\n'.join(
        path.read_text(encoding='utf-8')
        for path in (ROOT / 'src' / 'rosbots_description').rglob('*.py')
    )
    defined = set(re.findall(r'^ *(?:class|def) (\w+)', code, re.M)) | {'Twist'}  # of ROS
    named = set(re.findall(r'`([A-Z]\w+(?:\.\w+)?)`', text))
    assert len(named) > 10
    assert not {part for name in named for part in name.split('.')} - defined


def test_the_architecture_is_one_page():
    assert (ROOT / 'doc' / 'architecture.md').read_text(encoding='utf-8').count('\n') < 90


def test_an_example_node_has_fewer_than_100_lines():
    text = (ROOT / 'doc' / 'example_nodes.md').read_text(encoding='utf-8')
    nodes = re.findall(r'^## .*: `(\w+\.py)`$', text, re.M)
    assert len(nodes) == 6
    for name in nodes:
        assert (ROOT / 'scripts' / name).read_text(encoding='utf-8').count('\n') < 100, name


def test_the_architecture_names_rooms_that_exist():
    text = (ROOT / 'doc' / 'architecture.md').read_text(encoding='utf-8')
    package = ROOT / 'src' / 'rosbots_description'
    (drawing,) = re.findall('```\n(.*?)```', text, re.S)
    rooms = {
        name
        for line in drawing.splitlines()
        for name in re.findall(r'([a-z_]+/(?:[a-z_]+/)*)', line.partition('  #')[0])
        if not line.startswith('launch')
    }
    assert len(rooms) > 25
    assert not [
        name
        for name in sorted(rooms)
        if not any(
            path.is_dir() for path in [package / name, *package.glob(f'**/{name.rstrip("/")}')]
        )
    ]


ROBOTS = ROOT / 'doc' / 'robots.md'
PICTURES = ROOT / 'doc' / 'images' / 'robots'
OF_A_ROBOT = {  # what a reader needs to repeat a run
    'a picture, or why there is none': r'!\[[^]]+\]\(images/robots/[\w-]+\.webp\)|No picture: ',
    'a date': r'\b20\d\d-\d\d-\d\d\b',
    'a commit': r'\b[\w.-]+/[\w.-]+ [0-9a-f]{7}\b',
    'a command': r'`[^`]*roslaunch [^`]+\.launch\b',
    'what works': r'^- Works: ',
    'a real-time factor': r'[Rr]eal-time factor \d\.\d\d',
}


def robots():
    """Return the text of the entry of each public robot, by its name."""
    _, *entries = re.split('^### ', ROBOTS.read_text(encoding='utf-8'), flags=re.M)
    return dict(entry.split('\n', 1) for entry in entries)


def test_there_are_twenty_public_robots():
    assert len(robots()) >= 20


@pytest.mark.parametrize('name', robots())
@pytest.mark.parametrize('part', OF_A_ROBOT)
def test_each_public_robot_has(name, part):
    assert re.search(OF_A_ROBOT[part], robots()[name], re.M)


def test_each_picture_of_a_robot_is_shown_and_small():
    shown = set(re.findall(r'images/robots/([\w-]+\.webp)', ROBOTS.read_text(encoding='utf-8')))
    there = {path.name: path.stat().st_size for path in PICTURES.iterdir()}
    assert shown == set(there)
    assert max(there.values()) < 30_000
