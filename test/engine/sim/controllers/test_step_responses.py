"""Controllers of joints move an arm as they were recorded in Gazebo."""

import pytest
from support.controllers import RECORDED, aligned, sampled, spawn_arm

from rosbots_description.sim import World

RISE, OVERSHOOT, END = 0.03, 0.03, 0.01  # relative differences
HALF_ROW = 0.001  # [s] resolution of a rise in rows that are 10 ms apart

# Scene, number of the command, joint. A step on a stop is chaotic: it is not compared.
STEPS = [
    ('effort_pos', 0, 0),
    ('effort_pos', 1, 1),
    ('effort_pos', 2, 0),
    ('position', 0, 0),
    ('position', 1, 1),
    ('position_pid', 0, 0),
    ('position_pid', 1, 1),
]


def trace(name, steps):
    """Return the positions of both joints in each of some steps."""
    scene = RECORDED[name]
    rows = []
    with World.empty() as world:
        model, manager = spawn_arm(world, scene['hardware'][0], scene['pid_gains'])
        for controller, parameters in scene['controllers'].items():
            manager.load(controller, parameters['type'], parameters)
        manager.switch(list(scene['controllers']))
        sent = {round(1000.0 * time): (to, value) for time, to, value in scene['sent']}
        for step in range(steps):
            if step in sent:
                to, value = sent[step]
                model.controller(to).command(value)
            rows.append([step / 1000.0, *(joint.position for joint in model.joints.values())])
            world.step()
    return rows


class Step:
    """Rise time from 10 to 90 %, overshoot relative to the step, and the end of a response."""

    def __init__(self, times, positions):
        start, end = positions[0], positions[-1]
        way = [(position - start) / (end - start) for position in positions]
        low, high = (self._cross(times, way, level) for level in (0.1, 0.9))
        self.rise, self.overshoot, self.end = high - low, max(way) - 1.0, end
        self.size = abs(end - start)

    @staticmethod
    def _cross(times, way, level):
        i = next(i for i, value in enumerate(way) if value >= level)
        share = (level - way[i - 1]) / (way[i] - way[i - 1])
        return times[i - 1] + share * (times[i] - times[i - 1])


@pytest.fixture(scope='module')
def traces():
    """Return the traces here, by scene."""
    return {
        name: trace(name, round(1000.0 * RECORDED[name]['trace'][-1][0]))
        for name in {name for name, _, _ in STEPS} | {'velocity', 'velocity_pid', 'effort_vel'}
    }


def responses(traces, name, number, joint):
    """Return the recorded response to a command, and the one here in the same rows."""
    scene = RECORDED[name]
    begin = scene['sent'][number][0]
    later = [time for time, _, _ in scene['sent'] if time > begin]
    end = later[0] if later else scene['trace'][-1][0]
    rows = [row for row in scene['trace'] if begin <= row[0] <= end - 0.001]
    ours = traces[name]
    times, theirs = [row[0] for row in rows], [row[1 + joint] for row in rows]
    # The time at which the recorded command took effect is known to a row only.
    then = aligned(ours, list(zip(times, theirs, strict=True)), joint, begin)
    return Step(times, theirs), Step(times, [sampled(ours, time, joint) for time in then])


@pytest.mark.parametrize(('name', 'number', 'joint'), STEPS)
def test_rise_overshoot_and_end_of_a_step_are_as_recorded(name, number, joint, traces):
    recorded, ours = responses(traces, name, number, joint)
    assert ours.rise == pytest.approx(recorded.rise, rel=RISE, abs=HALF_ROW)
    assert ours.overshoot == pytest.approx(recorded.overshoot, abs=OVERSHOOT)
    assert ours.end == pytest.approx(recorded.end, abs=END * recorded.size)


@pytest.mark.parametrize(
    ('name', 'number', 'joint', 'after', 'until'),
    [
        ('velocity', 0, 0, 0.1, 1.9),
        ('velocity', 1, 1, 0.1, 0.9),
        ('velocity_pid', 0, 0, 0.1, 1.9),
        ('velocity_pid', 1, 1, 0.1, 0.9),
        ('effort_vel', 0, 0, 0.1, 0.6),
    ],
)
def test_commanded_velocities_are_as_recorded(name, number, joint, after, until, traces):
    sent = RECORDED[name]['sent'][number][0]
    recorded, ours = (
        sampled(rows, sent + until, joint) - sampled(rows, sent + after, joint)
        for rows in (RECORDED[name]['trace'], traces[name])
    )
    assert ours == pytest.approx(recorded, rel=END)


def test_a_pid_without_integral_gives_way_to_gravity_as_recorded(traces):
    """The README of the recordings: 0.54699 rad at the end, for a command of 0.5."""
    assert traces['effort_pos'][2150][1] == pytest.approx(0.54699, abs=1e-4)


def test_positions_without_gains_move_at_the_velocity_limit(traces):
    rows = traces['position']
    begin = round(1000.0 * RECORDED['position']['sent'][0][0])
    assert rows[begin + 40][1] - rows[begin + 10][1] == pytest.approx(0.030 * 10.0, abs=1e-4)


@pytest.mark.parametrize('name', ['position', 'velocity', 'position_pid', 'velocity_pid'])
def test_a_command_beyond_the_limit_stops_at_the_limit(name, traces):
    assert traces[name][-1][1] == pytest.approx(RECORDED[name]['trace'][-1][1], abs=1e-3)
