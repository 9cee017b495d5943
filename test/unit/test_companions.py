"""The companions work beside a user's own rosbots_description, except that about our robot."""

import re
from xml.etree import ElementTree

import pytest
from support import ROOT

COMPANIONS = sorted((ROOT / 'companions').iterdir())
ABOUT_OUR_ROBOT = 'rosbots_navigation'
# References of a file to another package or its Python module.
ASKING = re.compile(
    r'(import|from|\$\(find|pkg="|package://|rosrun|roslaunch|find_package\(catkin.*) ?'
    r'rosbots_description\b'
)


@pytest.mark.parametrize(
    'folder',
    [folder for folder in COMPANIONS if folder.name != ABOUT_OUR_ROBOT],
    ids=lambda folder: folder.name,
)
def test_companions_do_not_refer_to_the_package_at_the_root(folder):
    manifest = ElementTree.parse(folder / 'package.xml').getroot()
    assert not [
        element.tag
        for element in manifest
        if element.tag.endswith('depend') and element.text == 'rosbots_description'
    ]
    asking = [
        path
        for path in folder.rglob('*')
        if path.is_file() and ASKING.search(path.read_text(encoding='utf-8', errors='replace'))
    ]
    assert asking == []


def test_simulator_is_importable_under_both_names():
    (folder,) = (folder for folder in COMPANIONS if folder.name == 'rosbots_simulator')
    linked = folder / 'src' / 'rosbots_simulator'
    assert linked.resolve() == folder.parents[1] / 'src' / 'rosbots_description'
