"""Front end of the executable run_scenario: one run of a scenario with the running simulator.

Under rostest it is a test, which passes if all conditions hold.
"""

from __future__ import annotations

import argparse
import importlib
import sys
import unittest
from collections.abc import Sequence

from .gzserver import split_remappings
from .program import fail

NAME = 'run_scenario'
USAGE = 2  # exit code


def parser() -> argparse.ArgumentParser:
    """Return the parser of the options."""
    made = argparse.ArgumentParser(
        prog=NAME, description='Make one run of a scenario with the running simulator.'
    )
    made.add_argument('scenario', metavar='SCENARIO.yaml', help='see doc/batch.md')
    made.add_argument(
        '--run', type=int, default=0, metavar='NUMBER', help='which of its runs; default: 0'
    )
    return made


def main(arguments: Sequence[str] | None = None) -> int:
    """Make the run; return the exit code.

    Returns:
        0 all conditions hold, 1 one does not or the run could not be made, 2 wrong usage; 0 under
        rostest, which reads the report.
    """
    given = list(sys.argv[1:] if arguments is None else arguments)
    own, remappings = split_remappings(given)
    test_flags = [one for one in own if one.startswith('--gtest_output') or one == '--text']
    options = parser().parse_args([one for one in own if one not in test_flags])
    from ..batch import PolicyError, ScenarioFile
    from ..ros_api.clients.scenario_run import run_scenario
    from ..ros_api.transport import AddressError, start_node
    from ..sim.core import SimError

    def fault() -> str:
        """Make the run, and print its row; return why it failed, or nothing."""
        try:
            row = run_scenario(file, options.run)
        except (SimError, PolicyError, AssertionError) as error:
            return str(error)
        for name, value in row.items():
            print(f'{name}: {value}')
        return ''

    class ScenarioTest(unittest.TestCase):
        """The run, as rostest takes it."""

        def test_conditions_hold(self) -> None:
            if sentence := fault():
                self.fail(sentence)

    try:
        file = ScenarioFile.read(options.scenario)
        if not 0 <= options.run < (runs := file.parameters.runs):
            return fail(NAME, f'there is no run {options.run}; it has {runs}, from 0', USAGE)
        start_node(NAME, remappings)
    except (SimError, AddressError) as error:
        return fail(NAME, str(error), USAGE)
    if test_flags:
        # By its name in a string: the tests have a folder of that name.
        importlib.import_module('rostest').rosrun(
            'rosbots_simulator', NAME, ScenarioTest, [sys.argv[0], *test_flags]
        )
        return 0
    sentence = fault()
    return fail(NAME, sentence) if sentence else 0
