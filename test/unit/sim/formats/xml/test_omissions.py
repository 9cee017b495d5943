"""Each omission of a model is reported once, with location, reason and page."""

import logging

import pytest
from support.urdf import INERTIAL, joint, link

from rosbots_description.sim import plugins  # noqa: F401  registers
from rosbots_description.sim.description.model_spec import Box
from rosbots_description.sim.formats.sdf.sdf import load_sdf
from rosbots_description.sim.formats.urdf.urdf import load_urdf
from rosbots_description.sim.plugin_registry.gazebo_libraries import library_remark
from rosbots_description.sim.resources.search_path import ModelSearch

TRIANGLE = 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n'


def urdf(inside='', after='', **options):
    text = f'<robot name="r">\n{link("a", INERTIAL + inside)}\n{after}</robot>'
    return load_urdf(text, 'bot', source='bot.urdf', **options)[0]


def sdf(inside, find_model=None):
    text = f'<sdf version="1.6"><model name="m">\n<link name="a">{inside}</link></model></sdf>'
    return load_sdf(text, 'bot', source='b.sdf', find_model=find_model or ModelSearch())[0]


def shape(kind, geometry):
    return f'<{kind} name="s"><geometry>{geometry}</geometry></{kind}>'


def logged(caplog):
    return [(record.levelname, record.getMessage()) for record in caplog.records]


def test_missing_mesh_is_one_error_that_lists_its_users(caplog, tmp_path):
    mesh = '<mesh filename="package://p/wheel.dae"/>'
    spec = urdf(
        shape('collision', mesh)
        + shape('collision', '<box size="1 1 1"/>')
        + '\n'
        + shape('visual', mesh),
        find_package={'p': str(tmp_path)}.get,
    )
    assert [part.geometry for part in spec.links[0].collisions] == [Box((1.0, 1.0, 1.0))]
    assert spec.links[0].visuals == ()
    assert spec.left_out == ("mesh 'package://p/wheel.dae'",)
    assert logged(caplog) == [
        (
            'ERROR',
            (
                f"model 'bot' (bot.urdf): mesh file '{tmp_path}/wheel.dae' does not exist or "
                f'cannot be '
                "reached; check name and package (written 'package://p/wheel.dae'); "
                "left out: collision of link 'a' (line 2), visual of link 'a' (line 3)"
            ),
        )
    ]


def test_error_about_a_mesh_missing_from_the_model_path_lists_the_searched_folders(
    caplog, tmp_path
):
    spec = sdf(
        shape('collision', '<mesh><uri>model://mailbox/m.dae</uri></mesh>'),
        ModelSearch([tmp_path / 'a', tmp_path / 'b']),
    )
    assert spec.links[0].collisions == ()
    assert spec.left_out == ("mesh 'model://mailbox/m.dae'",)
    ((level, sentence),) = logged(caplog)
    assert level == 'ERROR'
    assert sentence.startswith(
        "b.sdf: 'model://mailbox/m.dae' is not to be found along the model "
        f'path ({tmp_path}/a, {tmp_path}/b); add the folder'
    )
    assert sentence.endswith("; left out: collision of link 'a' (line 2)")


def test_meshes_of_a_urdf_are_found_on_the_model_path(tmp_path):
    (tmp_path / 'bot').mkdir()
    (tmp_path / 'bot' / 'm.OBJ').write_text(TRIANGLE)
    spec = urdf(
        shape('collision', '<mesh filename="model://bot/m.OBJ" scale="-1 1 1"/>'),
        find_model=ModelSearch([tmp_path]),
    )
    assert spec.links[0].collisions[0].geometry.path == str(tmp_path / 'bot' / 'm.OBJ')
    assert spec.left_out == ()


@pytest.mark.parametrize(
    'filename, reason',
    [
        ('{folder}/m.obj', 'is broken'),
        ('meshes/m.obj', 'is not to be found in'),
        ('http://host/m.obj', 'http:// addresses are not read'),
        ('{folder}/m.wrl', 'is not read'),
    ],
)
def test_unreadable_mesh_is_left_out(tmp_path, caplog, filename, reason):
    for name in ('m.obj', 'm.wrl'):
        (tmp_path / name).write_text('v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n')
    spec = urdf(shape('visual', f'<mesh filename="{filename.format(folder=tmp_path)}"/>'))
    assert spec.links[0].visuals == ()
    ((level, sentence),) = logged(caplog)
    assert level == 'ERROR' and reason in sentence
    assert sentence.endswith("; left out: visual of link 'a' (line 2)")


@pytest.mark.parametrize(
    ('read', 'geometry'),
    [
        (urdf, '<box size="0 0 0"/>'),
        (urdf, '<box size="1 0 1"/>'),
        (urdf, '<sphere radius="0"/>'),
        (urdf, '<sphere radius="0.0"/>'),
        (urdf, '<cylinder radius="0" length="1"/>'),
        (urdf, '<cylinder radius="1" length="0"/>'),
        (urdf, '<mesh filename="/nowhere/m.dae" scale="1 0 0"/>'),
        (sdf, '<box><size>0 0 0</size></box>'),
        (sdf, '<sphere><radius>0</radius></sphere>'),
        (sdf, '<cylinder><radius>1</radius><length>0</length></cylinder>'),
        (sdf, '<mesh><uri>/nowhere/m.dae</uri><scale>1 0 0</scale></mesh>'),
    ],
)
@pytest.mark.parametrize('kind', ['collision', 'visual'])
def test_a_shape_without_size_is_left_out(read, kind, geometry, caplog):
    spec = read(shape(kind, geometry))
    assert (spec.links[0].collisions, spec.links[0].visuals) == ((), ())
    assert spec.left_out == (f"{kind} of link 'a'",)
    ((level, sentence),) = logged(caplog)
    assert level == 'WARNING'
    source = {urdf: "model 'bot' (bot.urdf): line 2", sdf: 'b.sdf, line 2'}[read]
    assert sentence.startswith(f"{source}: link 'a': ")
    assert sentence.endswith(f'reduces it to nothing; the {kind} is left out')


def test_model_is_read_without_a_missing_include_and_its_joint(caplog):
    text = """<sdf version="1.6"><model name="m"><link name="a"/>
<include><uri>model://hokuyo</uri><pose>1 0 0 0 0 0</pose></include>
<joint name="j" type="fixed"><child>hokuyo::link</child><parent>a</parent></joint>
</model></sdf>"""
    spec, _ = load_sdf(text, 'bot', source='b.sdf', find_model=ModelSearch(['/models']))
    assert [link.name for link in spec.links] == ['a']
    assert spec.joints == ()
    assert spec.left_out == ("model 'model://hokuyo'", "joint 'j'")
    assert [level for level, _ in logged(caplog)] == ['ERROR', 'ERROR']
    assert caplog.messages[0].startswith("b.sdf, line 2: model 'm': 'model://hokuyo' is not to be")
    assert caplog.messages[1].startswith("b.sdf, line 3: joint 'j': <child> names 'hokuyo::link'")
    assert caplog.messages[1].endswith("; joint 'j' is left out")


def test_links_without_mass_are_omissions():
    spec = urdf(after=link('b', '') + joint('j', 'a', 'b'))
    assert spec.left_out == ("link 'b'",)


def test_log_about_thousands_of_missing_meshes_is_short(caplog):
    mesh = shape('visual', '<mesh filename="/nowhere/m{}.dae"/>')
    urdf(''.join(mesh.format(i) for i in range(2000)) + mesh.format(0) * 2000)
    assert 0 < len(caplog.records) <= 50
    assert all(len(message) < 2500 for message in caplog.messages)


@pytest.mark.parametrize(
    'filename',
    [
        'libgazebo_ros_elevator.so',
        '/opt/ros/noetic/lib/libgazebo_ros_elevator.so',
        'gazebo_ros_elevator',
    ],
)
def test_known_library_is_recognised_in_any_spelling(filename):
    assert library_remark(filename) == 'libgazebo_ros_elevator.so is known but not supported yet'


@pytest.mark.parametrize(
    'filename, remark',
    [
        ('libgazebo_ros_dif_drive.so', "did you mean 'libgazebo_ros_diff_drive.so'?"),
        ('libhector_sonar.so', 'nothing is loaded from GAZEBO_PLUGIN_PATH'),
        ('', "unknown library ''"),
        ('libgazebo_ros_diff_drive.so', 'works only in a <gazebo> or <model>'),
    ],
)
def test_unknown_library_has_its_own_remark(filename, remark):
    assert remark in library_remark(filename)


def test_unsupported_plugin_of_a_link_is_reported_with_its_library(caplog):
    urdf(after='<gazebo reference="a"><plugin filename="libgazebo_ros_elevator.so"/></gazebo>')
    ((level, sentence),) = logged(caplog)
    assert level == logging.getLevelName(logging.WARNING)
    assert 'libgazebo_ros_elevator.so is known but not supported yet' in sentence
    assert sentence.endswith('move it to a <gazebo> without reference')
