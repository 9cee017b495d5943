"""Materials of a model's own scripts."""

import pytest
from support.urdf import INERTIAL, link

from rosbots_description.sim.formats.sdf.sdf import load_sdf
from rosbots_description.sim.formats.urdf.urdf import load_urdf
from rosbots_description.sim.resources.search_path import FileSearch

SCRIPT = """
// material track/line { }
material track/other { technique { pass { diffuse 0 0 1 1 } } }
material track/line : track/other
{
  technique { pass {
    ambient 0.1 0.2 0.3 1
    diffuse 1 0.5 0 1 /* orange */
    specular 0.2 0.2 0.2 1 12.5
    emissive 0 0 0.1
    texture_unit { texture track.png }
  } }
  technique { pass { diffuse 0 0 0 } }
}
"""


@pytest.fixture
def model(tmp_path):
    """Return the folder of a model with scripts and textures."""
    folder = tmp_path / 'track'
    (folder / 'materials' / 'scripts').mkdir(parents=True)
    (folder / 'materials' / 'textures').mkdir()
    (folder / 'materials' / 'scripts' / 'track.material').write_text(SCRIPT, encoding='utf-8')
    (folder / 'materials' / 'textures' / 'track.png').touch()
    return folder


def material_of(model, name='track/line', uri='model://track/materials/scripts', colours=''):
    body = (
        f'<sdf version="1.6"><model name="m"><link name="l"><visual name="v"><geometry><box>'
        f'<size>1 1 1</size></box></geometry><material><script><uri>{uri}</uri><name>{name}'
        f'</name></script>{colours}</material></visual></link></model></sdf>'
    )

    def find(inner):
        path = model.parent / inner
        return str(path) if path.exists() else None

    spec, _ = load_sdf(body, 'm', find_model=find)
    return spec.links[0].visuals[0].material


@pytest.mark.parametrize('file', ['', '/track.material'])
def test_colours_and_image_are_those_of_the_first_pass(model, file):
    found = material_of(model, uri=f'model://track/materials/scripts{file}')
    light = found.reflection
    assert found.rgba == (1.0, 0.5, 0.0, 1.0)
    assert (light.ambient, light.diffuse) == ((0.1, 0.2, 0.3), (1.0, 0.5, 0.0))
    assert (light.specular, light.shininess) == ((0.2, 0.2, 0.2), 12.5)
    assert light.emissive == (0.0, 0.0, 0.1)
    assert found.image == str(model / 'materials' / 'textures' / 'track.png')


def test_colours_of_the_model_come_before_those_of_the_script(model):
    found = material_of(model, colours='<diffuse>0 1 0 1</diffuse>')
    assert (found.reflection.diffuse, found.reflection.ambient) == (
        (0.0, 1.0, 0.0),
        (0.1, 0.2, 0.3),
    )
    assert found.image


def test_what_is_not_given_is_white_without_an_image(model):
    found = material_of(model, 'track/other')
    assert (found.reflection.ambient, found.reflection.diffuse) == (
        (1.0, 1.0, 1.0),
        (0.0, 0.0, 1.0),
    )
    assert found.image == ''


@pytest.mark.parametrize(
    ('name', 'uri'),
    [
        ('track/none', 'model://track/materials/scripts'),
        ('track/line', 'model://nowhere/scripts'),
        ('track/line', 'file://media/materials/scripts/gazebo.material'),
    ],
)
def test_an_unknown_material_is_said_in_one_sentence(model, caplog, name, uri):
    assert material_of(model, name, uri).image == ''
    assert caplog.text.count(f"material '{name}' is neither one of Gazebo's nor in a script") == 1


def test_a_missing_image_or_one_outside_is_named(model, caplog):
    script = model / 'materials' / 'scripts' / 'track.material'
    for image in ('nope.png', '../../../secret.png'):
        (model.parent / 'secret.png').touch()
        script.write_text(SCRIPT.replace('track.png', image), encoding='utf-8')
        assert material_of(model).image == ''
        assert f"material 'track/line' names the image '{image}', which is not there" in caplog.text


@pytest.mark.parametrize(
    'text',
    [
        'material track/line {',
        'material track/line { ambient x y z',
        'material track/line { texture',
        '\x00' * 99,
    ],
)
def test_a_broken_script_gives_defaults(model, text):
    (model / 'materials' / 'scripts' / 'track.material').write_text(text, encoding='utf-8')
    assert material_of(model).image == ''


def test_a_script_of_the_resource_path_needs_no_address(model):
    scripts = model / 'media' / 'materials' / 'scripts'
    scripts.mkdir(parents=True)
    (scripts / 'x.material').write_text(SCRIPT, encoding='utf-8')
    find_file = FileSearch([model])
    visual = '<visual{}><geometry><box{}</geometry>{}</visual>'
    sdf = visual.format(
        ' name="v"',
        '><size>1 1 1</size></box>',
        '<material><script><name>track/line</name></script></material>',
    )
    urdf = visual.format('', ' size="1 1 1"/>', '')
    by_sdf, _ = load_sdf(
        f'<sdf version="1.6"><model name="m"><link name="l">{sdf}</link></model></sdf>',
        'm',
        find_model=lambda _: None,
        find_file=find_file,
    )
    by_urdf, _ = load_urdf(
        f'<robot name="m">{link("l", INERTIAL + urdf)}<gazebo reference="l">'
        '<material>track/line</material></gazebo></robot>',
        'm',
        find_file=find_file,
    )
    for spec in (by_sdf, by_urdf):
        assert spec.links[0].visuals[0].material.rgba == (1.0, 0.5, 0.0, 1.0)
