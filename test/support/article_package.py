"""The package that readers of the article write, of the same name as ours."""

import json
import shutil
from pathlib import Path
from xml.etree import ElementTree

_ROOT = Path(__file__).resolve().parents[2]
_DATA = _ROOT / 'test' / 'data'
THEIR_LINK = 'made_by_the_reader'  # only their robot has it


def write_article_package(folder: Path) -> None:
    """Write the package: launch files, a robot with the article's numbers, and meshes."""
    shutil.copytree(_DATA / 'article_package', folder)
    for path in list((folder / 'launch').iterdir()):
        path.rename(path.with_suffix(''))  # roslaunch finds .launch files anywhere in a package
    shutil.copytree(_ROOT / 'meshes', folder / 'meshes')
    (folder / 'urdf').mkdir()
    (folder / 'urdf' / 'rosbots.xacro').write_bytes(ElementTree.tostring(_robot()))


def _robot() -> ElementTree.Element:
    """Return the article's robot as plain URDF, so that `cat` can replace xacro."""
    article = json.loads((_DATA / 'article_robot.json').read_text(encoding='utf-8'))
    robot = _element(
        'robot', {'name': article['name'], 'xmlns:xacro': 'http://www.ros.org/wiki/xacro'}
    )
    for name, parts in article['links'].items():
        link = _element('link', {'name': name}, robot)
        for tag, part in parts.items():
            _add_part(_element(tag, {}, link), part)
    for name, joint in article['joints'].items():
        _add_joint(robot, name, joint)
    _element('link', {'name': THEIR_LINK}, robot)
    _add_joint(
        robot,
        'reader_joint',
        {
            'type': 'fixed',
            'parent': 'base_link',
            'child': THEIR_LINK,
            'origin': {'xyz': [0, 0, 0], 'rpy': [0, 0, 0]},
        },
    )
    plugin = _element(
        'plugin',
        {key: article['plugin'][key] for key in ('name', 'filename')},
        _element('gazebo', {}, robot),
    )
    for tag, text in article['plugin']['parameters'].items():
        _element(tag, {}, plugin).text = text
    return robot


def _add_part(element: ElementTree.Element, part: dict) -> None:
    _element('origin', part['origin'], element)
    if 'geometry' in part:
        geometry = dict(part['geometry'])
        _element(geometry.pop('shape'), geometry, _element('geometry', {}, element))
    else:
        _element('mass', {'value': part['mass']}, element)
        _element('inertia', part['inertia'], element)


def _add_joint(robot: ElementTree.Element, name: str, joint: dict) -> None:
    element = _element('joint', {'name': name, 'type': joint['type']}, robot)
    _element('parent', {'link': joint['parent']}, element)
    _element('child', {'link': joint['child']}, element)
    _element('origin', joint['origin'], element)
    if 'axis' in joint:
        _element('axis', {'xyz': joint['axis']}, element)


def _element(
    tag: str, attributes: dict, parent: ElementTree.Element | None = None
) -> ElementTree.Element:
    texts = {
        key: ' '.join(map(str, value)) if isinstance(value, list) else str(value)
        for key, value in attributes.items()
    }
    if parent is None:
        return ElementTree.Element(tag, texts)
    return ElementTree.SubElement(parent, tag, texts)
