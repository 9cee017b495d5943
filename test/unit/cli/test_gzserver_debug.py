"""gzserver with stacks of its threads."""

import faulthandler
import signal
from unittest.mock import Mock

from rosbots_description.cli import gzserver, gzserver_debug


def test_a_crash_and_a_signal_show_stacks_of_the_server(monkeypatch):
    for place, name in (
        (faulthandler, 'enable'),
        (faulthandler, 'register'),
        (gzserver, 'main'),
    ):
        monkeypatch.setattr(place, name, Mock(return_value=3))
    assert gzserver_debug.main(['my.world']) == 3
    faulthandler.enable.assert_called_once_with()
    faulthandler.register.assert_called_once_with(signal.SIGUSR1)
    gzserver.main.assert_called_once_with(['my.world'])
