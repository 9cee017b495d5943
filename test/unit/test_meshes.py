"""The meshes have the article's dimensions, are closed, and are those that the script makes."""

import json
import subprocess
import sys
from collections import Counter
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from rosbots_description.sim.core import Pose, compose, from_rpy

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = ROOT / 'tools' / 'make_meshes.py'
MAX_TRIANGLES = 3000
ROUNDING = 2e-6  # [m]; six digits are written

# Boxes in mesh coordinates [m]: (low corner, high corner).
BOXES = {
    'base': ((0.0, 0.0, 0.0), (1.1, 1.0, 0.05)),
    'battery': ((-0.2846, 0.0019, -0.0340), (-0.2136, 0.0259, 0.0)),
    'wheel': ((-0.0290, -0.0290, 0.0017), (0.0290, 0.0290, 0.0337)),
    'rasp': ((6.8, 4.4, 0.0), (10.2, 6.7, 0.656)),
    'camera': ((0.0, 0.0, 0.0), (0.0197, 0.0709, 0.0472)),
}
COLLADA = {'c': 'http://www.collada.org/2005/11/COLLADASchema'}


def document(name: str) -> ElementTree.Element:
    return ElementTree.parse(ROOT / 'meshes' / f'{name}.dae').getroot()


def floats(root: ElementTree.Element, identity: str) -> np.ndarray:
    text = root.find(f".//c:float_array[@id='{identity}-array']", COLLADA).text
    return np.array(text.split(), float).reshape(-1, 3)


def corners(name: str) -> tuple:
    """Return (points, normals), each of shape (triangles, 3, 3)."""
    root = document(name)
    lists = [np.array(p.text.split(), int) for p in root.findall('.//c:triangles/c:p', COLLADA)]
    indices = np.concatenate(lists).reshape(-1, 3, 2)
    return (
        floats(root, f'{name}-points')[indices[..., 0]],
        floats(root, f'{name}-normals')[indices[..., 1]],
    )


@pytest.fixture(scope='module')
def made(tmp_path_factory):
    """Return a folder with the meshes that the script makes."""
    folder = tmp_path_factory.mktemp('meshes')
    subprocess.run([sys.executable, '-B', str(SCRIPT), str(folder)], check=True, timeout=60)
    return folder


@pytest.mark.parametrize('name', BOXES)
def test_mesh_is_identical_to_that_of_the_script(made, name):
    assert (made / f'{name}.dae').read_bytes() == (ROOT / 'meshes' / f'{name}.dae').read_bytes()


def test_script_makes_these_meshes_and_no_others(made):
    names = {path.stem for path in made.iterdir()}
    assert names == set(BOXES) == {path.stem for path in (ROOT / 'meshes').glob('*.dae')}


@pytest.mark.parametrize('name', BOXES)
def test_mesh_fills_the_articles_box(name):
    points = corners(name)[0].reshape(-1, 3)
    np.testing.assert_allclose((points.min(axis=0), points.max(axis=0)), BOXES[name], atol=ROUNDING)


def test_wheel_is_round():
    points = corners('wheel')[0].reshape(-1, 3)
    radius = np.hypot(points[:, 0], points[:, 1])
    assert radius.max() == pytest.approx(0.0290, abs=ROUNDING)


@pytest.mark.parametrize('name', BOXES)
def test_mesh_has_few_triangles_and_has_colours(name):
    root = document(name)
    assert 100 < len(corners(name)[0]) < MAX_TRIANGLES
    colours = {colour.text for colour in root.findall('.//c:diffuse/c:color', COLLADA)}
    assert len(colours) >= 2


@pytest.mark.parametrize('name', BOXES)
def test_triangles_have_area_and_matching_normals(name):
    points, normals = corners(name)
    area = np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
    size = np.linalg.norm(area, axis=1)
    assert np.isfinite(normals).all()
    assert size.min() > 0.0
    np.testing.assert_allclose(np.linalg.norm(normals, axis=2), 1.0, atol=1e-5)
    cosine = np.einsum('ij,ikj->ik', area / size[:, None], normals)
    assert cosine.min() > 0.7  # smooth shading may tilt a normal but not reverse it


@pytest.mark.parametrize('name', BOXES)
def test_every_part_is_closed_and_faces_outwards(name, monkeypatch):
    monkeypatch.syspath_prepend(str(SCRIPT.parent))
    from make_meshes import MESHES

    for number, (colour, surface) in enumerate(MESHES[name][0]()):
        _, vertices = np.unique(surface.reshape(-1, 3).round(9), axis=0, return_inverse=True)
        a, b, c = vertices.reshape(-1, 3).T.tolist()
        edges = Counter(zip(a + b + c, b + c + a, strict=True))
        volume = np.einsum('ij,ij', surface[:, 0], np.cross(surface[:, 1], surface[:, 2])) / 6.0
        assert all(edges[end, start] == edges[start, end] for start, end in list(edges)), (
            f'{name} part {number} ({colour.name}) has a gap'
        )
        assert volume > 0.0, f'{name} part {number} ({colour.name}) is inside out'


@pytest.mark.parametrize('name', BOXES)
def test_file_declares_metres_and_up_axis(name):
    asset = document(name).find('c:asset', COLLADA)
    assert asset.find('c:unit', COLLADA).get('meter') == '1'
    assert asset.find('c:up_axis', COLLADA).text == ('Y_UP' if name == 'camera' else 'Z_UP')


# Extents of the article's meshes in base_link [m]: link; ranges of x, y, z (None: not measured).
LANDINGS = [
    ('base_link', (-0.52, 0.58), (-0.40, 0.60), (0.43, 0.48)),
    ('base_second_link', (-0.52, 0.58), (-0.40, 0.60), (0.68, 0.73)),
    ('batery_link', (-0.523, 0.400), (-0.006, 0.199), (0.491, 0.635)),
    ('wheel_left_link', None, (0.426, 0.682), None),
    ('wheel_right_link', None, (-0.549, -0.293), None),
    ('mcu_link', (-0.02, 0.30), (-0.18, 0.30), (0.73, 0.82)),
]
LANDING_TOLERANCE = 0.008  # [m]; the measures are rounded, and quarter turns are 1.57


@pytest.mark.parametrize(('link', 'ranges'), [(link, ranges) for link, *ranges in LANDINGS])
def test_extents_in_base_link_are_those_of_the_article(link, ranges):
    # test_robot.py proves that the URDF places the meshes as this file says
    article = json.loads((ROOT / 'test/data/article_robot.json').read_text(encoding='utf-8'))
    joint = next((each for each in article['joints'].values() if each['child'] == link), None)
    visual = article['links'][link]['visual']
    geometry = visual['geometry']
    pose = Pose()
    for place in (*([joint['origin']] if link != 'base_link' else []), visual['origin']):
        pose = compose(pose, Pose(tuple(place['xyz']), from_rpy(*place['rpy'])))
    points = corners(Path(geometry['filename']).stem)[0].reshape(-1, 3)
    points = points * geometry.get('scale', (1.0, 1.0, 1.0))
    landed = np.array([compose(pose, Pose(tuple(point))).position for point in points])
    for axis, expected in enumerate(ranges):
        if expected is not None:
            reached = landed[:, axis].min(), landed[:, axis].max()
            assert reached == pytest.approx(expected, abs=LANDING_TOLERANCE)
