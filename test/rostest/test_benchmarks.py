"""A part of the benchmark that is interrupted ends its master, server and clients."""

import os
import signal
import subprocess
import sys
import unittest
from pathlib import Path

from simulator import DEADLINE, wait_until

from rosbots_description.cli.launched import descendants

ROOT = Path(__file__).resolve().parents[2]


def name_of(pid):
    try:
        return Path(f'/proc/{pid}/comm').read_text().strip()
    except OSError:
        return ''


class BenchmarksTest(unittest.TestCase):
    def test_sigterm_ends_all_processes_of_the_soak_test(self):
        path = os.pathsep.join([str(ROOT / 'test'), os.environ['PYTHONPATH']])
        process = subprocess.Popen(
            [sys.executable, ROOT / 'benchmark' / 'run.py', 'soak', '--seconds', '600'],
            env=os.environ | {'PYTHONPATH': path},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self.addCleanup(process.kill)
        self.assertEqual(process.stdout.readline(), '== soak, about 26 min\n')
        wait_until(
            lambda: 'gzserver' in map(name_of, descendants(process.pid)),
            'a simulator',
            2 * DEADLINE,
        )
        family = descendants(process.pid)
        process.send_signal(signal.SIGTERM)
        printed, _ = process.communicate(timeout=DEADLINE)
        self.assertEqual(process.returncode, 128 + signal.SIGTERM, printed)
        self.assertEqual([name_of(pid) for pid in family if name_of(pid)], [])
