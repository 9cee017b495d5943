"""Commands to the clock of a simulator, as services."""

import threading

from rosbots_description.ros_api.window import time_control
from rosbots_description.ros_api.window.time_control import RosTimeControl


def test_steps_follow_each_other(monkeypatch):
    """The simulator refuses steps while it makes others."""
    called, began, may_end = [], threading.Event(), threading.Event()

    def call(name, *_, **arguments):
        called.append((name, *arguments.values()))
        if name == 'step':
            began.set()
            assert may_end.wait(60.0)

    monkeypatch.setattr(time_control, 'call', call)
    time = RosTimeControl()
    presses = [threading.Thread(target=time.step, args=(steps,)) for steps in (1, 2)]
    presses[0].start()
    assert began.wait(60.0)
    presses[1].start()
    presses[1].join(0.2)  # it can only wait
    assert called == [('pause_physics',), ('step', 1)]
    may_end.set()
    for press in presses:
        press.join()
    assert called[2:] == [('pause_physics',), ('step', 2)]
