#!/usr/bin/env python3
"""The commands of the README work for readers with their own package rosbots_description."""

import os
import re
import shutil
import signal
import sys
import tempfile
import unittest
from pathlib import Path
from unittest.mock import patch

import debian_rviz
import readme
import rosnode
import rospy
import rostest
from gazebo_msgs.srv import GetModelState
from programs import ran_merged
from simulator import BOX, free_port, proxy, wait_until
from terminal import Terminal, open_display

sys.path.insert(0, str(readme.ROOT / 'test'))
from support.article_package import THEIR_LINK, write_article_package

STEP = 90.0  # [s, wall] timeout of the output of a step
BUILD = 400.0  # [s, wall] timeout of a build that takes 30 s on an idle machine
MOST_LINES = 39  # limit of non-blank lines in a terminal
# Debian's robot_state_publisher repeats it every 10 s of wall time: counted as one line,
# however long the test takes on a busy machine.
AGAIN = re.compile(r'Received JointState is .* seconds old')
RED = '\x1b[31m'
MOVED = 0.05  # [m]
SPAWNED = 'Spawn status: SpawnModel: Successfully spawned entity'
ONCE, EACH_TERMINAL, ANY_ROBOT = readme.code_blocks('In your own catkin workspace')
STEPS = readme.steps()
LINK, ENTER, MAKE = ONCE.splitlines(keepends=True)
FEW = '-DCATKIN_WHITELIST_PACKAGES="xacro;rosbots_simulator"\n'  # cmake has seen all packages
FIND = 'rospack find rosbots_description; roslaunch --files rosbots_description spawn.launch'
LEFT_OUT = 'rosbots_description is yours, in {}; ours is left out'
# A clone with installed dependencies, which it does not download again.
SET_UP = f"""
ROOT=$PWD
source tools/setup.bash
find_workspace
choose_sets base
mkdir -p "$WORKSPACE/devel"
touch -d @0 "$WORKSPACE/devel/setup.bash"  # CMake replaces no file of the same second
ln -s "{readme.ROOT}/.ws/venv" "$WORKSPACE/venv"
link_packages
for part in packages python; do mark_all_done $part "$(${{part}}_fingerprint)"; done
mark_done workspace "$(workspace_fingerprint)"
"""


class Newcomer:
    """A user with a new home folder, a clone in ~/rosbots, and a workspace."""

    def __init__(self):
        self.home = Path(tempfile.mkdtemp(prefix='newcomer_'))
        (self.home / 'rosbots').symlink_to(readme.ROOT)
        self.source = self.home / 'catkin_ws' / 'src'
        self.source.mkdir(parents=True)
        debian_rviz.draw_seldom(self.home / debian_rviz.SAVED)
        self.environment = {
            'HOME': str(self.home),
            'PATH': '/usr/local/bin:/usr/bin:/bin',
            'LANG': 'C.UTF-8',
            'ROS_MASTER_URI': os.environ['ROS_MASTER_URI'],
            'ROS_HOSTNAME': 'localhost',
            # catkin_make's own -l makes a build wait while other tests keep the machine busy
            'ROS_PARALLEL_JOBS': f'-j{os.cpu_count()}',
            # nobody looks at what other languages get here; ./rosbots setup builds that for C++
            'ROS_LANG_DISABLE': 'gencpp:geneus:genlisp',
            # the workspace of ./rosbots if the path of the clone is not plain
            'XDG_CACHE_HOME': os.environ.get('XDG_CACHE_HOME', os.path.expanduser('~/.cache')),
        }

    def type(self, script, limit=STEP, check=True):
        """Return the output of a shell that runs these lines up to the first failure."""
        command = ('bash', '-ec', script)
        ended = ran_merged(*command, env=self.environment, cwd=self.home, timeout=limit)
        if check and ended.returncode:
            raise AssertionError(f'{script!r} failed:\n{ended.stdout}')
        return ended.stdout

    def type_sourced(self, command):
        """Return the output of a command in a terminal set up as in the README."""
        return self.type(EACH_TERMINAL + command)

    def leave(self):
        shutil.rmtree(self.home)


class Walk:
    """The terminals of a user by their commands, each with one program."""

    def __init__(self, newcomer):
        self._newcomer = newcomer
        self._terminals = {}

    def open(self, command):
        """Open a terminal as in the README, and type a command."""
        self._terminals[command] = Terminal(
            'bash', '-c', f'{EACH_TERMINAL}exec {command}', env=self._newcomer.environment
        )
        return command

    def commands(self):
        return list(self._terminals)

    def keys(self, command, text):
        self._terminals[command].type(text)

    def runs(self, command):
        return self._terminals[command].process.poll() is None

    def shown(self, command):
        return self._terminals[command].shown()

    def see(self, command, text):
        wait_until(lambda: text in self.shown(command), f'{text!r} after {command}', STEP)

    def end(self, number=signal.SIGINT):
        """Press Ctrl-C in each terminal whose program still runs, the first one last."""
        for terminal in reversed(list(self._terminals.values())):
            terminal.end(number)

    def close(self, command):
        self._terminals.pop(command).close()

    def leave(self):
        self.end(signal.SIGTERM)
        for command in self.commands():
            self.close(command)


def count_lines(shown):
    """Return the number of lines, without blank ones and repetitions of `AGAIN`."""
    lines = [line for line in shown.splitlines() if line.strip()]
    again = sum(bool(AGAIN.search(line)) for line in lines)
    return len(lines) - max(0, again - 1)


class OwnPackageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.reader = Newcomer()
        cls.addClassCleanup(cls.reader.leave)
        cls.package = cls.reader.source / 'rosbots_description'
        write_article_package(cls.package)
        cls.link_output = cls.reader.type(ONCE, BUILD)

    def test_all_nine_steps(self):
        self.addCleanup(self.reader.environment.update, self.reader.environment.copy())
        self.addCleanup(open_display())
        self.reader.environment['DISPLAY'] = os.environ['DISPLAY']
        walk = Walk(self.reader)
        self.addCleanup(walk.leave)
        self._walk(walk)
        walk.end()
        for command in walk.commands():
            shown = walk.shown(command)
            self.assertNotIn(RED, debian_rviz.CRASH.sub('', shown), command)
            self.assertLessEqual(count_lines(shown), MOST_LINES, f'{command}:\n{shown[:6000]}')

    def _walk(self, walk):
        type_sourced = self.reader.type_sourced
        (spawn,), (delete,), (topics,) = STEPS[4], STEPS[6], STEPS[7]
        # 1: the user's package
        self.assertEqual(type_sourced(f'{STEPS[1][0]}; pwd').strip(), str(self.package))
        # 2: the user's robot in RViz, from `cat`
        port = free_port()
        master = {'ROS_MASTER_URI': f'http://localhost:{port}'}
        self.reader.environment.update(master)
        self.enterContext(patch.dict(os.environ, master))  # of this process as well
        walk.see(walk.open(f'{STEPS[2][0]} -p {port}'), 'started core service')
        view = self._open_rviz(walk)
        self.assertIn(THEIR_LINK, rospy.get_param('/robot_description'))
        # 5: the spawn of the user's robot, from xacro.py, waits for a simulator
        early = walk.open(spawn)
        walk.see(early, 'Waiting for service /gazebo/spawn_urdf_model')
        # 3: the simulator, with world and window
        walk.open(STEPS[3][0])
        walk.see(early, SPAWNED)
        self.assertIn(THEIR_LINK, rospy.get_param('/robot_description'))
        wait_until(lambda: '/gazebo_gui' in rosnode.get_node_names(), 'the window', STEP)
        # 6: the robot is deleted
        self.assertIn('success: True', type_sourced(delete))
        self.assertNotIn('/part2_cmr/cmd_vel', type_sourced(topics).split())
        # 4 and 7: it is spawned again
        walk.see(walk.open(f'{spawn} x:=1'), SPAWNED)
        self.assertIn('/part2_cmr/cmd_vel', type_sourced(topics).split())
        # 8: it is driven
        # With the key held, however slow the machine is.
        state = proxy('get_model_state', GetModelState)
        start = state('rosbots', '').pose.position.x
        teleop = walk.open(f'{STEPS[8][0]} _key_timeout:=0')
        walk.see(teleop, 'currently:')
        walk.keys(teleop, 'i')
        wait_until(
            lambda: state('rosbots', '').pose.position.x > start + MOVED,
            'motion of the robot',
            STEP,
        )
        walk.keys(teleop, '\x03')
        # any other robot: the simulator is running
        (self.reader.home / 'my_robot.urdf').write_text(BOX, encoding='utf-8')
        self.assertIn(STEPS[3][0], ANY_ROBOT)
        self.assertIn(SPAWNED, type_sourced(ANY_ROBOT.splitlines()[1]))
        if not walk.runs(view):
            self.assertRegex(walk.shown(view), debian_rviz.CRASH)

    def _open_rviz(self, walk, starts=debian_rviz.STARTS):
        """Show the user's robot in RViz, before any program of ours runs."""
        view = walk.open(STEPS[2][1])
        wait_until(lambda: debian_rviz.is_ready() or not walk.runs(view), 'RViz', STEP)
        if walk.runs(view):
            return view
        self.assertRegex(walk.shown(view), debian_rviz.CRASH)
        self.assertGreater(starts, 1, walk.shown(view))
        walk.close(view)
        return self._open_rviz(walk, starts - 1)

    def test_every_form_of_a_launch_file_expands_the_users_robot(self):
        for name, form in (
            ('rviz', 'cat '),
            ('spawn', 'xacro.py '),
            ('spawn_in_order', 'xacro --inorder '),
        ):
            self.assertIn(form, (self.package / 'launch' / f'{name}.launch').read_text())
            shown = self.reader.type_sourced(
                f'roslaunch --dump-params rosbots_description {name}.launch'
            )
            self.assertIn(THEIR_LINK, shown, name)

    def test_our_package_is_left_out_if_the_user_has_one_of_that_name(self):
        self.assertIn(LEFT_OUT.format(self.package), self.link_output)
        self.assertFalse(self.package.is_symlink())
        before = sorted(self.reader.source.iterdir())
        self.assertIn('nothing new', self.reader.type(LINK, BUILD))
        self.assertEqual(sorted(self.reader.source.iterdir()), before)

    def test_users_package_takes_precedence_beside_ours_in_one_folder(self):
        newcomer = Newcomer()
        self.addCleanup(newcomer.leave)
        package = newcomer.source / 'rosbots_description'
        write_article_package(package)
        (newcomer.home / 'rosbots').unlink()
        clone = newcomer.source / 'rosbots'
        shutil.copytree(
            readme.ROOT,
            clone,
            symlinks=True,
            ignore=shutil.ignore_patterns('.*', '__pycache__', 'demo_output'),
        )
        for companion in (clone / 'companions').iterdir():
            if companion.name not in FEW:  # cmake would look at each of them, twice
                shutil.rmtree(companion)
        newcomer.type(f'cd {clone}\n{SET_UP}')
        make = ENTER + MAKE.replace('$HOME/rosbots', str(clone))
        refused = newcomer.type(make, BUILD, check=False)
        self.assertIn('Multiple packages found with the same name', refused)
        link = LINK.replace('~/rosbots', str(clone))
        self.assertIn(LEFT_OUT.format(package), newcomer.type(link, BUILD))
        newcomer.type(f'{make.strip()} {FEW}', BUILD)
        shown = newcomer.type_sourced(FIND)
        self.assertEqual(shown.split(), [str(package), f'{package}/launch/spawn.launch'])
        # the clone still finds ours
        shown = newcomer.type(f"cd {clone}; ./rosbots exec bash -c '{FIND}'")
        self.assertIn(f'{clone}/.ws/src/rosbots_description/launch/spawn.launch', shown)
        shutil.rmtree(package)
        newcomer.type(f'/usr/bin/python3 {clone}/tools/link.py {clone}/.ws/src ~/catkin_ws')
        self.assertFalse((clone / 'CATKIN_IGNORE').exists())

    def test_users_package_takes_precedence_below_a_workspace_with_ours(self):
        over = self.reader.home / 'over_theirs'
        (over / 'src').mkdir(parents=True)
        link = LINK.replace('catkin_ws', 'over_theirs')
        by_hand = 'cd ~/over_theirs; ln -sT ~/rosbots src/rosbots_description\n'
        refused = ' '.join(
            self.reader.type(EACH_TERMINAL + by_hand + MAKE, BUILD, check=False).split()
        )
        self.assertIn(f'There is another rosbots_description in {self.package}', refused)
        self.assertIn(f'rosbots link {over}', refused)
        shown_text = self.reader.type(EACH_TERMINAL + link, BUILD)
        self.assertIn(LEFT_OUT.format(self.package), shown_text)
        shown = self.reader.type(
            f'{EACH_TERMINAL}cd ~/over_theirs\n{MAKE.strip()} {FEW}source devel/setup.bash\n'
            f'{FIND}; rospack find xacro',
            BUILD,
        )
        self.assertEqual(
            shown.split()[-3:],
            [str(self.package), f'{self.package}/launch/spawn.launch', str(over / 'src' / 'xacro')],
        )

    def test_users_package_takes_precedence_when_ours_overlays_its_workspace(self):
        files = '~/rosbots/rosbots exec roslaunch --files rosbots_description spawn.launch'
        self.assertIn(str(self.package), self.reader.type_sourced(files))

    def test_users_package_takes_precedence_in_a_workspace_over_ours(self):
        over = self.reader.home / 'over'
        write_article_package(over / 'src' / 'rosbots_description')
        self.reader.type('~/rosbots/rosbots exec catkin_make -C ~/over', BUILD)
        shown = self.reader.type(
            'source ~/over/devel/setup.bash; rospack find rosbots_description;'
            'python3 -c "import rosbots_description; print(rosbots_description.__doc__)";'
            'rosrun gazebo_ros gzserver --iters 10 worlds/shapes.world'
        )
        self.assertIn(str(over / 'src' / 'rosbots_description'), shown)
        self.assertIn('The reader has a Python module', shown)

    def test_z_robot_is_found_and_stands_in_a_workspace_without_a_package_of_theirs(self):
        shutil.rmtree(self.package)
        self.reader.type(ONCE, BUILD)
        shown = self.reader.type_sourced(f'{STEPS[1][0]}; pwd -P')
        self.assertEqual(shown.strip(), str(readme.ROOT))
        walk = Walk(self.reader)
        self.addCleanup(walk.leave)
        simulation = walk.open('roslaunch rosbots_description simulation.launch gui:=false')
        walk.see(simulation, SPAWNED)


if __name__ == '__main__':
    rostest.rosrun('rosbots_description', 'own_package', OwnPackageTest, sys.argv)
