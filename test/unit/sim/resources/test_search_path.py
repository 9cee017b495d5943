"""The models along a search path."""

from lxml import etree

from rosbots_description.sim.resources import ModelSearch, model_names
from rosbots_description.sim.resources.search_path import in_models


def test_a_model_is_a_folder_with_a_description(tmp_path):
    for name, file in (('b', 'model.sdf'), ('a', 'model.config'), ('none', 'readme.txt')):
        (tmp_path / name).mkdir()
        (tmp_path / name / file).touch()
    built_in = model_names(ModelSearch())
    assert {'ground_plane', 'construction_cone'} < set(built_in)
    assert 'sun' not in built_in
    assert model_names(ModelSearch([tmp_path, '/nowhere'])) == sorted([*built_in, 'a', 'b'])


def test_a_model_of_the_user_comes_before_the_built_in_one(tmp_path):
    (tmp_path / 'table').mkdir()
    element, search = etree.Element('uri'), ModelSearch([tmp_path])
    assert in_models(element, 'model://table', search) == str(tmp_path / 'table')
    assert in_models(element, 'model://beer', search).endswith('/rosbots_description/models/beer')
