#!/usr/bin/env python3
"""Runs the tests of several files, one after the other, with one simulator.

rostest starts everything anew for each <test>; so one <test> names these files as its arguments.
"""

import sys
from pathlib import Path
from unittest import TestSuite, defaultTestLoader

import rospy
import rostest


def suite() -> TestSuite:
    """Return the tests of the files that the command line names."""
    files = [word for word in rospy.myargv()[1:] if word.endswith('.py')]
    return defaultTestLoader.loadTestsFromNames([Path(file).stem for file in files])


if __name__ == '__main__':
    rospy.init_node('together', disable_rostime=True)
    rostest.rosrun('rosbots_description', 'together', '__main__.suite', sys.argv)
