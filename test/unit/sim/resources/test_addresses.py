"""Addresses of every kind, found as Gazebo finds them."""

import pytest
from lxml import etree
from support.refusals import sentence_of

from rosbots_description.sim.core.errors import AbsentError, ModelError
from rosbots_description.sim.resources.addresses import Addresses
from rosbots_description.sim.resources.search_path import FileSearch, ModelSearch

FILES = {
    'model path': 'models/chair/seat.obj',
    'package': 'package/seat.obj',
    'resource path': 'share/models/chair/seat.obj',
    'its models folder': 'share/media/models/stool/seat.obj',
    'second resource path': 'more/lamp/seat.obj',
    'beside the file': 'worlds/meshes/seat.obj',
}


@pytest.fixture
def place(tmp_path):
    for path in FILES.values():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).touch()
    return tmp_path


@pytest.fixture
def addresses(place):
    return Addresses(
        ModelSearch([place / 'models']),
        {'bot': str(place / 'package')}.get,
        FileSearch([place / 'share', lambda: [place / 'more']]),
    )


@pytest.mark.parametrize(
    ('uri', 'where'),
    [
        ('model://chair/seat.obj', 'model path'),
        ('model:///chair/seat.obj', 'model path'),
        ('package://bot/seat.obj', 'package'),
        ('file://models/chair/seat.obj', 'resource path'),
        ('models/chair/seat.obj', 'resource path'),
        ('file://chair/seat.obj', 'resource path'),
        ('file://stool/seat.obj', 'its models folder'),
        ('file://lamp/seat.obj', 'second resource path'),
        ('file://meshes/seat.obj', 'beside the file'),
        ('meshes/seat.obj', 'beside the file'),
        ('file://{place}/package/seat.obj', 'package'),
        ('{place}/package/seat.obj', 'package'),
    ],
)
def test_an_address_is_found_where_gazebo_finds_it(place, addresses, uri, where):
    found = addresses.path(etree.Element('uri'), uri.format(place=place), str(place / 'worlds'))
    assert found == str(place / FILES[where])


def test_the_resource_path_precedes_the_own_folder_of_file_addresses_only(place, addresses):
    for folder in ('share', 'worlds'):
        (place / folder / 'x.obj').touch()
    element, folder = etree.Element('uri'), str(place / 'worlds')
    assert addresses.path(element, 'file://x.obj', folder) == str(place / 'share' / 'x.obj')
    assert addresses.path(element, 'x.obj', folder) == str(place / 'worlds' / 'x.obj')


@pytest.mark.parametrize('uri', ['file://nope/x.obj', 'nope/x.obj'])
def test_what_is_not_found_names_all_places_and_the_cure(place, addresses, uri):
    folder = str(place / 'worlds')
    sentence = sentence_of(AbsentError, addresses.path, etree.Element('uri'), uri, folder)
    assert f"'{uri}'" in sentence
    assert f'{place}/share, {place}/more, {place}/worlds' in sentence
    assert 'add the folder that holds it to GAZEBO_RESOURCE_PATH' in sentence


@pytest.mark.parametrize(
    'uri',
    [
        'file://../secret',
        '../secret',
        'file://models/../../secret',
        'model://../secret',
        'package://bot/../secret',
    ],
)
def test_no_address_leaves_its_folder(place, addresses, uri):
    (place / 'secret').touch()
    with pytest.raises(ModelError):
        addresses.path(etree.Element('uri'), uri, str(place / 'worlds'), str(place / 'worlds'))
