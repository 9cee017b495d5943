"""The sensor in doc/howto_add_a_sensor.md runs and is lint-clean as printed."""

import pytest
from support.fake_engine import FakeEngine
from support.howto import import_printed, printed_modules
from support.programs import lint_faults

from rosbots_description.sim.core.transforms import Pose
from rosbots_description.sim.formats.sdf.sdf import load_sdf
from rosbots_description.sim.plugin_registry import registry
from rosbots_description.sim.resources.search_path import ModelSearch
from rosbots_description.sim.runtime.world import World

((PATH, SOURCE),) = printed_modules('howto_add_a_sensor.md').items()
MODEL = """<sdf version="1.6"><model name="m"><link name="a"><sensor name="high" type="altimeter">
  <pose>0 0 0.5 0 0 0</pose><update_rate>100</update_rate>
  <plugin name="p" filename="libgazebo_ros_altimeter.so"/></sensor></link></model></sdf>"""


def test_the_example_is_lint_clean():
    assert not lint_faults(SOURCE, f'src/{PATH}.py')


def test_the_example_measures_at_its_rate(monkeypatch, tmp_path):
    for table in ('_SENSORS', '_SENSOR_PLUGINS'):
        monkeypatch.setattr(registry, table, dict(getattr(registry, table)))
    import_printed(PATH, SOURCE, tmp_path, monkeypatch)
    world = World(make_engine=FakeEngine)
    described, _ = load_sdf(MODEL, 'bot', find_model=ModelSearch())
    model = world.spawn(described, 'bot', Pose((0.0, 0.0, 1.0)))
    heights = []
    model.plugin('altimeter').outputs['height'].connect(heights.append)
    world.run(35)
    assert heights == [pytest.approx(1.5)] * 3
    assert model.sensor('high').read() == pytest.approx(1.5)
