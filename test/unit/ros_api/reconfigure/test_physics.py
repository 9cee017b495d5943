"""Physics settings by dynamic_reconfigure: what is applied to the world, and when."""

import threading
from types import SimpleNamespace

import pytest
from dynamic_reconfigure.encoding import Config

from rosbots_description.ros_api.reconfigure import physics as physics_reconfigure
from rosbots_description.ros_api.reconfigure.physics import PARAMETERS, PhysicsReconfigure
from rosbots_description.ros_api.server.loop import LoopError
from rosbots_description.sim.description.physics_settings import PhysicsSettings


class FakeServer:
    """A server with a world of settings, and a loop that can be busy."""

    def __init__(self):
        self.busy = False
        self.world = SimpleNamespace(
            physics=PhysicsSettings(), paused=False, set_physics=self._set_physics
        )
        self.loop = SimpleNamespace(call=self._call, stopping=False)
        self.changes = 0

    def physics_changed(self):
        self.changes += 1

    def _set_physics(self, physics):
        self.world.physics = physics

    def _call(self, command):
        if self.busy:
            raise LoopError('the simulator was busy')
        return command()


@pytest.fixture
def server():
    return FakeServer()


@pytest.fixture
def connect(monkeypatch):
    """Return a function that makes a PhysicsReconfigure without a ROS master."""

    def begin(self, _description, callback):
        self.mutex = threading.Lock()
        self.config = Config({p.name: p.default for p in PARAMETERS})
        self.config['groups'] = {}
        self.config = callback(self.config, -1)
        self.update_topic = SimpleNamespace(publish=lambda _: pytest.fail('no update expected'))

    monkeypatch.setattr(physics_reconfigure.ReconfigureServer, '__init__', begin)
    return PhysicsReconfigure


def _request(settings, **changes):
    """Change settings as the library does for a request with only these fields."""
    config = Config(dict(settings.config))
    config.update(changes)
    settings.config = settings._reconfigure(config, -1)
    return settings.config


def test_starts_with_the_settings_of_the_world(server, connect):
    settings = connect(server)
    assert settings.config['max_update_rate'] == 1000.0
    assert server.changes == 0


def test_only_requested_settings_are_applied(server, connect):
    settings = connect(server)
    server.world.physics = PhysicsSettings(erp=0.5)  # by a service, not shown yet
    shown = _request(settings, time_step=0.002)
    assert server.world.physics == PhysicsSettings(erp=0.5, step_size=0.002)
    assert (shown['time_step'], shown['erp']) == (0.002, 0.5)


def test_rejected_settings_are_not_shown(server, connect):
    settings = connect(server)
    assert _request(settings, time_step=0.0)['time_step'] == 0.001
    assert server.changes == 0


def test_busy_simulator_keeps_the_shown_settings(server, connect):
    settings = connect(server)
    before = Config(dict(settings.config))
    server.busy = True
    settings.publish_changes()
    assert settings.config == before
    assert _request(settings, time_step=0.002) == before


def test_defaults_shown_at_a_busy_start_are_not_applied(server, connect):
    server.busy = True
    settings = connect(server)
    server.busy = False
    shown = _request(settings, gravity_z=-1.0)
    assert server.world.physics == PhysicsSettings(gravity=(0.0, 0.0, -1.0))
    assert shown['max_update_rate'] == 1000.0
