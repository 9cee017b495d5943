"""The models along a search path."""

from rosbots_description.sim.resources import ModelSearch, model_names


def test_a_model_is_a_folder_with_a_description(tmp_path):
    for name, file in (('b', 'model.sdf'), ('a', 'model.config'), ('none', 'readme.txt')):
        (tmp_path / name).mkdir()
        (tmp_path / name / file).touch()
    assert model_names(ModelSearch([tmp_path, '/nowhere'])) == ['a', 'b', 'ground_plane']
