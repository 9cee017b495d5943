"""Rays hit the shapes of a world at their described surfaces."""

import math

import pytest
from support.fake_engine import FakeEngine

from rosbots_description.sim.core.transforms import Pose, from_rpy
from rosbots_description.sim.formats.sdf.sdf import load_sdf
from rosbots_description.sim.resources.search_path import ModelSearch
from rosbots_description.sim.runtime.world import World
from rosbots_description.sim.sensors.rays.fan import RayFan, Sweep
from rosbots_description.sim.sensors.rays.scene import RayScene

MODEL = """<sdf version="1.6"><model name="m"><link name="l"><collision name="c"><geometry>{}
</geometry></collision></link></model></sdf>"""
RAY = Sweep(1, 1, 0.0, 0.0)


@pytest.mark.parametrize(
    ('shape', 'top', 'side'),
    [
        ('<box><size>0.6 0.4 3</size></box>', 1.5, 0.3),
        ('<cylinder><radius>0.3</radius><length>3</length></cylinder>', 1.5, 0.3),
        ('<sphere><radius>0.7</radius></sphere>', 0.7, 0.7),
    ],
)
def test_ray_from_above_hits_the_top_and_a_level_ray_the_side(shape, top, side):
    world = World(make_engine=FakeEngine)
    model, _ = load_sdf(MODEL.format(shape), 'm', find_model=ModelSearch())
    world.spawn(model, 'm', Pose((0.0, 0.0, 0.0)))
    scene, fan = RayScene.of(world), RayFan.of(RAY, RAY)
    down = Pose((0.0, 0.0, 8.0), from_rpy(0.0, math.pi / 2, 0.0))
    assert scene.cast(down, fan, 0.1, 9.0)[0] == pytest.approx([8.0 - top])
    assert scene.cast(Pose((-8.0, 0.0, 0.0)), fan, 0.1, 9.0)[0] == pytest.approx([8.0 - side])
