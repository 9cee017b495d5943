"""However PyBullet was built, it moves alike bit for bit."""

import platform

import pytest
from support.bullet_bits import bits

from rosbots_description.sim.physics.bullet.client import pybullet

# Of PyPI's wheel for CPython 3.11, and of builds from the sources on Debian 12 and 13.
EXPECTED = '5133c3f1d36116133cab022919c73bd34efe786e6f0794fad02b558a440fa442'


@pytest.mark.skipif(platform.machine() != 'x86_64', reason='was recorded on x86-64 only')
def test_scene_moves_as_with_the_wheel_of_pypi():
    assert bits(pybullet) == EXPECTED
