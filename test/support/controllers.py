"""The arm that was recorded under ros_control, here and as recorded."""

import json
from bisect import bisect_left

import pytest

from rosbots_description.sim.controllers import ControllerError

from .recorded import DATA

RECORDED = json.loads((DATA / 'controllers.json').read_text())
EFFORT, POSITION, VELOCITY = (
    f'hardware_interface/{kind}JointInterface' for kind in ('Effort', 'Position', 'Velocity')
)
_TEXT = (DATA / 'robots' / 'twolink.urdf').read_text()


def arm(interface=EFFORT, change=lambda text: text):
    """Return the URDF of the arm with joints of one interface."""
    return change(_TEXT.replace(EFFORT, interface))


def first_joint_only(text):
    """Return the URDF without the transmission of the second joint."""
    begin, end = text.index('<transmission name="joint2_trans">'), text.index('<gazebo>')
    return text[:begin] + text[end:]


def spawn_arm(world, interface=EFFORT, gains=None, change=lambda text: text, limits=None):
    """Spawn the arm; return it, and its controller manager."""
    model = world.spawn(arm(interface, change), name='arm')
    plugin = model.plugin('gazebo_ros_control')
    plugin.configure(
        parameters={'gazebo_ros_control': {'pid_gains': gains or {}}, 'joint_limits': limits or {}}
    )
    return model, plugin.manager


def sampled(rows, time, column):
    """Return a recorded quantity at a time, between two rows."""
    i = min(max(bisect_left(rows, [time]), 1), len(rows) - 1)
    (t0, *before), (t1, *after) = rows[i - 1], rows[i]
    share = (time - t0) / (t1 - t0)
    return before[column] + share * (after[column] - before[column])


def aligned(rows, recorded, column, begin):
    """Return the times of recorded values in `rows`, moved back by what fits best, at most 11 ms.

    Args:
        recorded: pairs of time and value of a column.
        begin: the least time [s].
    """

    def moved(shift):
        return [max(begin, time - shift / 1000.0) for time, _ in recorded]

    def difference(times):
        pairs = zip(recorded, times, strict=True)
        return sum(abs(value - sampled(rows, time, column)) for (_, value), time in pairs)

    return min(map(moved, range(12)), key=difference)


def refused(call, *arguments, **options):
    """Return the sentences of the error that a call raises."""
    with pytest.raises(ControllerError) as error:
        call(*arguments, **options)
    return error.value.sentences


def start_controller(model, name, kind, parameters):
    """Load and start a controller of a type; return it."""
    manager = model.plugin('gazebo_ros_control').manager
    manager.load(name, kind, parameters)
    manager.switch([name])
    return model.controller(name)
