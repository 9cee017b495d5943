#!/usr/bin/env python3
"""A reader of the tutorial with their own rosbots_description types what the README says."""

import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import unittest
from contextlib import contextmanager
from pathlib import Path

import debian_rviz
import readme
import rostest
from simulator import BOX, wait_until
from terminal import Terminal

sys.path.insert(0, str(readme.ROOT / 'test'))
from support.article_package import THEIR_LINK, write_article_package

STEP = 30.0  # [s, wall] in which a step shows what it is to show
BUILD = 400.0  # [s, wall] for a workspace, which takes 30 s of a machine that does nothing else
MOST_LINES = 39  # that a terminal may show from its start to Ctrl-C, but for blank ones
# Debian's robot_state_publisher says it every 10 s where it follows the wall clock: one line,
# however long the walk takes on a busy machine.
AGAIN = re.compile(r'Received JointState is .* seconds old')
RED = '\x1b[31m'
MOVED = 0.05  # [m]
SPAWNED = 'Spawn status: SpawnModel: Successfully spawned entity'
ONCE, EACH_TERMINAL, ANY_ROBOT = readme.code_blocks('In your own catkin workspace')
STEPS = readme.steps()
LINK, ENTER, MAKE = ONCE.splitlines(keepends=True)
MAKE_ONE = f'{MAKE.strip()} -DCATKIN_WHITELIST_PACKAGES=xacro\n'  # and see to all names before
FIND = 'rospack find rosbots_description; roslaunch --files rosbots_description spawn.launch'
LEFT_OUT = 'rosbots_description is yours, in {}; ours is left out'
# A clone whose programs and packages are there already, so that it need not fetch them.
SET_UP = f"""
ROOT=$PWD
source tools/setup.bash
find_workspace
mkdir -p "$WORKSPACE/devel"
touch "$WORKSPACE/devel/setup.bash"
ln -s "{readme.ROOT}/.ws/venv" "$WORKSPACE/venv"
link_packages
for part in packages python workspace; do mark_done $part "$(${{part}}_fingerprint)"; done
"""


class Newcomer:
    """Somebody with a home of their own, in which the clone is ~/rosbots, and a workspace."""

    def __init__(self):
        self.home = Path(tempfile.mkdtemp(prefix='newcomer_'))
        (self.home / 'rosbots').symlink_to(readme.ROOT)
        self.source = self.home / 'catkin_ws' / 'src'
        self.source.mkdir(parents=True)
        self.environment = {
            'HOME': str(self.home), 'PATH': '/usr/local/bin:/usr/bin:/bin', 'LANG': 'C.UTF-8',
            'ROS_MASTER_URI': os.environ['ROS_MASTER_URI'], 'ROS_HOSTNAME': 'localhost',
            # where ./rosbots has its workspace if the clone's path is an odd one
            'XDG_CACHE_HOME': os.environ.get('XDG_CACHE_HOME', os.path.expanduser('~/.cache')),
        }

    def type(self, script, limit=STEP, check=True):
        """Return what a shell shows that reads these lines and ends at the first that fails."""
        ended = subprocess.run(
            ['bash', '-ec', script], env=self.environment, cwd=self.home, stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, text=True, timeout=limit,
            check=False)
        if check and ended.returncode:
            raise AssertionError(f'{script!r} failed:\n{ended.stdout}')
        return ended.stdout

    def type_sourced(self, command):
        """Return what a command shows in a terminal that begins as the README says."""
        return self.type(EACH_TERMINAL + command)

    def leave(self):
        shutil.rmtree(self.home)


class Walk:
    """The terminals of a newcomer, each with one program in it; `shown` is what is in them."""

    def __init__(self, newcomer):
        self._newcomer = newcomer
        self._terminals = {}
        self.shown = {}

    def open(self, command):
        """Begin a terminal as the README says, and type a command."""
        self._terminals[command] = Terminal('bash', '-c', f'{EACH_TERMINAL}exec {command}',
                                            env=self._newcomer.environment)
        return command

    def keys(self, command, text):
        self._terminals[command].type(text)

    def runs(self, command):
        return self._terminals[command].process.poll() is None

    def wait(self, condition, what):
        """Wait, and look at all screens meanwhile, for a full one stops who writes to it."""
        def looked():
            self.shown |= {command: terminal.shown()
                           for command, terminal in self._terminals.items()}
            return condition()
        wait_until(looked, what, STEP)

    def see(self, command, text):
        self.wait(lambda: text in self.shown[command], f'{text!r} after {command}')

    def end(self, number=signal.SIGINT):
        """Press Ctrl-C in each terminal whose program still runs, the first one last."""
        for command, terminal in reversed(list(self._terminals.items())):
            if self.runs(command):
                os.killpg(terminal.process.pid, number)
            self.wait(lambda command=command: not self.runs(command), f'the end of {command}')

    def close(self, command):
        self._terminals.pop(command).close()

    def leave(self):
        self.end(signal.SIGTERM)
        for command in list(self._terminals):
            self.close(command)


def free_port():
    with socket.socket() as probe:
        probe.bind(('localhost', 0))
        return probe.getsockname()[1]


def count_lines(shown):
    """Return how many lines are on a screen; blank ones and repetitions of `AGAIN` do not count."""
    lines = [line for line in shown.splitlines() if line.strip()]
    again = sum(bool(AGAIN.search(line)) for line in lines)
    return len(lines) - max(0, again - 1)


@contextmanager
def screen():
    """Start an X server that nobody sees; its name goes to the block."""
    reader, writer = os.pipe()
    server = subprocess.Popen(['Xvfb', '-displayfd', str(writer), '-screen', '0', '1024x768x24'],
                              pass_fds=[writer], stderr=subprocess.DEVNULL)
    try:
        yield f':{os.read(reader, 16).decode().strip()}'
    finally:
        server.terminate()
        server.wait()
        os.close(reader)
        os.close(writer)


class OwnPackageTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.reader = Newcomer()
        cls.addClassCleanup(cls.reader.leave)
        cls.package = cls.reader.source / 'rosbots_description'
        write_article_package(cls.package)
        cls.said = cls.reader.type(ONCE, BUILD)

    def test_all_nine_steps(self):
        self.addCleanup(self.reader.environment.update, self.reader.environment.copy())
        walk = Walk(self.reader)
        with screen() as self.reader.environment['DISPLAY']:
            self.addCleanup(walk.leave)
            self._walk(walk)
            walk.end()
        for command, shown in walk.shown.items():
            self.assertNotIn(RED, shown, command)
            self.assertLessEqual(count_lines(shown), MOST_LINES, f'{command}:\n{shown[:6000]}')

    def _walk(self, walk):
        type_sourced = self.reader.type_sourced
        (spawn,), (delete,), (topics,) = STEPS[4], STEPS[6], STEPS[7]
        # 1: their package
        self.assertEqual(type_sourced(f'{STEPS[1][0]}; pwd').strip(), str(self.package))
        # 2: their robot in RViz, from `cat`
        port = free_port()
        self.reader.environment['ROS_MASTER_URI'] = f'http://localhost:{port}'
        walk.see(walk.open(f'{STEPS[2][0]} -p {port}'), 'started core service')
        view = self._open_rviz(walk)
        self.assertIn('/rviz', type_sourced('rostopic info /tf'))
        self.assertIn(THEIR_LINK, type_sourced('rosparam get /robot_description'))
        # 5: their robot, from xacro.py, waits for a simulator
        early = walk.open(spawn)
        walk.see(early, 'Waiting for service /gazebo/spawn_urdf_model')
        # 3: which comes with worlds and window
        walk.open(STEPS[3][0])
        walk.see(early, SPAWNED)
        self.assertIn(THEIR_LINK, type_sourced('rosparam get /robot_description'))
        walk.wait(lambda: '/gazebo_gui' in type_sourced('rosnode list'), 'the window')
        # 6: it goes
        self.assertIn('success: True', type_sourced(delete))
        self.assertNotIn('/part2_cmr/cmd_vel', type_sourced(topics).split())
        # 4 and 7: it comes again
        walk.see(walk.open(f'{spawn} x:=1'), SPAWNED)
        self.assertIn('/part2_cmr/cmd_vel', type_sourced(topics).split())
        # 8: it is driven
        start, teleop = self._x(), walk.open(STEPS[8][0])
        walk.see(teleop, 'currently:')
        walk.keys(teleop, 'i')
        walk.wait(lambda: self._x() > start + MOVED, 'the robot driving')
        walk.keys(teleop, '\x03')
        # any other robot: the world is there already
        (self.reader.home / 'my_robot.urdf').write_text(BOX, encoding='utf-8')
        self.assertIn(STEPS[3][0], ANY_ROBOT)
        self.assertIn(SPAWNED, type_sourced(ANY_ROBOT.splitlines()[1]))
        self.assertTrue(walk.runs(view), walk.shown[view])

    def _open_rviz(self, walk, starts=debian_rviz.STARTS):
        """Show their robot in RViz, before any program of ours runs."""
        view = walk.open(STEPS[2][1])
        walk.wait(lambda: self._rviz_stands() or not walk.runs(view), 'RViz')
        if walk.runs(view):
            return view
        walk.wait(lambda: debian_rviz.CRASH.search(walk.shown[view]),
                  f'a crash in {walk.shown[view]}')
        self.assertGreater(starts, 1, walk.shown[view])
        walk.close(view)
        return self._open_rviz(walk, starts - 1)

    def _rviz_stands(self):
        """Tell whether RViz answers to the first service that it opens after its window."""
        answer = self.reader.type_sourced(f'rosservice type {debian_rviz.STANDS} 2>&1 || true')
        return answer.startswith('std_srvs/')

    def _x(self):
        state = self.reader.type_sourced(
            "rosservice call /gazebo/get_model_state '{model_name: rosbots}'")
        return float(re.search(r'x: (\S+)', state)[1])

    def test_every_form_of_a_launch_file_expands_their_robot(self):
        for name, form in (('rviz', 'cat '), ('spawn', 'xacro.py '),
                           ('spawn_in_order', 'xacro --inorder ')):
            self.assertIn(form, (self.package / 'launch' / f'{name}.launch').read_text())
            shown = self.reader.type_sourced(
                f'roslaunch --dump-params rosbots_description {name}.launch')
            self.assertIn(THEIR_LINK, shown, name)

    def test_ours_is_left_out_where_they_have_a_package_of_that_name(self):
        self.assertIn(LEFT_OUT.format(self.package), self.said)
        self.assertFalse(self.package.is_symlink())
        before = sorted(self.reader.source.iterdir())
        self.assertIn('nothing new', self.reader.type(LINK, BUILD))
        self.assertEqual(sorted(self.reader.source.iterdir()), before)

    def test_their_package_wins_beside_ours_in_one_folder(self):
        newcomer = Newcomer()
        self.addCleanup(newcomer.leave)
        package = newcomer.source / 'rosbots_description'
        write_article_package(package)
        (newcomer.home / 'rosbots').unlink()
        clone = newcomer.source / 'rosbots'
        shutil.copytree(readme.ROOT, clone, symlinks=True,
                        ignore=shutil.ignore_patterns('.*', '__pycache__', 'demo_output'))
        newcomer.type(f'cd {clone}\n{SET_UP}')
        make = ENTER + MAKE.replace('$HOME/rosbots', str(clone))
        refused = newcomer.type(make, BUILD, check=False)
        self.assertIn('Multiple packages found with the same name', refused)
        link = LINK.replace('~/rosbots', str(clone))
        self.assertIn(LEFT_OUT.format(package), newcomer.type(link, BUILD))
        newcomer.type(make, BUILD)
        shown = newcomer.type_sourced(FIND)
        self.assertEqual(shown.split(), [str(package), f'{package}/launch/spawn.launch'])
        # and the clone still has its own
        shown = newcomer.type(f"cd {clone}; ./rosbots exec bash -c '{FIND}'")
        self.assertIn(f'{clone}/.ws/src/rosbots_description/launch/spawn.launch', shown)
        shutil.rmtree(package)
        newcomer.type(f'/usr/bin/python3 {clone}/tools/link.py {clone}/.ws/src ~/catkin_ws')
        self.assertFalse((clone / 'CATKIN_IGNORE').exists())

    def test_their_package_wins_below_a_workspace_with_ours(self):
        over = self.reader.home / 'over_theirs'
        (over / 'src').mkdir(parents=True)
        link = LINK.replace('catkin_ws', 'over_theirs')
        by_hand = 'cd ~/over_theirs; ln -sT ~/rosbots src/rosbots_description\n'
        refused = ' '.join(self.reader.type(
            EACH_TERMINAL + by_hand + MAKE, BUILD, check=False).split())
        self.assertIn(f'There is another rosbots_description in {self.package}', refused)
        self.assertIn(f'rosbots link {over}', refused)
        said = self.reader.type(EACH_TERMINAL + link, BUILD)
        self.assertIn(LEFT_OUT.format(self.package), said)
        shown = self.reader.type(
            f'{EACH_TERMINAL}cd ~/over_theirs\n{MAKE_ONE}source devel/setup.bash\n'
            f'{FIND}; rospack find xacro', BUILD)
        self.assertEqual(shown.split()[-3:], [
            str(self.package), f'{self.package}/launch/spawn.launch', str(over / 'src' / 'xacro')])

    def test_their_package_wins_when_ours_is_put_over_their_workspace(self):
        files = '~/rosbots/rosbots exec roslaunch --files rosbots_description spawn.launch'
        self.assertIn(str(self.package), self.reader.type_sourced(files))

    def test_their_package_wins_in_a_workspace_over_ours(self):
        over = self.reader.home / 'over'
        write_article_package(over / 'src' / 'rosbots_description')
        self.reader.type('~/rosbots/rosbots exec catkin_make -C ~/over', BUILD)
        shown = self.reader.type(
            'source ~/over/devel/setup.bash; rospack find rosbots_description;'
            'python3 -c "import rosbots_description; print(rosbots_description.__doc__)";'
            'rosrun gazebo_ros gzserver --iters 10 worlds/shapes.world')
        self.assertIn(str(over / 'src' / 'rosbots_description'), shown)
        self.assertIn('The reader has a Python module', shown)

    def test_the_finished_robot_is_found_and_stands(self):
        newcomer = Newcomer()
        self.addCleanup(newcomer.leave)
        newcomer.type(ONCE, BUILD)
        shown = newcomer.type_sourced(f'{STEPS[1][0]}; pwd -P')
        self.assertEqual(shown.strip(), str(readme.ROOT))
        walk = Walk(newcomer)
        self.addCleanup(walk.leave)
        simulation = walk.open('roslaunch rosbots_description simulation.launch gui:=false')
        walk.see(simulation, SPAWNED)


if __name__ == '__main__':
    rostest.rosrun('rosbots_description', 'own_package', OwnPackageTest, sys.argv)
