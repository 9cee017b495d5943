"""Xacro is expanded without ROS: substitutions $(...) are our own."""

import sys

import pytest
from support.refusals import sentence_of

from rosbots_description.sim.core import ModelError
from rosbots_description.sim.formats.urdf import expand_xacro

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'


@pytest.fixture(autouse=True)
def no_ros(monkeypatch):
    for name in ('roslaunch', 'rospkg'):
        monkeypatch.setitem(sys.modules, name, None)
    monkeypatch.setenv('THERE', 'by the environment')


def expand(folder, body, **arguments):
    file = folder / 'r.xacro'
    file.write_text(f'{HEAD}{body}</robot>', encoding='utf-8')
    return expand_xacro(str(file), arguments, {'known': '/somewhere'}.get)


@pytest.mark.parametrize(
    ('written', 'meant'),
    [
        ('$(find known)/meshes', '/somewhere/meshes'),
        ('$(env THERE)', 'by the environment'),
        ('$(optenv THERE no)', 'by the environment'),
        ('$(optenv NOT_THERE two words)', 'two words'),
        ('$(arg given)', 'by the caller'),
        ('$(arg absent)', 'by default'),
        ('${1 + 2}', '3'),
    ],
)
def test_substitution_is_replaced_by_its_value(tmp_path, written, meant):
    body = (
        '<xacro:arg name="given" default="no"/><xacro:arg name="absent" default="by default"/>'
        f'<link name="{written}"/>'
    )
    assert f'<link name="{meant}"/>' in expand(tmp_path, body, given='by the caller')


@pytest.mark.parametrize(
    ('name', 'said'),
    [
        ('wide\ufeff', "r.xacro: there is no xacro argument 'wide'; there are"),  # on one line
        ('lazer', "r.xacro: there is no xacro argument 'lazer'; did you mean 'laser'?"),
        ('wings', "'wings'; there are 'laser', 'height', 'undeclared'"),
        ('laser', ''),
        ('height', ''),  # declared in an included file
        ('undeclared', ''),  # but used
    ],
)
def test_argument_that_no_file_declares_is_a_warning_with_the_nearest_name(
    tmp_path, caplog, name, said
):
    (tmp_path / 'inner.xacro').write_text(
        f'{HEAD}<xacro:arg name="height" default="1"/></robot>', encoding='utf-8'
    )
    expand(
        tmp_path,
        '<xacro:arg name="laser" default="no"/><xacro:include filename="inner.xacro"/>'
        '<link name="$(arg undeclared)"/>',
        **{'undeclared': 'a', name: 'x'},
    )
    assert said in caplog.text
    assert len(caplog.records) == bool(said)


def test_argument_may_be_a_number_or_a_truth_value(tmp_path):
    body = '<xacro:arg name="a" default=""/><xacro:if value="$(arg a)"><link name="l"/></xacro:if>'
    for value, is_there in ((True, True), (0, False), ('true', True)):
        assert ('name="l"' in expand(tmp_path, body, a=value)) == is_there


def test_include_is_relative_to_the_including_file(tmp_path):
    (tmp_path / 'inner.xacro').write_text(f'{HEAD}<link name="inner"/></robot>')
    for name in ('inner.xacro', '$(dirname)/inner.xacro'):
        assert 'name="inner"' in expand(tmp_path, f'<xacro:include filename="{name}"/>')


@pytest.mark.parametrize(
    ('body', 'message'),
    [
        ('<link name="$(find unknown)"/>', "'$(find unknown)' is not a known substitution"),
        ('<link name="$(arg unknown)"/>', "'$(arg unknown)' is not a known substitution"),
        ('<link name="${1 / 0}"/>', 'division by zero'),
        ('<link', 'xacro rejects it'),
    ],
)
def test_error_of_xacro_is_one_message_with_the_file(tmp_path, body, message):
    sentence = sentence_of(ModelError, expand, tmp_path, body)
    assert message in sentence
    assert sentence.startswith(f'{tmp_path}/r.xacro: xacro rejects it')


def test_error_about_the_missing_module_names_the_cure(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, 'xacro', None)
    with pytest.raises(ModelError, match=r'pip install xacro==1\.13\.3'):
        expand(tmp_path, '')
