"""Read binary and text STL files, and write binary ones: plain triangles without colours."""

import re

import numpy as np

from ..core.arrays import FloatArray

_HEADER = 84  # bytes: a title and the number of triangles
_TRIANGLE = np.dtype([('normal', '<f4', 3), ('corners', '<f4', (3, 3)), ('attribute', '<u2')])
_VERTEX = re.compile(r'\bvertex\s+(\S+)\s+(\S+)\s+(\S+)', re.IGNORECASE)


def write_stl(corners: FloatArray) -> bytes:
    """Return a binary STL file of triangles (n, 3, 3); their normals are left to the reader."""
    triangles = np.zeros(len(corners), _TRIANGLE)
    triangles['corners'] = corners
    return bytes(80) + len(corners).to_bytes(4, 'little') + triangles.tobytes()


def read_stl(content: bytes) -> FloatArray:
    """Return the corners of the triangles (n, 3, 3) in the file's unit, by ROS convention metres.

    All solids of a text file count as one.

    Raises:
        ValueError: the file is truncated or not STL; the message is a clause.
    """
    promised = int.from_bytes(content[80:_HEADER], 'little')
    there = (len(content) - _HEADER) // _TRIANGLE.itemsize
    exact = len(content) == _HEADER + promised * _TRIANGLE.itemsize
    if not exact and content.lstrip()[:5].lower() == b'solid':
        return _read_text(content.decode('utf-8', 'replace'))
    if len(content) < _HEADER or there < promised:
        raise ValueError(
            f'its header promises {promised} triangles, but only {max(0, there)} are there'
            if len(content) >= _HEADER
            else 'it is shorter than the header of a binary STL'
        )
    triangles = np.frombuffer(content, _TRIANGLE, promised, _HEADER)
    return triangles['corners'].astype(float)


def _read_text(text: str) -> FloatArray:
    corners = np.array(_VERTEX.findall(text), dtype=float)
    if len(corners) % 3:
        raise ValueError(f'it has {len(corners)} corners, which make no whole triangles')
    return corners.reshape(-1, 3, 3)
