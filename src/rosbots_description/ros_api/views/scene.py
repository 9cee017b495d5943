"""The scene for windows that draw it themselves, such as gzweb; no cost without subscribers.

Publishes:
    ~view/scene (std_msgs/String): models, lights and settings as JSON; all of them for a new
        subscriber, then those that changed, within `PERIOD`.
    ~view/motion (std_msgs/Float64MultiArray): the clock [s], and the poses of the links that moved,
        every `PERIOD`.
"""

import time
from itertools import count

import rospy
from std_msgs.msg import Float64MultiArray, String

from ...sim.core import Pose
from ...sim.description import (
    ModelSpec,
    SceneChange,
    ShownLink,
    ShownModel,
    ShownMotion,
    ShownSensor,
)
from ...sim.runtime import Link, Model, World
from ..messages import motion_message, scene_message
from ..server import Server
from .visuals import Viewers

PERIOD = 1.0 / 30.0  # between two updates [s, wall]


class ShownWorld:
    """What was published of a world, to find what has changed."""

    def __init__(self, world: World) -> None:
        self._world = world
        self._numbers = count()
        self._models: dict[str, tuple[Model, ModelSpec]] = {}
        self._links: dict[int, tuple[Link, Pose]] = {}  # with the pose as last published
        self._settings: object = None
        self.reset()

    def reset(self) -> None:
        """Publish everything next time."""
        self._models.clear()
        self._links.clear()
        self._settings = None

    def change(self) -> SceneChange | None:
        """Return what has changed since the last call; None for nothing."""
        world = self._world
        found = {name: (model, model.spec) for name, model in world.models.items()}
        settings = (dict(world.lights), world.scene, world.physics)
        if (found, settings) == (self._models, self._settings):
            return None
        reset = self._settings is None
        removed = tuple(name for name, seen in self._models.items() if found.get(name) != seen)
        gone = {self._models[name][0] for name in removed}
        self._links = {number: shown for number, shown in self._links.items()
                       if shown[0].model not in gone}
        added = tuple(self._shown(name, model) for name, (model, _) in found.items()
                      if self._models.get(name) != found[name])
        self._models, self._settings = found, settings
        return SceneChange(reset, added, removed, dict(world.lights), world.scene,
                           world.physics.step_size, world.physics.max_update_rate)

    def motion(self, real_time: float) -> ShownMotion:
        """Return the clock, and the links that moved since they were last published."""
        moved = {}
        for number, (link, shown) in self._links.items():
            pose = link.pose
            if pose != shown:
                moved[number] = pose
                self._links[number] = link, pose
        clock = self._world.clock
        return ShownMotion(clock.now, real_time, clock.steps, self._world.paused, moved)

    def _shown(self, name: str, model: Model) -> ShownModel:
        links = []
        for link in model.links.values():
            spec = link.spec
            sensors = (ShownSensor(one.name, one.type, one.pose) for one in spec.sensors)
            shown = ShownLink(next(self._numbers), link.name, link.pose, spec.visuals,
                              spec.collisions, spec.inertial, spec.gravity, tuple(sensors))
            self._links[shown.number] = link, shown.pose
            links.append(shown)
        joints = tuple(joint.spec for joint in model.joints.values())
        return ShownModel(name, tuple(links), joints, model.static, model.spec.links[0].pose)


def advertise_scene(server: Server) -> None:
    """Advertise the scene and update it in wall time, also while paused."""
    shown = ShownWorld(server.world)
    scene = rospy.Publisher('~view/scene', String, Viewers(server, shown), queue_size=100)
    motion = rospy.Publisher('~view/motion', Float64MultiArray, queue_size=1)
    started = time.monotonic()

    def show() -> None:
        if scene.get_num_connections() == 0:
            return
        change = shown.change()
        if change is not None:
            scene.publish(scene_message(change))
        if motion.get_num_connections() > 0:
            motion.publish(motion_message(shown.motion(time.monotonic() - started)))

    server.loop.every(PERIOD, show)
