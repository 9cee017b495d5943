"""A world on the page, without ROS: what the page commands is done by the owner of the world."""

import threading
from contextlib import contextmanager

import pytest
from support import box_urdf
from support.browser import Browser
from support.cars import transmission
from support.crashing import CRASHING, crash
from support.patience import PATIENCE, wait_until
from support.window import Shown

from rosbots_description.sim import Pose, SimError, Twist, World
from rosbots_description.sim.description import CommandTopic, ModelText
from rosbots_description.sim.physics.bullet.engine import Engine
from rosbots_description.viewer import Viewer, open_sandbox, scene
from rosbots_description.web import Site

ROBOT = 'package://rosbots_description/urdf/rosbots.xacro'
ARM = f"""
<robot name="arm">
  <link name="world"/>
  <link name="upper">
    <inertial><origin xyz="0 0 0.2"/><mass value="1"/>
      <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><box size="0.1 0.1 0.4"/></geometry></visual>
  </link>
  <joint name="shoulder" type="revolute">
    <parent link="world"/><child link="upper"/><axis xyz="0 1 0"/>
    <limit lower="-2" upper="2" effort="50" velocity="3"/>
  </joint>
  {transmission('shoulder', 'Effort')}
  <gazebo reference="upper">
    <sensor name="lidar" type="ray"><pose>0 0 0.3 0 0 0</pose><update_rate>100</update_rate>
      <ray><scan><horizontal><samples>8</samples><min_angle>-3</min_angle><max_angle>3</max_angle>
      </horizontal></scan><range><min>0.3</min><max>5</max></range></ray></sensor>
    <sensor name="imu" type="imu"><update_rate>100</update_rate></sensor>
    <sensor name="eye" type="camera"><update_rate>10</update_rate>
      <camera><image><width>32</width><height>16</height></image></camera></sensor>
  </gazebo>
  <gazebo><plugin name="control" filename="libgazebo_ros_control.so"/></gazebo>
</robot>
"""
CRATE = f'<robot name="crate">{box_urdf("0.5 0.5 0.5", 2.0)}</robot>'


@contextmanager
def viewing(world, **options):
    """Yield a viewer whose world a thread runs, as rosbots-view's main thread does."""
    over = threading.Event()
    viewer = Viewer(world, Site('127.0.0.1', 0), **options)
    thread = threading.Thread(target=viewer.serve, args=(over.is_set,))
    thread.start()
    try:
        yield viewer
    finally:
        over.set()
        thread.join(PATIENCE)
        viewer.close()


@pytest.fixture
def world():
    with World.empty() as made:
        yield made


def test_a_browser_sees_the_robot_drives_it_and_stops_time(world):
    robot = world.spawn(ROBOT, z=0.2)
    with viewing(world) as viewer, Browser(viewer.address) as browser:
        browser.wait_until(lambda: '/models/rosbots' in browser.nodes)
        assert viewer.robots.drive_topics() == ['rosbots/differential_drive_controller']
        browser.wait_until(lambda: world.time > 0.5 and browser.control('Forward'))

        def drives():
            browser.hold('Forward')
            return robot.plugin('diff_drive').target[0] > 0.0

        browser.wait_until(drives)
        browser.click('Pause')
        browser.wait_until(lambda: viewer.time.paused and browser.control('Play'))
        stopped = viewer.commands.call(lambda: world.clock.steps)
        browser.click('Step')
        browser.wait_until(lambda: viewer.commands.call(lambda: world.clock.steps) == stopped + 1)
        browser.click('Reset time and world')
        browser.wait_until(lambda: viewer.commands.call(lambda: world.clock.steps) == 0)


def test_sliders_move_joints_while_time_stands_still(world):
    world.spawn(ARM)
    with viewing(world, paused=True) as viewer:
        pages = Shown(viewer.view)
        viewer.joints.set_position('arm', 'shoulder', 0.7)
        assert viewer.joints.position('arm', 'shoulder') == pytest.approx(0.7)
        wait_until(lambda: any(motion.poses for motion in pages.motions), 'the arm being shown')
        assert pages.motions[-1].paused
        viewer.view.close()
        with pytest.raises(SimError, match="no joint 'elbow'; its joints: shoulder"):
            viewer.joints.set_position('arm', 'elbow', 0.7)


def test_motors_and_efforts_of_joints_act_until_they_are_released(world):
    arm = world.spawn(ARM)
    with viewing(world) as viewer:
        viewer.joints.set_velocity('arm', 'shoulder', 0.5, 40.0)
        wait_until(lambda: viewer.joints.position('arm', 'shoulder') > 0.1, 'the motor')
        viewer.joints.set_velocity('arm', 'shoulder', 0.0, 0.0)
        viewer.joints.set_effort('arm', 'shoulder', -20.0)
        wait_until(lambda: viewer.joints.position('arm', 'shoulder') < -1.0, 'the effort')
        viewer.joints.set_effort('arm', 'shoulder', 0.0)
        assert not viewer.commands.call(lambda: world.external_forces.are_pending)
    assert arm.joint('shoulder').motor[1] == 0.0


def test_controllers_take_commands(world):
    arm = world.spawn(ARM)
    manager = arm.plugin('control').manager
    manager.load(
        'arm',
        'effort_controllers/JointTrajectoryController',
        {'joints': ['shoulder'], 'gains': {'shoulder': {'p': 200.0, 'd': 20.0}}},
    )
    manager.switch(start=['arm'])
    with viewing(world) as viewer:
        (topic,) = viewer.joints.command_topics()
        assert topic == CommandTopic('arm/arm', ('shoulder',), True)
        viewer.joints.command(topic, [0.8])
        wait_until(lambda: viewer.joints.position('arm', 'shoulder') > 0.7, 'the trajectory')


def test_sensors_are_read_while_they_are_open_only(world):
    arm = world.spawn(ARM)
    world.spawn(CRATE, x=2.0, z=0.25)
    world.spawn(CRATE, 'wall', x=1.0, z=0.5)
    with viewing(world) as viewer:
        sensors = viewer.sensors
        assert sensors.offered() == {
            'arm/upper/lidar': 'ray',
            'arm/upper/imu': 'imu',
            'arm/upper/eye': 'camera',
        }
        found = {}
        for name, kind in sensors.offered().items():
            sensors.open(name, kind)

        def all_read():
            for name in sensors.offered():
                reading = sensors.read(name)
                if reading is not None:
                    found[name] = reading
            return len(found) == 3

        wait_until(all_read, 'readings')
        assert (
            found['arm/upper/lidar'].words.endswith(' of 8 rays meet something')
            or 'the nearest' in found['arm/upper/lidar'].words
        )
        assert found['arm/upper/imu'].rows[2][0] == 'linear acceleration [m/s^2]'
        assert found['arm/upper/eye'].picture.shape == (16, 32, 3)
        link, pose = sensors.locate('arm/upper/lidar', {'arm/upper': 0})
        assert (link, pose.position[2]) == ('arm/upper', pytest.approx(0.3))
        for name in sensors.offered():
            sensors.close(name)
        viewer.commands.call(lambda: None)  # after them
    assert not any(sensor.readings.wanted for sensor in arm.sensors.values())


def test_models_are_changed_as_by_services(world):
    world.spawn(CRATE, z=0.25)
    with viewing(world, paused=True) as viewer:
        inspection, editor = viewer.inspection, viewer.editor
        inspection.set_state('crate', None, Pose((1.0, 0.0, 0.25)), Twist((0.5, 0.0, 0.0)))
        pose, twist = inspection.state('crate', None)
        assert pose.position == pytest.approx((1.0, 0.0, 0.25))
        assert twist.linear == pytest.approx((0.5, 0.0, 0.0))
        inspection.set_mass('crate', 'box', 4.0, False)
        inspection.set_friction('crate', 0.2, 0.3)
        link = world.model('crate').link('box').spec
        assert (link.inertial.mass, link.inertial.ixx, link.gravity) == (4.0, 0.2, False)
        assert link.collisions[0].surface.mu == 0.2
        with pytest.raises(SimError, match='greater than zero'):
            inspection.set_mass('crate', 'box', -1.0, True)
        with pytest.raises(SimError, match='must not be negative'):
            inspection.set_friction('crate', -1.0, 0.0)
        copy = editor.insert(editor.describe('crate'), beside=True)
        assert copy == 'crate_0'
        assert abs(inspection.state(copy, None)[0].position[0] - 1.0) > 0.5
        editor.delete(copy)
        assert copy not in world.models
        editor.move('crate', Pose((0.0, 2.0, 0.25)))
        assert inspection.state('crate', 'box')[0].position[1] == pytest.approx(2.0)
        with pytest.raises(SimError, match="no model 'nothing'"):
            editor.move('nothing', Pose())


def test_shapes_lights_and_files_are_inserted_on_the_ground(world):
    with viewing(world, paused=True) as viewer:
        text = viewer.library.file('crate.urdf', CRATE.encode())
        name = viewer.editor.insert(text, on_ground=True)
        assert viewer.inspection.state(name, None)[0].position[2] == pytest.approx(0.25)
        sun = viewer.library.light(world.lights['sun'])
        assert viewer.editor.insert(sun) == 'sun_0'
        viewer.editor.delete('sun_0')
        assert set(world.lights) == {'sun'}


def test_a_model_that_crashes_the_engine_is_refused_and_the_world_goes_on(world, monkeypatch):
    monkeypatch.setattr(Engine, 'add', crash)
    with open_sandbox() as sandbox, viewing(world, sandbox=sandbox) as viewer:
        with pytest.raises(SimError, match=r'it crashed the physics engine \(SIGSEGV\)'):
            viewer.editor.insert(ModelText('', CRATE.replace('"box"', f'"{CRASHING}"')))
        assert viewer.editor.insert(ModelText('', CRATE)) == 'crate'


@pytest.mark.parametrize(
    'content',
    [
        '/etc/passwd',
        ' package://rosbots_description/urdf/x.xacro',
        'model://ground_plane',
        '../x.xacro',
        '',
    ],
)
def test_a_text_that_is_a_path_is_never_opened(world, content):
    with viewing(world, paused=True) as viewer, pytest.raises(SimError, match='begins with <'):
        viewer.editor.insert(ModelText('', content))


def test_xacro_from_a_browser_is_refused(world):
    with viewing(world, paused=True) as viewer, pytest.raises(SimError, match='can run code'):
        viewer.library.file('a.XACRO', b'<robot/>')


def test_a_push_acts_in_the_axes_of_the_link(world):
    crate = world.spawn(CRATE, z=5.0, yaw=1.5707963)
    with viewing(world, paused=True) as viewer:
        viewer.editor.push('crate::box', (20.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.1, True)
        viewer.time.step(200)
        wait_until(lambda: viewer.commands.call(lambda: world.clock.steps) == 200, 'the steps')
        assert viewer.inspection.state('crate', None)[1].linear[1] == pytest.approx(1.0, rel=0.02)
    assert crate.pose.position[0] == pytest.approx(0.0, abs=1e-3)


def test_the_world_is_saved_as_a_file_and_contacts_are_shown(world):
    world.spawn(CRATE, z=0.249)
    with viewing(world) as viewer:
        shown = []
        Shown(viewer.view)
        viewer.contacts.open(shown.append)
        wait_until(lambda: any(shown), 'contacts')
        viewer.contacts.close()
        text, sentence = viewer.worlds.save()
        assert "<model name='crate'" in text.replace('"', "'")
        assert sentence.startswith('2 models as they are at ')


def test_the_speed_is_set_for_all_browsers(world):
    with viewing(world) as viewer:
        pages = Shown(viewer.view)
        viewer.time.set_speed(10.0)
        wait_until(
            lambda: pages.changes and pages.changes[-1].max_update_rate == 10000.0, 'the speed'
        )


def test_a_page_that_waits_does_not_hold_up_the_world(world):
    """The page's callbacks may wait for a command, which only the world's owner carries out."""
    world.spawn(CRATE, z=0.25)
    with viewing(world) as viewer:
        states = []
        viewer.view.open(
            lambda _change: states.append(viewer.inspection.state('crate', None)),
            lambda _motion: None,
        )
        wait_until(lambda: states, 'the state')


def test_a_program_that_does_something_else_does_not_count_as_ended(world, monkeypatch):
    monkeypatch.setattr(scene, 'SILENCE', 0.0)
    viewer = Viewer(world, Site('127.0.0.1', 0))
    pages = Shown(viewer.view)
    viewer.run(1)  # and no more
    wait_until(lambda: len(pages.motions) > 2, 'the clock again')
    first, *_, last = pages.motions
    assert last.real_time > first.real_time
    assert (last.time, last.poses) == (0.001, {})
    viewer.close()
