"""No address in a description or command line makes the simulator open a connection."""

import pytest
from support.programs import python

# Ends the program at the first connection or name lookup. libxml2 would
# bypass this; its parsers are created with no_network.
GUARD = """
import sys

def forbid(event, arguments):
    if event in ('socket.connect', 'socket.sendto', 'socket.getaddrinfo', 'socket.gethostbyname',
                 'urllib.Request', 'subprocess.Popen', 'os.exec', 'os.posix_spawn', 'os.system'):
        raise SystemExit(f'{event} {arguments}')

sys.addaudithook(forbid)
"""
LOAD_URDF = 'from rosbots_description.sim.formats.urdf.urdf import load_urdf; load_urdf(TEXT, "m")'
LOAD_SDF = (
    'from rosbots_description.ros_api.node.packages import find_model, find_package; '
    'from rosbots_description.sim.formats.sdf.sdf import load_sdf; '
    'load_sdf(TEXT, "m", find_model=find_model, find_package=find_package)'
)
INERTIAL = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>'
MESH = (
    f'<link name="l">{INERTIAL}'
    '<collision><geometry><mesh filename="{}"/></geometry></collision></link>'
)
SDF = '<sdf version="1.6"><world name="w"><include><uri>{}</uri></include></world></sdf>'
COLLADA = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<library_images><image id="i"><init_from>http://example.org/i.png</init_from></image></library_images>
<scene><instance_visual_scene url="http://example.org/scene.dae#s"/></scene></COLLADA>"""
OBJECT = 'mtllib http://example.org/m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n'


def run(code, text=''):
    """Run code with TEXT under the guard; return the last line of its error output."""
    done = python(f'{GUARD}\nTEXT = {text!r}\n{code}')
    return (done.stderr.splitlines() or [''])[-1]


def test_the_guard_notices_a_connection():
    assert run('import urllib.request as r; r.urlopen("http://localhost:9")').startswith('urllib')
    assert run('import socket; socket.create_connection(("localhost", 9))').startswith('socket.')


@pytest.mark.parametrize(
    ('load', 'text', 'message'),
    [
        (
            LOAD_URDF,
            f'<robot name="r">{MESH.format("http://example.org/m.dae")}</robot>',
            'http:// addresses are not read here',
        ),
        (
            LOAD_URDF,
            '<!DOCTYPE robot SYSTEM "http://example.org/r.dtd"><robot name="r"/>',
            'a document type (<!DOCTYPE>) is not accepted',
        ),
        (LOAD_SDF, SDF.format('http://example.org/m'), 'models are not fetched from the network'),
        (
            LOAD_SDF,
            SDF.format('model://euro_pallet'),
            "'model://euro_pallet' is not to be found along the model path",
        ),
    ],
    ids=['mesh', 'document type', 'included address', 'unknown model'],
)
def test_address_is_rejected_without_network_access(load, text, message):
    assert message in run(load, text)


@pytest.mark.parametrize(
    ('name', 'content', 'message'),
    [
        ('m.dae', COLLADA, "m.dae' "),
        ('m.obj', OBJECT, ''),
    ],
)
def test_mesh_file_does_not_open_other_addresses(tmp_path, name, content, message):
    path = tmp_path / name
    path.write_text(content, encoding='utf-8')
    error_message = run(LOAD_URDF, f'<robot name="r">{MESH.format(path)}</robot>')
    assert message in error_message
    assert 'socket' not in error_message
    assert 'urllib' not in error_message


@pytest.mark.parametrize('model', ['euro_pallet', 'http://example.org/euro_pallet'])
def test_model_of_the_database_is_searched_on_the_model_path_only(model):
    code = (
        'import argparse\n'
        'from rosbots_description.ros_api.clients.spawn_model import _fetch\n'
        f'TEXT = _fetch(argparse.Namespace(file=None, param=None, database={model!r}))\n'
    )
    assert f"'model://{model}' is not to be found along the model path" in run(code + LOAD_SDF)
