"""URIs of packages and files."""

import pytest
from lxml import etree

from rosbots_description.sim.core.errors import ModelError
from rosbots_description.sim.resources.uris import (
    UnknownPackage,
    file_path,
    refuse_parent_folders,
    substitute_in_tree,
    substitute_packages,
)
from rosbots_description.sim.resources.xml_parser import parse_xml

FOLDERS = {'bot': '/opt/bot', 'odd': '/opt/a & b/'}


def test_package_uri_becomes_a_path_without_file_prefix():
    text = 'package://bot/m.dae and package://odd/x package://bot'
    assert substitute_packages(text, FOLDERS.get) == '/opt/bot/m.dae and /opt/a & b/x /opt/bot'


def test_error_names_an_unknown_package():
    with pytest.raises(UnknownPackage, match=r"package 'nope' of .* is unknown") as caught:
        substitute_packages('package://nope/m.dae', FOLDERS.get)
    assert caught.value.package == 'nope'


def test_all_uris_are_substituted_and_meshes_keep_the_original():
    root = parse_xml(
        '<robot><mesh filename="package://bot/m.dae"/>'
        '<plugin><config>package://odd/c.yaml</config></plugin></robot>',
        's',
    )
    substitute_in_tree(root, FOLDERS.get)
    assert root.find('mesh').get('filename') == '/opt/bot/m.dae'
    assert root.find('mesh').get('uri') == 'package://bot/m.dae'
    assert root.findtext('plugin/config') == '/opt/a & b/c.yaml'


def test_comments_may_contain_unknown_packages():
    substitute_in_tree(parse_xml('<robot><!-- package://nope/ --></robot>', 's'), FOLDERS.get)


def test_error_about_an_unknown_package_has_its_line():
    text = '<robot>\n<link name="a"><mesh filename="package://nope/m.dae"/></link></robot>'
    root = parse_xml(text, 's')
    with pytest.raises(UnknownPackage, match=r"^s, line 2: link 'a': package 'nope'"):
        substitute_in_tree(root, FOLDERS.get)


@pytest.mark.parametrize(
    ('uri', 'path'),
    [
        ('/a/b.dae', '/a/b.dae'),
        ('file:///a/b%20c.dae', '/a/b c.dae'),
        ('/a/../b.dae', '/b.dae'),
    ],
)
def test_file_uris_become_paths(uri, path):
    assert file_path(etree.Element('mesh'), uri) == path


@pytest.mark.parametrize('scheme', ['', 'file://'])
@pytest.mark.parametrize(
    ('name', 'written'),
    [
        ('a%20b ä#&.dae', 'a%20b ä#&.dae'),
        ('a b ä#&.dae', 'a%20b%20%C3%A4%23%26.dae'),
        ('a%20b.dae', 'a%2520b.dae'),
    ],
)
def test_path_is_used_literally_or_decoded_whichever_exists(tmp_path, scheme, name, written):
    (tmp_path / name).touch()
    assert file_path(etree.Element('mesh'), f'{scheme}{tmp_path}/{written}') == f'{tmp_path}/{name}'


@pytest.mark.parametrize('uri', ['http://x/m.dae', 'model://x/m.dae', 'm.dae', 'package://x/m.dae'])
def test_other_schemes_are_rejected_with_a_cure(uri):
    with pytest.raises(ModelError, match=r'use .*file:///path'):
        file_path(parse_xml('<mesh/>', 's'), uri)


@pytest.mark.parametrize(
    'uri',
    [
        'package://bot/../x.dae',
        'package://bot/%2e%2e/x.dae',
        'package://bot/a/%2E%2E/.%2e/x.dae',
        'package://bot/..%2fx.dae',
        'package://bot%2f../x.dae',
    ],
)
def test_uri_out_of_its_package_is_rejected_in_any_spelling(uri):
    with pytest.raises(ModelError, match=r"leads out of package 'bot'; '..' is not accepted"):
        refuse_parent_folders(parse_xml('<mesh/>', 's'), uri)


@pytest.mark.parametrize('uri', ['package://bot/a/%2e%2e/x.dae', 'package://bot/..x', '/../x.dae'])
def test_uri_within_its_package_is_accepted(uri):
    refuse_parent_folders(parse_xml('<mesh/>', 's'), uri)
