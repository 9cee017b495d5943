"""The services and topics of a real world, called in this process: no master, no connections."""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from io import BytesIO
from types import SimpleNamespace
from typing import Any

from genpy import Message

from rosbots_description.ros_api import services  # noqa: F401  registers
from rosbots_description.ros_api.server.server import Server
from rosbots_description.ros_api.services.registry import (
    EXTENSIONS,
    SERVICES,
    CallError,
    respond,
)
from rosbots_description.sim.core.transforms import Pose
from rosbots_description.sim.description.physics_settings import PhysicsSettings
from rosbots_description.sim.description.world_spec import LightSpec
from rosbots_description.sim.formats.sdf.sdf import load_sdf
from rosbots_description.sim.physics.bullet.engine import Engine
from rosbots_description.sim.physics.crash_sandbox import CrashSandbox
from rosbots_description.sim.runtime.world import World

from . import SPAWN_POSE, box_urdf, empty_world, package_directory, robot_spec, urdf_spec

BYSTANDER = 'bystander'
PLACE = Pose((50.0, 50.0, 1.5))  # where the bystander rests [m]
ALL = {**SERVICES, **EXTENSIONS}
BOX = f'<robot name="b">{box_urdf("1 1 1", 1.0)}</robot>'
DOOR = f"""<robot name="door"><link name="world"/><joint name="hinge" type="revolute">
  <parent link="world"/><child link="box"/><axis xyz="0 0 1"/>
  <limit lower="-1" upper="1" effort="5" velocity="1"/></joint>{box_urdf('1 0.1 1', 2.0)}</robot>"""
NESTED = """<sdf version="1.6"><model name="outer"><link name="base"/>
  <model name="inner"><pose>1 0 0 0 0 0</pose><link name="arm"/></model></model></sdf>"""
LAMP = '<sdf version="1.6"><light name="lamp" type="point"/></sdf>'
# Names that requests contain often.
NAMES = (
    'rosbots',
    'rosbots::base_footprint',
    'base_footprint',
    'wheel_left_link',
    'wheel_left_joint',
    'rosbots::wheel_right_joint',
    'base_link',
    'door',
    'door::box',
    'hinge',
    'outer',
    'inner',
    'outer::inner',
    'outer::inner::arm',
    'ground_plane',
    'ground_plane::link',
    'lamp',
    'world',
    'map',
    'new',
    'new::box',
)


class Bench:
    """A server whose loop is the calling thread; responses are serialized as for a connection."""

    def __init__(self, world: World) -> None:
        self.world = world
        registrar = SimpleNamespace(await_registration=lambda _name: None)
        loop = SimpleNamespace(
            **dict.fromkeys(('call', 'post', 'run_in_thread'), lambda command: command()),
            stopping=False,
        )
        self.server = Server(
            world, loop, registrar, package_directory, lambda _inner: None, _sandbox()
        )

    def call(self, name: str, request: Message) -> Any:
        """Return the response, or None if the call failed with an error message."""
        entry = ALL[name]
        try:
            response = respond(self.server, entry, request)
        except CallError as error:
            assert str(error)
            return None
        assert isinstance(response, entry.type._response_class)
        response.serialize(BytesIO())  # fails here as it would for a client
        if getattr(response, 'success', True) is False:
            assert response.status_message
        return response

    def names(self) -> list[str]:
        """Return the names of all models, in world order."""
        return list(self.world.models)


@cache
def _sandbox() -> CrashSandbox:
    """Return the crash sandbox, one for all tests of this process."""
    return CrashSandbox(Engine(PhysicsSettings()), Engine)


@contextmanager
def furnished_world() -> Iterator[World]:
    """Yield a world with one of everything, and a box far away that no request names."""
    with empty_world() as world:
        world.spawn(robot_spec(), 'rosbots', SPAWN_POSE)
        world.spawn(
            urdf_spec(DOOR.partition('>')[2].removesuffix('</robot>')),
            'door',
            Pose((10.0, 0.0, 1.0)),
        )
        spec, _ = load_sdf(NESTED, 'outer', find_model=lambda _: None)
        world.spawn(spec, 'outer', Pose((0.0, 10.0, 1.0)))
        static = '<gazebo><static>true</static></gazebo>'
        # also when the ground is deleted
        world.spawn(
            urdf_spec(box_urdf('2 2 1', 1.0, static)), 'pedestal', Pose((*PLACE.position[:2], 0.5))
        )
        world.spawn(urdf_spec(box_urdf('1 1 1', 1.0)), BYSTANDER, PLACE)
        world.lights['lamp'] = LightSpec('lamp')
        yield world
