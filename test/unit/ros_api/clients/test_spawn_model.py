"""The command line of spawn_model and the XML it sends."""

import pytest
from support.refusals import exit_code

from rosbots_description.cli.spawn_model import parse_arguments
from rosbots_description.ros_api.clients import spawn_model
from rosbots_description.ros_api.clients.model_source import (
    MissingFileError,
    SourceError,
    canonical_xml,
    read_file,
)
from rosbots_description.sim.formats.sdf.sdf import load_sdf

MINIMAL = ['-urdf', '-param', 'robot_description', '-model', 'rosbots']


def test_defaults_are_gazebos():
    flags = parse_arguments(MINIMAL)
    assert (flags.x, flags.y, flags.z, flags.R, flags.P, flags.Y) == (0, 0, 0, 0, 0, 0)
    assert (flags.gazebo_namespace, flags.robot_namespace) == ('/gazebo', None)
    assert (flags.reference_frame, flags.wait, flags.joints) == ('', None, [])
    assert not (flags.sdf or flags.unpause or flags.bond or flags.package_to_model)


def test_command_line_of_the_article_with_remappings_of_roslaunch():
    remappings = ['__name:=mybot_spawn', '__log:=/x.log']
    flags = parse_arguments([*MINIMAL, '-x', '0', '-y', '-1.5', '-z', '0.5', *remappings])
    assert (flags.model, flags.y, flags.z) == ('rosbots', -1.5, 0.5)


@pytest.mark.parametrize('text, value', [('-1e-3', -0.001), ('-2.5E+1', -25.0), ('-.5e1', -5.0)])
def test_negative_exponents_are_numbers(text, value):
    flags = parse_arguments([*MINIMAL, '-x', text, '-J', 'wheel', text])
    assert flags.x == value
    assert float(flags.joints[0][1]) == value


def test_unambiguous_prefixes_of_flags_work():
    assert parse_arguments(['-ur', '-para', 'p', '-mod', 'm']).model == 'm'


def test_joints_may_be_repeated():
    flags = parse_arguments([*MINIMAL, '-J', 'a', '1', '-J', 'b', '-2'])
    assert flags.joints == [['a', '1'], ['b', '-2']]


def test_model_of_the_database_is_searched_on_the_model_path(tmp_path):
    (tmp_path / 'model.sdf').write_text(
        '<sdf version="1.6"><model name="d"><static>true</static><link name="leaf"/></model></sdf>'
    )
    flags = parse_arguments(['-sdf', '-database', 'door', '-model', 'my_door'])
    spec, _ = load_sdf(spawn_model._fetch(flags), 'my_door', find_model={'door': str(tmp_path)}.get)
    assert [link.name for link in spec.links] == ['leaf']


@pytest.mark.parametrize(
    'arguments, error_message',
    [
        (['-urdf', '-param', 'p'], 'required: -model'),
        (['-param', 'p', '-model', 'm'], '-urdf -sdf is required'),
        (['-urdf', '-model', 'm'], '-file -param -database -stdin is required'),
        (['-urdf', '-sdf', '-param', 'p', '-model', 'm'], 'not allowed with'),
        (['-urdf', '-param', 'p', '-file', 'f', '-model', 'm'], 'not allowed with'),
        ([*MINIMAL, '-x', 'far'], "'far' is not a finite number"),
        ([*MINIMAL, '-z', 'nan'], "'nan' is not a finite number"),
        ([*MINIMAL, '-gazebo'], '-gazebo'),
        ([*MINIMAL, 'robot.urdf'], 'unrecognized arguments: robot.urdf'),
    ],
)
def test_wrong_usage_exits_with_2_and_names_the_flag(arguments, error_message, capsys):
    assert exit_code(parse_arguments, arguments) == 2
    assert error_message in capsys.readouterr().err


def test_help_exits_with_0(capsys):
    assert exit_code(parse_arguments, ['-h']) == 0
    assert '-reference_frame' in capsys.readouterr().out


def test_xml_is_sent_as_ascii_without_declaration_and_comments():
    text = '<?xml version="1.0" encoding="utf-8"?><!-- c --><robot name="é"><!-- d -->ü</robot>'
    assert canonical_xml(text.encode()) == '<robot name="&#233;">&#252;</robot>'
    assert canonical_xml(text) == canonical_xml(text.encode())


def test_package_to_model_changes_only_meshes():
    text = (
        '<robot><mesh filename="package://p/a.dae"/><mesh filename="file:///package://b"/>'
        '<texture filename="package://p/t.png"/></robot>'
    )
    sent = canonical_xml(text, package_to_model=True)
    assert '<mesh filename="model://p/a.dae"' in sent
    assert '"file:///package://b"' in sent and '"package://p/t.png"' in sent
    assert 'model://' not in canonical_xml(text)


@pytest.mark.parametrize(
    'text, error_message',
    [
        (b'<robot name="x"><link name="a">', 'Invalid XML: no element found: line 1, column 31'),
        (b'hello world', 'Invalid XML: syntax error: line 1, column 0'),
        (b'<?xml version="1.0" encoding="klingon"?><a b="\xe9"/>', 'Invalid XML: unknown encoding'),
    ],
)
def test_invalid_xml_is_rejected_with_its_location(text, error_message):
    with pytest.raises(SourceError, match=error_message):
        canonical_xml(text)


def test_error_names_an_unreadable_file(tmp_path):
    empty = tmp_path / 'empty.urdf'
    empty.touch()
    with pytest.raises(SourceError, match=f'^Error: file {empty} is empty$'):
        read_file(str(empty))
    with pytest.raises(MissingFileError, match=r'specified file /nowhere.urdf does not exist$'):
        read_file('/nowhere.urdf')
    with pytest.raises(MissingFileError, match=r'specified file x{300} does not exist$'):
        read_file('x' * 300)
    with pytest.raises(MissingFileError, match=f'specified file {tmp_path} is not a file$'):
        read_file(str(tmp_path))
