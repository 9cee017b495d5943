"""Files and values as texts that the simulator takes."""

import pytest
import rospy
from support.refusals import sentence_of

from rosbots_description.ros_api.window.library import RosLibrary
from rosbots_description.sim.core import SimError
from rosbots_description.sim.description import LightSpec
from rosbots_description.sim.formats import load_sdf, load_sdf_light
from rosbots_description.sim.resources import MAX_XML_BYTES
from rosbots_description.web.editing.shapes import point_light, shape

HEAD = '<robot name="a" xmlns:xacro="http://www.ros.org/wiki/xacro">'


@pytest.fixture
def library():
    return RosLibrary()


def test_urdf_is_sent_as_it_is_without_its_declaration(library):
    text = library.file(
        '../a.urdf', '<?xml version="1.0" encoding="latin1"?>\n<r n="é"/>'.encode('latin1')
    )
    assert (text.name, text.xml) == ('', '\n<r n="é"/>')


def test_xacro_is_expanded(library):
    text = library.file('../../A.XACRO', f'{HEAD}<link name="${{1+2}}"/></robot>'.encode())
    assert '<link name="3"/>' in text.xml


@pytest.mark.parametrize(
    ('inner', 'reason'),
    [
        ('<xacro:nope/>', 'unknown macro name: xacro:nope'),
        ('<link', 'XML parsing error'),
        ('<xacro:include filename="../x.xacro"/>', 'No such'),
        ('<link name="${[0]*10**12}"/>', "when evaluating expression '[0]*10**12'"),
    ],
)
def test_xacro_that_is_rejected_says_why_in_a_sentence(library, inner, reason):
    said = sentence_of(SimError, library.file, 'a.xacro', f'{HEAD}{inner}</robot>'.encode())
    assert said.startswith("'a.xacro': xacro rejects it: ")
    assert reason in said
    assert '/tmp' not in said


@pytest.mark.parametrize(
    ('content', 'reason'),
    [
        (b'\0\1\xff', 'is not text'),
        (b' ' * (MAX_XML_BYTES + 1), f'{MAX_XML_BYTES} are accepted'),
    ],
)
def test_what_is_no_description_is_refused(library, content, reason):
    with pytest.raises(SimError, match=reason):
        library.file('a.urdf', content)


def test_shapes_and_lights_are_read_as_they_were_written(library):
    spec = shape('cylinder', (0.5, 0.5, 2.0), 3.0, (1.0, 0.5, 0.0), False)
    text = library.shape(spec)
    read, _ = load_sdf(text.xml, text.name, find_model=lambda _: None)
    assert (read.static, read.links[0].collisions) == (False, spec.links[0].collisions)
    assert read.links[0].inertial == spec.links[0].inertial
    assert read.links[0].visuals[0].material.rgba == (1.0, 0.5, 0.0, 1.0)
    for light in (
        point_light((1.0, 2.0, 0.0), (1.0, 0.5, 0.0)),
        LightSpec('s', 'spot', spot_inner_angle=0.2, spot_outer_angle=0.4),
    ):
        assert load_sdf_light(library.light(light).xml, light.name) == light


def test_each_parameter_is_read_once(library, monkeypatch):
    held, read = {'/a/robot_description': '<robot name="a"/>', '/rate': 50, '/note': 'text'}, []
    monkeypatch.setattr(rospy, 'get_param_names', lambda: list(held))
    monkeypatch.setattr(rospy, 'get_param', lambda name, _: read.append(name) or held[name])
    assert library.parameters() == library.parameters() == ['/a/robot_description']
    assert sorted(read) == sorted(held)
    held['/b'] = '<robot name="b"/>'
    assert library.parameters() == ['/a/robot_description', '/b']
    assert len(read) == 4


def test_model_of_the_model_path_is_included_whatever_its_name(library):
    assert '<uri>model://a&amp;b</uri>' in library.model('a&b').xml
