"""The URDF generated for PyBullet."""

from xml.etree import ElementTree

from support import robot_spec

from rosbots_description.sim.core.transforms import Pose
from rosbots_description.sim.physics.bullet.generated_urdf import describe_tree, kinematic_trees
from rosbots_description.sim.physics.bullet.shape_groups import surface_groups


def test_generated_urdf_has_no_visuals():
    (tree,) = kinematic_trees(robot_spec())
    count = len(tree.links)
    groups = [surface_groups(tree, i) for i in range(count)]
    text = describe_tree(tree, [Pose()] * count, groups, lambda mesh: mesh.path)
    touching = [link for link in ElementTree.fromstring(text).findall('link')
                if link.find('collision') is not None]
    assert touching
    for link in touching:
        (seen,) = link.findall('visual')
        assert [shape.tag for shape in seen.find('geometry')] == ['box']
