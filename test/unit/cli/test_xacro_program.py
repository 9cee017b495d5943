"""The executable xacro expands files for the xacro of Noetic and of older releases."""

import sys

import pytest
from support import ROOT
from support.programs import ran_by_python

from rosbots_description.cli import xacro_program

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
YAML = 'wheel: {radius: 0.25, sides: [left, right]}\nturn: !degrees 180/2\nwide: !millimeters 30\n'


@pytest.fixture(params=['xacro', 'xacro.py'])
def expand(request, tmp_path):
    """Return a function: what stands in <robot> -> exit code, output, errors."""

    def run(inside):
        (tmp_path / 'wheels.yaml').write_text(YAML)
        (tmp_path / 'robot.xacro').write_text(f'{HEAD}{inside}</robot>')
        program = ROOT / 'companions' / 'xacro' / request.param
        done = ran_by_python(program, tmp_path / 'robot.xacro', 'side:=left')
        return done.returncode, done.stdout, done.stderr

    return run


@pytest.mark.parametrize(
    ('expression', 'value'),
    [
        ("load_yaml('wheels.yaml')['wheel']['radius'] * 2", '0.5'),
        ("xacro.load_yaml('wheels.yaml').wheel.radius", '0.25'),
        ("xacro.load_yaml('wheels.yaml').wheel.sides[1]", 'right'),
        ("xacro.load_yaml('wheels.yaml').turn == math.pi / 2", 'True'),
        ("round(load_yaml('wheels.yaml').wide, 3)", '0.03'),
        ("xacro.arg('side')", 'left'),
        ('xacro.dotify(dict(a=3)).a', '3'),
        ('len([1, 2]) + python.max(1, 4) + sorted([9, 7])[0]', '13'),
        ('sin(pi / 2)', '1.0'),
    ],
)
def test_expression_of_noetic_is_evaluated(expand, expression, value):
    code, output, errors = expand(f'<link name="${{{expression}}}"/>')
    assert (code, errors) == (0, '')
    assert f'<link name="{value}"/>' in output


def test_only_an_optional_include_may_be_missing(expand):
    code, output, errors = expand(
        '<xacro:include filename="nothing.xacro" optional="true"/><link name="a"/>'
    )
    assert (code, errors) == (0, '')
    assert '<link name="a"/>' in output
    assert expand('<xacro:include filename="nothing.xacro" optional="false"/>')[0] == 2
    assert expand('<xacro:include filename="nothing.xacro"/>')[0] == 2


def test_error_names_the_missing_file_or_key(expand):
    code, _, errors = expand('<link name="${xacro.load_yaml(\'no.yaml\')}"/>')
    assert code == 2
    assert 'No such file' in errors
    code, _, errors = expand('<link name="${xacro.load_yaml(\'wheels.yaml\').weel}"/>')
    assert code == 2
    assert "there is no 'weel' in the YAML" in errors


def test_tags_without_prefix_are_still_expanded(expand):
    code, output, _ = expand('<property name="x" value="2"/><link name="l${x}"/>')
    assert code == 0
    assert '<link name="l2"/>' in output


def test_a_missing_xacro_is_one_sentence_with_the_cure(monkeypatch, capsys):
    def missing():
        raise ImportError

    monkeypatch.setattr(sys, 'path', [*sys.path])  # main changes it
    monkeypatch.setattr(xacro_program, 'import_xacro', missing)
    assert xacro_program.main() == 1
    error = capsys.readouterr().err
    assert error.count('\n') == 1
    assert sys.executable in error
    assert 'pip install xacro==1.13.3' in error
