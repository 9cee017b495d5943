"""./rosbots demo spawns, drives and deletes the robot; it needs no workspace."""

import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

PNG = b'\x89PNG'
RATIOS = 0.86, 1.05  # of the commanded speed (straight) and rate (turn), at least
ENVIRONMENT = {name: os.environ[name] for name in ('HOME', 'PATH') if name in os.environ}


class Demo(unittest.TestCase):
    def test_robot_drives_and_is_drawn(self):
        with tempfile.TemporaryDirectory() as folder:
            shown = subprocess.run(
                [ROOT / 'rosbots', 'demo', '--output', folder],
                env=ENVIRONMENT,
                text=True,
                stdin=subprocess.DEVNULL,
                capture_output=True,
                check=False,
            )
            self.assertEqual((shown.returncode, shown.stderr), (0, ''), shown.stdout)
            numbers = {
                part: [float(number) for number in re.findall(r'-?\d+\.\d+', rest)]
                for part, rest in re.findall(
                    r'^(straight|turn|stop) +[\d.]+ s(.*)$', shown.stdout, re.M
                )
            }
            speed, _, *_, true_speed, _, _ = numbers['straight']
            self.assertGreater(true_speed, RATIOS[0] * speed)
            _, rate, *_, _, true_rate, _ = numbers['turn']
            self.assertGreater(true_rate, RATIOS[1] * rate)
            self.assertEqual(numbers['stop'][4:6], [0.0, 0.0])
            for picture in ('path.png', 'robot.png'):
                self.assertEqual(Path(folder, picture).read_bytes()[:4], PNG)
            log = Path(folder, 'simulator.log').read_text(encoding='utf-8')
            self.assertNotIn('/.ws/devel/', log)
            self.assertNotIn('Traceback', log)
