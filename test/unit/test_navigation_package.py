"""rosbots_navigation: its numbers are those of the robot; its launch files name what is missing."""

import math
import re
import runpy
import socket
import sys
from types import SimpleNamespace
from xml.etree import ElementTree

import numpy as np
import pytest
import rospy
import yaml
from support import ROOT, robot_spec, robot_urdf
from support.programs import ran
from support.refusals import exit_code

from rosbots_description.sim.core import compose
from rosbots_description.sim.core.arrays import rotation_matrix
from rosbots_description.sim.description import Cylinder, Mesh, Sphere
from rosbots_description.sim.meshes import read_mesh

PACKAGE = ROOT / 'companions' / 'rosbots_navigation'
CENTIMETRE = 0.01  # [m] to which the footprint is rounded outward


def parameters(name):
    return yaml.safe_load((PACKAGE / 'config' / f'{name}.yaml').read_text(encoding='utf-8'))


MOVE_BASE, COSTMAP = parameters('move_base'), parameters('costmap')
PLANNER = MOVE_BASE['DWAPlannerROS']
ROBOT = ElementTree.fromstring(robot_urdf(one_tf_tree='true', laser='true'))  # of navigation.launch
DRIVE = {
    each.tag: each.text.strip()
    for each in ROBOT.find('.//plugin[@filename="libgazebo_ros_diff_drive.so"]')
}
RANGE = float(ROBOT.findtext('.//sensor[@type="ray"]//range/max'))  # [m] of the scanner


def points(geometry, pose):
    """Return points (n, 3) [m] whose bounds are those of a shape that has a pose."""
    match geometry:
        case Mesh(path, scale):
            local = np.concatenate([part.vertices for part in read_mesh(path).parts]) * scale
        case Sphere(radius):
            return np.array([pose.position]) + radius * np.vstack((np.eye(3), -np.eye(3)))
        case Cylinder(radius, length):
            angles = np.radians(np.arange(360.0))
            local = np.concatenate(
                [
                    np.column_stack(
                        (
                            radius * np.cos(angles),
                            radius * np.sin(angles),
                            np.full(360, end * length / 2),
                        )
                    )
                    for end in (-1, 1)
                ]
            )
    return local @ rotation_matrix(pose.orientation).T + pose.position


def test_footprint_is_the_rectangle_around_the_robot_to_the_next_centimetre():
    shapes = np.concatenate(
        [
            points(collision.geometry, compose(link.pose, collision.pose))
            for link in robot_spec().links
            for collision in link.collisions
        ]
    )
    low, high = shapes.min(axis=0)[:2], shapes.max(axis=0)[:2]
    corners = np.array(COSTMAP['footprint'])
    near = 1e-6  # [m], of numbers that are whole centimetres themselves
    assert corners.min(axis=0) == pytest.approx(np.floor((low + near) / CENTIMETRE) * CENTIMETRE)
    assert corners.max(axis=0) == pytest.approx(np.ceil((high - near) / CENTIMETRE) * CENTIMETRE)
    assert {tuple(corner) for corner in corners} == {
        (x, y) for x in corners[:, 0] for y in corners[:, 1]
    }


def test_robot_gains_speed_as_its_wheels_do():
    rim, separation = float(DRIVE['wheelAcceleration']), float(DRIVE['wheelSeparation'])
    assert PLANNER['acc_lim_x'] == rim
    assert PLANNER['acc_lim_theta'] == math.floor(10 * 2 * rim / separation) / 10
    assert (PLANNER['acc_lim_y'], PLANNER['max_vel_y'], PLANNER['min_vel_y']) == (0.0, 0.0, 0.0)


def test_robot_can_stop_within_what_the_local_costmap_shows():
    stop = PLANNER['max_vel_x'] ** 2 / (2 * PLANNER['acc_lim_x'])
    ahead = max(x for x, _ in COSTMAP['footprint'])
    seen = MOVE_BASE['local_costmap']['width'] / 2
    assert PLANNER['max_vel_x'] * PLANNER['sim_time'] + stop + ahead < seen


def test_ranges_are_within_that_of_the_scanner():
    scan, gmapping, amcl = COSTMAP['obstacle_layer']['scan'], *map(parameters, ('gmapping', 'amcl'))
    assert scan['obstacle_range'] < scan['raytrace_range'] < RANGE
    assert gmapping['maxUrange'] < gmapping['maxRange'] == RANGE
    assert amcl['laser_max_range'] == RANGE
    assert scan['inf_is_valid'] is True


def test_inflation_reaches_beyond_the_footprint():
    farthest = max(math.hypot(*corner) for corner in COSTMAP['footprint'])
    assert COSTMAP['inflation_layer']['inflation_radius'] > farthest


def test_frames_and_topics_are_those_of_the_drive_and_the_scanner():
    gmapping, amcl = parameters('gmapping'), parameters('amcl')
    assert {COSTMAP['robot_base_frame'], gmapping['base_frame'], amcl['base_frame_id']} == {
        DRIVE['robotBaseFrame']
    }
    assert {
        MOVE_BASE['local_costmap']['global_frame'],
        gmapping['odom_frame'],
        amcl['odom_frame_id'],
    } == {DRIVE['odometryFrame']}
    assert COSTMAP['obstacle_layer']['scan']['topic'] == ROBOT.findtext('.//topicName')
    text = (PACKAGE / 'launch/inc/move_base.launch.xml').read_text(encoding='utf-8')
    assert f'from="cmd_vel" to="{DRIVE["commandTopic"]}"' in text


def test_each_plugin_of_move_base_is_of_a_package_that_is_built():
    targets = yaml.safe_load((ROOT / 'tools/navigation/targets.yaml').read_text(encoding='utf-8'))
    layers = [
        layer['type']
        for costmap in ('global_costmap', 'local_costmap')
        for layer in MOVE_BASE[costmap]['plugins']
    ]
    planners = [MOVE_BASE['base_global_planner'], MOVE_BASE['base_local_planner']]
    assert {re.split('::|/', name)[0] for name in layers + planners} <= set(targets)
    for costmap in ('global_costmap', 'local_costmap'):
        names = {layer['name'] for layer in MOVE_BASE[costmap]['plugins']}
        assert names - {'static_layer'} == {'obstacle_layer', 'inflation_layer'} < set(COSTMAP)


@pytest.mark.parametrize(
    ('view', 'tools'),
    [
        ('mapping', {}),
        (
            'navigation',
            {'rviz/SetInitialPose': '/initialpose', 'rviz/SetGoal': '/move_base_simple/goal'},
        ),
    ],
)
def test_views_are_of_the_map_and_have_the_tools(view, tools):
    text = (PACKAGE / 'config' / f'{view}.rviz').read_text(encoding='utf-8')
    manager = yaml.safe_load(text)['Visualization Manager']
    assert manager['Global Options']['Fixed Frame'] == 'map'
    assert {tool['Class']: tool['Topic'] for tool in manager['Tools'] if 'Topic' in tool} == tools


def require(*names, path=''):
    environment = {'ROS_PACKAGE_PATH': str(path), 'PATH': '/usr/bin:/bin'}
    return ran(sys.executable, PACKAGE / 'launch' / 'require_packages', *names, env=environment)


@pytest.mark.parametrize(
    ('missing', 'named'),
    [
        (['amcl'], 'amcl'),
        (['amcl', 'move_base'], 'amcl and move_base'),
        (['map_server', 'amcl', 'move_base'], 'map_server, amcl and move_base'),
    ],
)
def test_missing_packages_are_named_with_the_command_that_builds_them(missing, named):
    done = require('rosbots_navigation', *missing, path=PACKAGE)
    assert (done.returncode, done.stdout) == (1, '')
    assert done.stderr == (
        f'rosbots_navigation needs {named}, which Debian lacks; to build what is '
        'missing, run: ./rosbots navigation\n'
    )


def test_versions_of_the_packages_are_printed():
    done = require('rosbots_navigation', path=PACKAGE)
    version = ElementTree.parse(PACKAGE / 'package.xml').findtext('version')
    assert (done.returncode, done.stdout) == (0, f'rosbots_navigation {version}\n'), done.stderr


def drive_to_goals(monkeypatch, *goals):
    """Return with which sentence the script ends."""
    script = str(PACKAGE / 'scripts' / 'drive_to_goals.py')
    monkeypatch.setattr(sys, 'argv', [script, *goals])
    return exit_code(runpy.run_path, script, run_name='__main__')


@pytest.mark.parametrize('words', [['1'], ['1,2,3,4'], ['1,x'], ['nan,1'], ['1,2', '']])
def test_goals_that_cannot_be_read_are_refused_in_one_sentence(monkeypatch, words):
    said = drive_to_goals(monkeypatch, *words)
    assert said == f'drive_to_goals.py: a goal is X,Y or X,Y,YAW, not {" ".join(words)}'


def test_drive_to_goals_says_in_a_sentence_that_there_is_no_master(monkeypatch, capsys):
    with socket.create_server(('localhost', 0)) as free:
        address = f'http://localhost:{free.getsockname()[1]}'
    monkeypatch.setenv('ROS_MASTER_URI', address)
    said = drive_to_goals(monkeypatch, '1,2')
    assert said == f'drive_to_goals.py: no ROS master answers at {address}'


@pytest.mark.parametrize(
    ('error', 'said'),
    [
        (rospy.ServiceException('unable to contact master'), 'unable to contact master'),
        (ConnectionRefusedError(111, 'Connection refused'), '[Errno 111] Connection refused'),
        (rospy.ROSInterruptException('shutdown'), 'stopped before the last goal'),
    ],
)
def test_drive_to_goals_says_in_a_sentence_that_the_master_has_died(monkeypatch, error, said):
    def fail(*_arguments, **_options):
        raise error

    monkeypatch.setattr('rosgraph.Master', lambda _name: SimpleNamespace(getUri=lambda: ''))
    monkeypatch.setattr(rospy, 'init_node', fail)
    assert drive_to_goals(monkeypatch, '1,2') == f'drive_to_goals.py: {said}'
