"""The plugin in doc/howto_add_a_plugin.md runs and is lint-clean as printed."""

import math

import pytest
from std_msgs.msg import Float64
from support.fake_drive import fake_model, make_drive
from support.howto import import_printed, printed_modules
from support.programs import lint_faults
from support.wire import Wire

from rosbots_description.ros_api.adapters import registry as topics
from rosbots_description.sim.plugin_registry import registry as plugins

MOST_LINES = 60
BLOCKS = printed_modules('howto_add_a_plugin.md')


@pytest.fixture
def spinner(monkeypatch, tmp_path):
    """Load the modules of the page under their paths; return the plugin class."""
    monkeypatch.setattr(plugins, '_PLUGINS', dict(plugins._PLUGINS))
    monkeypatch.setattr(topics, '_TOPICS', dict(topics._TOPICS))
    for path, source in BLOCKS.items():
        import_printed(path, source, tmp_path, monkeypatch)
    return plugins.plugin_class('libgazebo_ros_spinner.so')


def test_the_example_is_short():
    assert len(BLOCKS) == 2
    assert sum(source.count('\n') for source in BLOCKS.values()) <= MOST_LINES


@pytest.mark.parametrize('path', BLOCKS)
def test_the_example_is_lint_clean(path):
    assert not lint_faults(BLOCKS[path], f'src/{path}.py')


def test_the_example_serves_its_topics(spinner, monkeypatch, caplog):
    wire = Wire(monkeypatch)
    plugin = make_drive(spinner, fake_model(), jointName='left', angleTopic='/angle', torque='2')
    wire.join(plugin)
    plugin.world.run(100)
    assert plugin.world.engine.steps == [100]  # only the watchdog is due
    wire.publishers['/angle'].read()
    wire.subscribers['/spin'](Float64(3.0))
    plugin.world.run(100)
    angles = [message.data for message in wire.publishers['/angle'].sent]
    assert angles == pytest.approx([3.0 * 0.001 * step for step in (1, 21, 41, 61, 81)])
    assert plugin.driven.motor == (3.0, 2.0)
    wire.subscribers['/spin'](Float64(math.nan))
    assert 'Spinner(ns = ): dropped a command on spin with data nan; numbers must' in caplog.text
    plugin.world.reset_simulation()
    assert plugin.driven.motor == (0.0, 2.0)
