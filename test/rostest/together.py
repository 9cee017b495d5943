#!/usr/bin/env python3
"""Runs the tests of several files, one after the other, with what a .test file starts.

rostest starts all of that anew for each <test>, the master, too; so one <test> names the files of
tests as its arguments. A name of no file is an error of the tests.
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
