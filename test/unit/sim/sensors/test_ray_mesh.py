"""Meshes for rays are built on a thread, which no fork is without."""

import os
import threading

from rosbots_description.sim.description import Mesh
from rosbots_description.sim.sensors import ray_mesh


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
