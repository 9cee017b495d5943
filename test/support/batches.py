"""Scenarios for tests of batches."""

import contextlib
import resource
import signal
from collections.abc import Iterator
from copy import deepcopy
from typing import Any

from rosbots_description.batch import run

# A ball that a force pushes along x from rest: x = F t^2 / 2 m.
MASS = 2.0  # [kg]
BALL = f"""<robot name="ball"><link name="ball"><inertial><mass value="{MASS}"/>
<inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><sphere radius="0.1"/></geometry></collision></link>
<gazebo><plugin name="push" filename="libgazebo_ros_force.so"><bodyName>ball</bodyName>
<topicName>push</topicName></plugin>
<plugin name="truth" filename="libgazebo_ros_p3d.so"><bodyName>ball</bodyName>
<topicName>truth</topicName><updateRate>10.0</updateRate></plugin></gazebo></robot>"""
FLOATING = """<sdf version="1.6"><world name="default"><gravity>0 0 0</gravity></world></sdf>"""


def pushed_ball(**changes: Any) -> dict[str, Any]:
    """Return a scenario of one second with the parameter `force` [N]; `changes` replace keys."""
    return deepcopy(
        {
            'duration': 1.0,
            'models': [{'name': 'ball', 'text': BALL, 'pose': {'z': 5.0}}],
            'commands': [{'at': 0.0, 'topic': '/push', 'message': {'force': {'x': '$force'}}}],
            'record': {'x': {'model': 'ball', 'value': 'pose.position.x'}},
            'conditions': ['x_end > 0.5'],
            'parameters': {'force': {'grid': [1.0, 3.0]}},
            **changes,
        }
    )


@contextlib.contextmanager
def full_disk(most: int) -> Iterator[None]:
    """Forbid files of more than `most` bytes, for the length of a `with` statement."""
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (most, limits[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        signal.signal(signal.SIGXFSZ, handler)


def only_row(scenario: dict[str, Any], **parameters: Any) -> dict[str, Any]:
    """Make the one run of a scenario in this process; return its row."""
    rows = run(scenario, parameters or {'force': 3.0}, workers=0).table.to_pylist()
    assert len(rows) == 1
    return dict(rows[0])
