"""Readings of sensors as a window shows them."""

from rosbots_description.sim.sensors import shown_reading
from rosbots_description.sim.sensors.contact import ContactPair, ContactPoint, ContactSensor

NONE = (0.0, 0.0, 0.0)


def test_contacts_of_the_last_step_are_shown():
    """A reading has those of all steps since the one before."""
    pairs = tuple(
        ContactPair('ball', 'floor', time, (ContactPoint((0, 0, force), NONE, (x, 0, 0), NONE, 0),))
        for time, force, x in ((1, 7.0, 1.0), (2, 9.0, 2.0))
    )
    shown = shown_reading(object.__new__(ContactSensor), pairs, 'link')
    assert shown.points.tolist() == [[2.0, 0.0, 0.0]]
    assert shown.words == 'ball and floor: 9.00 N'
