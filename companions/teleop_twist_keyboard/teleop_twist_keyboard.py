#!/usr/bin/env python3
"""Drive a robot from the keys of a terminal."""

import sys

from rosbots_simulator.cli.program import run
from rosbots_simulator.cli.teleop_twist_keyboard import main

sys.exit(run(main))
