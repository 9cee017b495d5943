"""Decimate meshes that are too fine to be simulated and shown."""

import numpy as np

from ..core.arrays import FloatArray, IntArray


def decimated(
    vertices: FloatArray, faces: IntArray, most: int
) -> tuple[FloatArray, IntArray, IntArray, float]:
    """Return at most `most` triangles that approximate a mesh.

    Vertices in one cell of a grid are merged into the first of them (vertex clustering); degenerate
    triangles are left out.

    Args:
        vertices: (n, 3) [m].
        faces: (m, 3), indices of vertices.

    Returns:
        Vertices, faces, the former indices of the vertices, and the edge of a cell [m]: no vertex
        has moved by more than the diagonal of a cell.
    """
    low = vertices.min(axis=0)
    size = float((vertices.max(axis=0) - low).max())
    # A surface crosses about n^2 of n^3 cells, and has twice as many triangles as vertices.
    count = max(2, int((most / 2.0) ** 0.5))
    while True:
        cell = size / count
        key = np.zeros(len(vertices), dtype=np.int64)
        for column in ((vertices - low) / (cell or 1.0)).astype(np.int64).T:
            key = key * (count + 1) + column
        _, first, number = np.unique(key, return_index=True, return_inverse=True)
        triangles = number.reshape(-1)[faces]
        a, b, c = triangles.T
        triangles = triangles[(a != b) & (b != c) & (c != a)]
        a, b, c = triangles.T
        _, distinct = np.unique((a * len(first) + b) * len(first) + c, return_index=True)
        triangles = triangles[distinct]
        if len(triangles) <= most or count <= 1:
            break
        count = int(count * min(0.8, (most / len(triangles)) ** 0.5))
    if not len(triangles):
        triangles = faces[:1] * 0  # the mesh degenerates to a point
    return vertices[first], triangles[:most], first, cell
