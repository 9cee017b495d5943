"""The command gz, as people type it, acts on the running simulator."""

import os
import re
import subprocess
import tempfile
from functools import partial

from gazebo_msgs.srv import GetPhysicsProperties
from programs import ran
from rosbots_msgs.srv import SaveWorld
from simulator import GROUND, SimulatorTest, proxy

MODEL = """<sdf version="1.6"><model name="any"><link name="body">
  <collision name="c"><geometry><box><size>1 1 1</size></box></geometry></collision>
</link></model></sdf>"""


def run(*command, code=0, **options):
    """Return what a program prints, on the stream that fits its exit code."""
    ended = ran(*command, **options)
    if ended.returncode != code:
        raise AssertionError(f'{command} ended with {ended.returncode}: {ended.stderr}')
    return ended.stderr if code else ended.stdout


gz = partial(run, 'gz')


class GzTest(SimulatorTest):
    def test_a_model_is_spawned_moved_shown_and_deleted(self):
        self.pause()
        gz('model', '-s', '-m', 'crate', '-z', '0.5', input=MODEL)
        self.assertEqual(gz('model', '-l').split(), [GROUND, 'crate'])
        gz('model', '-m', 'crate', '-x', '-2e0', '-z', '1.5', '-Y', '0.25')
        self.assertEqual(gz('model', '-m', 'crate', '-p'), '-2 0 1.5 0 0 0.25\n')
        gz('model', '-m', 'crate', '-d')
        self.assertEqual(
            gz('model', '-m', 'crate', '-d', code=1),
            'gz model: DeleteModel: model does not exist\n',
        )

    def test_the_world_is_stepped_exactly_and_reset(self):
        gz('world', '-p', '1', '-r')
        self.assertEqual(self.world().sim_time, 0.0)
        gz('world', '-s', '-m', '24')
        self.assertEqual(self.world().sim_time, 0.025)
        gz('world', '-r')
        gz('world', '-p', '0')
        running = proxy('get_physics_properties', GetPhysicsProperties)
        self.assertFalse(running().pause)

    def test_stats_and_topics_are_those_of_the_simulator(self):
        with subprocess.Popen(['gz', 'stats'], stdout=subprocess.PIPE, text=True) as shown:
            lines = [shown.stdout.readline().rstrip('\n') for _ in range(3)]
            shown.terminate()
        for line in lines:
            self.assertRegex(
                line, r'^Factor\[\d+\.\d\d\] SimTime\[[\d.]+\] RealTime\[[\d.]+\] Paused\[F\]$'
            )
        times = [float(re.search(r'SimTime\[(.+?)\]', line)[1]) for line in lines]
        self.assertEqual(times, sorted(times))
        self.assertLessEqual({'/clock', '/gazebo/model_states'}, set(gz('topic', '-l').split()))

    def test_the_world_is_saved_where_the_user_says(self):
        self.pause()
        gz('model', '-s', '-m', 'crate', '-z', '0.5', input=MODEL)
        save = proxy('save_world', SaveWorld)
        answer = save('', False)
        self.assertTrue(answer.success, answer.status_message)
        self.assertIn('<model name="crate">', answer.sdf)
        refused = save('crate.world', False)
        self.assertEqual(
            (refused.success, refused.status_message.partition(';')[0]),
            (False, "SaveWorld: Failure - 'crate.world' is not an absolute path"),
        )
        with tempfile.TemporaryDirectory() as folder:
            run('rosrun', 'gazebo_ros', 'save_world', 'a.world', cwd=folder)
            for file, complaint in (
                ('a.world', 'it exists already'),
                ('a.txt', 'ends in .world or .sdf'),
            ):
                said = run('rosrun', 'gazebo_ros', 'save_world', file, cwd=folder, code=1)
                self.assertIn(complaint, said)
            self.assertEqual(os.listdir(folder), ['a.world'])
            with open(f'{folder}/a.world', encoding='utf-8') as file:
                self.assertEqual(file.read(), answer.sdf)

    def test_the_world_is_mapped_without_slam(self):
        self.pause()
        gz('model', '-s', '-m', 'crate', '-z', '0.5', '-x', '0.5', '-y', '0.5', input=MODEL)
        with tempfile.TemporaryDirectory() as folder:
            options = ('--resolution', '0.5', '--margin', '0.5', '--height', '0.3')
            run('rosrun', 'rosbots_simulator', 'save_map', 'crate', *options, cwd=folder)
            self.assertEqual(sorted(os.listdir(folder)), ['crate.pgm', 'crate.yaml'])
            with open(f'{folder}/crate.pgm', 'rb') as file:
                free, full = bytes([254] * 4), bytes([254, 0, 0, 254])
                self.assertEqual(file.read(), b'P5\n4 4\n255\n' + free + full + full + free)
