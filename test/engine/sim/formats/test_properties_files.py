"""Property tests: damaged worlds, saved worlds and xacro arguments are refused, or simulated."""

import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support import ROOT, box_urdf
from support.descriptions import sdfs
from support.fuzzing import Fuzzer
from support.mutations import ADVERSARIAL, damaged

from rosbots_description.sim import Pose, World

PARTS = """<physics type="ode"><max_step_size>0.001</max_step_size><real_time_update_rate>1000
</real_time_update_rate><ode><solver><iters>50</iters></solver></ode></physics>
<gravity>0 0 -9.8</gravity><scene><ambient>0.4 0.4 0.4 1</ambient><shadows>1</shadows></scene>
<gui><camera name="user"><pose>1 2 3 0 0.1 0.2</pose></camera></gui>
<light name="sun" type="directional"><pose>0 0 10 0 0 0</pose><diffuse>1 1 1 1</diffuse>
<direction>0.1 0.1 -1</direction></light>
<light name="lamp" type="spot"><attenuation><range>10</range></attenuation><spot>
<inner_angle>0.1</inner_angle><outer_angle>0.5</outer_angle><falloff>1</falloff></spot></light>
<frame name="corner"><pose>0 0 1 0 0 0</pose></frame>
<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane>
<normal>0 0 1</normal><size>100 100</size></plane></geometry></collision></link></model>
<model name="rover"><pose relative_to="corner">3 0 0 0 0 0</pose><link name="l"><inertial>
<mass>2</mass></inertial><collision name="c"><geometry><sphere><radius>0.2</radius></sphere>
</geometry><surface><friction><ode><mu>0.5</mu></ode></friction></surface></collision>
<sensor name="scan" type="ray"><update_rate>50</update_rate><ray><scan><horizontal>
<samples>9</samples><min_angle>-1</min_angle><max_angle>1</max_angle></horizontal></scan><range>
<min>0.1</min><max>5</max></range><noise><type>gaussian</type><stddev>0.01</stddev></noise></ray>
<plugin name="laser" filename="libgazebo_ros_laser.so"><topicName>scan</topicName></plugin>
</sensor><sensor name="turn" type="imu"><update_rate>50</update_rate></sensor>
<sensor name="touch" type="contact"><contact><collision>c</collision></contact></sensor></link>
<plugin name="truth" filename="libgazebo_ros_p3d.so"><bodyName>l</bodyName>
<topicName>truth</topicName><updateRate>50</updateRate></plugin></model>
<plugin name="weather" filename="libweather.so"><wind>3</wind></plugin>
<state world_name="default"><sim_time>1 500</sim_time><model name="rover"><pose>3 1 2 0 0 0</pose>
<link name="l"><pose>3 1 2 0 0 0</pose><velocity>1 0 0 0 0 0</velocity></link></model></state>"""
ARM = """<sdf version="1.6"><model name="arm"><link name="a"><inertial><mass>1</mass></inertial>
</link><link name="b"><pose>0.3 0 0 0 0 0</pose><inertial><mass>1</mass></inertial></link>
<joint name="j" type="revolute"><parent>a</parent><child>b</child><axis><xyz>0 1 0</xyz><limit>
<lower>-1</lower><upper>1</upper></limit></axis></joint></model></sdf>"""
ROBOT = f"""<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:arg name="mass" default="1"/><xacro:arg name="size" default="0.2"/>
<xacro:arg name="name" default="box"/><xacro:arg name="flag" default="true"/>
<xacro:property name="half" value="${{$(arg size) / 2}}"/>
{box_urdf('$(arg size) ${2 * half} 1', 1.0).replace('"1.0"', '"$(arg mass)"')}
<xacro:if value="$(arg flag)"><link name="$(arg name) too"><inertial><mass value="${{half}}"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="$(arg name)" type="continuous"><parent link="box"/><child link="$(arg name) too"/>
<origin xyz="$(arg size) 0 0"/><axis xyz="0 0 1"/></joint></xacro:if></robot>"""
OPTIONS = ('camera', 'depth', 'imu', 'laser', 'bumper', 'surfaces', 'nonsense')  # of our robot
ARGUMENTS = st.dictionaries(
    st.sampled_from(('mass', 'size', 'name', 'flag')) | ADVERSARIAL,
    st.sampled_from(('0.3', '2', 'true', 'false', '1 + 1')) | ADVERSARIAL,
    min_size=1,
    max_size=3,
)


@pytest.fixture(scope='module')
def fuzzer():
    with Fuzzer() as fuzzer:
        yield fuzzer
        fuzzer.require_both()


@pytest.fixture(scope='module')
def saved(tmp_path_factory):
    """Return the text of a saved world in motion."""
    path = tmp_path_factory.mktemp('saved') / 'it.world'
    with World.empty() as world:
        world.spawn(f'<robot name="box">{box_urdf("1 0.6 0.4", 2.0)}</robot>', z=1.0)
        world.spawn(ARM, pose=Pose((2.0, 0.0, 1.0)))
        world.model('arm').joint('j').set_motor(1.0, 5.0)
        world.run(100)
        world.save(path)
    return path.read_text()


@given(st.data())
def test_damaged_world_is_refused_or_simulated(fuzzer, data):
    models = re.sub(r'</?sdf[^>]*>', '', data.draw(sdfs()).text)
    text = f'<sdf version="1.6"><world name="default">{PARTS}{models}</world></sdf>'
    fuzzer.judge('world', data.draw(damaged(text, 2)))


@given(st.data())
def test_damaged_saved_world_is_refused_or_simulated(fuzzer, saved, data):
    fuzzer.judge('world', data.draw(damaged(saved, 2)))


@given(ARGUMENTS)
def test_any_arguments_of_xacro_are_refused_or_simulated(fuzzer, tmp_path_factory, arguments):
    path = tmp_path_factory.getbasetemp() / 'robot.xacro'
    path.write_text(ROBOT)
    fuzzer.judge('model', str(path), arguments)


@given(st.dictionaries(st.sampled_from(OPTIONS), ADVERSARIAL | st.just('true'), min_size=1))
@settings(max_examples=1 + settings.default.max_examples // 8)
def test_any_arguments_of_our_robot_are_refused_or_simulated(fuzzer, monkeypatch, arguments):
    monkeypatch.setenv('ROS_PACKAGE_PATH', str(ROOT))
    fuzzer.judge('model', str(ROOT / 'urdf' / 'rosbots.xacro'), arguments)
