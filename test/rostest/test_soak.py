#!/usr/bin/env python3
"""Half a minute of the soak test: no leaks, no unexpected responses."""

import subprocess
import sys
import unittest
from pathlib import Path

import rostest

SOAK = Path(__file__).resolve().parents[2] / 'benchmark' / 'soak.py'
SECONDS = 30.0
LIMIT = 800.0  # [s, wall] start and end included, on a busy machine


class SoakTest(unittest.TestCase):

    def test_half_a_minute_has_no_faults(self):
        ended = subprocess.run(
            [sys.executable, str(SOAK), '--seconds', str(SECONDS)], stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, text=True, timeout=LIMIT, check=False)
        print(ended.stdout)
        self.assertEqual(ended.returncode, 0, ended.stdout[-3000:])


if __name__ == '__main__':
    rostest.rosrun('rosbots_description', 'soak', SoakTest, sys.argv)
