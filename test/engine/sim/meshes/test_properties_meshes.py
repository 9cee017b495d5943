"""Property tests: a shape of a damaged mesh file is left out, or simulated."""

import struct
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.collada import INSTANCE, collada
from support.fuzzing import Fuzzer
from support.mutations import damaged, damaged_bytes, damaged_lines

POINTS = st.lists(st.tuples(*[st.floats(-2.0, 2.0, width=32)] * 3), min_size=4, max_size=8)
SQUARE = (
    '<polylist count="1"><input semantic="VERTEX" source="#v" offset="0"/><vcount>4</vcount>'
    '<p>0 1 2 3</p></polylist>'
)
NODES = (
    '<node><translate>0 0 1</translate><rotate>0 0 1 30</rotate><node><matrix>1 0 0 0 0 1 0 0 0 0 '
    f'1 0 0 0 0 1</matrix>{INSTANCE}</node></node>'
)


def words(numbers):
    return ' '.join(map(repr, numbers))


@pytest.fixture(scope='module')
def fuzzer():
    with Fuzzer() as fuzzer:
        yield fuzzer
        fuzzer.require_both()


@st.composite
def colladas(draw):
    points = draw(POINTS)
    index = [(0, n, n + 1) for n in range(1, len(points) - 1)]
    text = collada(
        words(x for point in points for x in point),
        words(n for face in index for n in face),
        draw(st.sampled_from(('1', '0.01', '0.0254'))),
        nodes=NODES,
    )
    return text.replace('</triangles>', f'</triangles>{SQUARE}')


@st.composite
def binary_stls(draw):
    points = draw(POINTS)
    triangles = [
        struct.pack('<12fH', 0, 0, 1, *points[0], *a, *b, 0) for a, b in pairwise(points[1:])
    ]
    return bytes(80) + struct.pack('<I', len(triangles)) + b''.join(triangles)


@st.composite
def ascii_stls(draw):
    points = draw(POINTS)
    return '\n'.join(
        [
            'solid s',
            *(
                f'facet normal 0 0 1\nouter loop\nvertex {words(points[0])}\n'
                f'vertex {words(a)}\nvertex {words(b)}\nendloop\nendfacet'
                for a, b in pairwise(points[1:])
            ),
            'endsolid s\n',
        ]
    )


@st.composite
def objs(draw):
    points = draw(POINTS)
    count = len(points)
    return '\n'.join(
        [
            'o thing',
            *(f'v {words(point)}' for point in points),
            'vn 0 0 1',
            'vt 0.5 0.5',
            'usemtl red',
            *(f'f 1 {n} {n + 1}' for n in range(2, count)),
            f'f {" ".join(f"{n}/1/1" for n in range(1, count + 1))}',
            'f -1 -2 -3',
            'g end',
        ]
    )


@given(st.data())
def test_damaged_collada_is_refused_or_simulated(fuzzer, data):
    fuzzer.judge('mesh', '.dae', data.draw(damaged(data.draw(colladas()), 2)))


@given(st.data())
def test_damaged_binary_stl_is_refused_or_simulated(fuzzer, data):
    fuzzer.judge('mesh', '.stl', data.draw(damaged_bytes(data.draw(binary_stls()))))


@given(st.data())
def test_damaged_ascii_stl_is_refused_or_simulated(fuzzer, data):
    fuzzer.judge('mesh', '.stl', data.draw(damaged_lines(data.draw(ascii_stls()))))


@given(st.data())
def test_damaged_obj_is_refused_or_simulated(fuzzer, data):
    fuzzer.judge('mesh', '.obj', data.draw(damaged_lines(data.draw(objs()))))
