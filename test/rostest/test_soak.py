#!/usr/bin/env python3
"""Six seconds of the soak test, and eight spawns of its second part: no leaks, no faults."""

import os
import sys
import unittest
from pathlib import Path

import rostest
from programs import ran_merged

TESTS = Path(__file__).resolve().parents[1]  # has support/, with a browser for the page
SOAK = Path(__file__).resolve().parents[2] / 'benchmark' / 'soak.py'
SECONDS = 6.0
LIMIT = 800.0  # [s, wall] start and end included, on a busy machine


class SoakTest(unittest.TestCase):
    def test_six_seconds_have_no_faults(self):
        environment = os.environ | {'PYTHONPATH': f'{TESTS}:{os.environ.get("PYTHONPATH", "")}'}
        command = (sys.executable, str(SOAK), '--seconds', str(SECONDS))
        ended = ran_merged(*command, timeout=LIMIT, env=environment)
        print(ended.stdout)
        self.assertEqual(ended.returncode, 0, ended.stdout[-3000:])


if __name__ == '__main__':
    rostest.rosrun('rosbots_description', 'soak', SoakTest, sys.argv)
