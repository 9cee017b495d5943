"""What the demo says of the window in the browser."""

import threading

import pytest

from rosbots_description.cli import demo


@pytest.mark.parametrize(
    'sentence',
    [
        'the world is at http://127.0.0.1:4711/',
        'no window: the Python package viser is not installed; pip install viser does that',
    ],
)
def test_the_first_line_of_gzweb_is_passed_on(tmp_path, sentence):
    log = tmp_path / 'log'
    log.write_text('started roslaunch server\n')
    writer = threading.Timer(
        0.1,
        log.write_text,
        (f'process[gzweb-3]: started\ngzweb: {sentence}\ngzweb: another line\n',),
    )
    writer.start()
    assert demo.window_line(log) == sentence
    writer.join()


def test_a_window_that_does_not_come_is_told(tmp_path):
    log = tmp_path / 'log'
    log.touch()
    assert demo.window_line(log, 0.0) == (
        f'there is no window in the browser after 0 s (see {log})'
    )
