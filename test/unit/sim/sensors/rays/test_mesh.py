"""Meshes for rays: their bounds, and the thread that builds them, which no fork is without."""

import math
import os
import threading

import pytest

from rosbots_description.sim.description import Mesh
from rosbots_description.sim.sensors.rays import mesh as ray_mesh


def test_a_fork_has_the_meshes_that_were_being_built(monkeypatch):
    begun = threading.Event()

    def build(mesh):
        begun.set()
        threading.Event().wait(0.3)  # still at it when the fork is asked for
        return mesh

    monkeypatch.setattr(ray_mesh, 'RayMesh', build)
    mesh = Mesh('part.stl')
    future = ray_mesh.build_later([mesh])[mesh]
    begun.wait()
    child = os.fork()
    if not child:
        os._exit(0 if future.done() else 1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0


def test_bounds_of_a_mesh_are_about_the_middle_of_its_bounding_box(tmp_path):
    """Of a pyramid from 3 to 5 m above its origin, whose base is a square of 2 m."""
    corners = [(1, 1, 3), (-1, 1, 3), (-1, -1, 3), (1, -1, 3), (0, 0, 5)]
    faces = [(1, 2, 3), (1, 3, 4), (1, 2, 5), (2, 3, 5), (3, 4, 5), (4, 1, 5)]
    file = tmp_path / 'pyramid.obj'
    file.write_text(
        ''.join(f'v {x} {y} {z}\n' for x, y, z in corners)
        + ''.join(f'f {a} {b} {c}\n' for a, b, c in faces)
    )
    found = ray_mesh.RayMesh(Mesh(str(file)))
    assert (found.centre, found.half) == ((0.0, 0.0, 4.0), (1.0, 1.0, 1.0))
    assert found.radius == pytest.approx(math.sqrt(3.0))
