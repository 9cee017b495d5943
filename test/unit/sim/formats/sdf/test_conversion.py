"""SDF 1.0 to 1.2, with values in attributes, is the same as its current form."""

from dataclasses import replace

from rosbots_description.sim.core import Pose
from rosbots_description.sim.core.transforms import from_rpy
from rosbots_description.sim.description import Plane
from rosbots_description.sim.formats.sdf.world_file import load_world
from rosbots_description.sim.resources.search_path import ModelSearch

OLD = """<gazebo version="1.0"><world name="w">
  <scene><ambient rgba="0.5 0.5 0.5 1.0"/><background rgba="0.1 0.2 0.3 1"><sky material="x"/>
    </background><shadows enabled="false"/></scene>
  <physics type="ode" update_rate="500"><gravity xyz="0 0 -9.5"/><ode>
    <solver type="quick" dt="0.002" iters="30" sor="1.2"/>
    <constraints cfm="0" erp="0.3" contact_max_correcting_vel="90" contact_surface_layer="0.01"/>
  </ode></physics>
  <light type="directional" name="sun" cast_shadows="true"><origin pose="0 0 10 0 0 0"/>
    <diffuse rgba="0.8 0.8 0.7 1"/><specular rgba="0.1 0.2 0.1 1"/><direction xyz="0 0.1 -1"/>
    <attenuation range="30" constant="0.5" linear="0.02" quadratic="0.003"/></light>
  <model name="arm" static="false"><origin pose="0 0 2.1 0.5 0 0"/>
    <link name="a" self_collide="true" gravity="false" kinematic="false">
      <origin pose="0 0 0.5 0 0 0"/><damping linear="0.1" angular="0.2"/>
      <inertial mass="10"><origin pose="0 0 -0.5 0 0 0"/>
        <inertia ixx="1" ixy="0.1" ixz="0" iyy="2" iyz="0" izz="1.5"/></inertial>
      <visual name="v" cast_shadows="true" laser_retro="100" transparency="0.25">
        <origin pose="0 0 -0.5 0 0 0"/><geometry><cylinder radius="0.1" length="1"/></geometry>
        <material script="Gazebo/Green"><ambient rgba="0.1 0.5 0.5 1"/></material></visual>
      <collision name="c" laser_retro="100"><origin pose="0 0 -0.5 0 0 0"/>
        <max_contacts>250</max_contacts><geometry><box size="0.1 0.2 1"/></geometry>
        <surface><friction><ode mu="0.5" mu2="0.2" fdir1="1 0 0" slip1="0" slip2="0.1"/></friction>
          <bounce restitution_coefficient="0.1" threshold="7"/>
          <contact><ode kp="1e6" kd="20" max_vel="3" min_depth="0.001"/></contact></surface>
      </collision>
      <sensor name="eye" type="camera" always_on="true" update_rate="30" visualize="false">
        <origin pose="0.1 0 0 0 0 0"/><camera><horizontal_fov angle="1.2"/>
          <image width="64" height="48" format="R8G8B8"/><clip near="0.1" far="20"/></camera>
        <plugin name="p" filename="libx.so"><box size="2"/></plugin></sensor>
      <sensor name="feel" type="contact"><contact><collision name="c"/></contact></sensor>
      <sensor name="laser" type="ray"><ray><scan><horizontal samples="5" resolution="1"
        min_angle="-1" max_angle="1"/></scan><range min="0.1" max="9" resolution="0.01"/></ray>
      </sensor></link>
    <joint name="j" type="revolute"><parent link="world"/><child link="a"/>
      <origin pose="0 0 0.1 0 0 0"/><axis xyz="1 0 0">
      <limit lower="-2" upper="3" effort="10" velocity="5"/><dynamics damping="0.5" friction="0.1"/>
      </axis></joint></model>
  <model name="floor" static="1"><link name="l"><collision name="c"><geometry>
    <plane normal="0 0 1"/></geometry></collision></link></model>
</world></gazebo>"""

NEW = """<sdf version="1.4"><world name="w">
  <scene><ambient>0.5 0.5 0.5 1.0</ambient><background>0.1 0.2 0.3 1</background>
    <shadows>false</shadows></scene>
  <physics type="ode"><real_time_update_rate>500</real_time_update_rate><gravity>0 0 -9.5</gravity>
    <max_step_size>0.002</max_step_size><ode>
    <solver><type>quick</type><iters>30</iters><sor>1.2</sor></solver>
    <constraints><cfm>0</cfm><erp>0.3</erp>
      <contact_max_correcting_vel>90</contact_max_correcting_vel>
      <contact_surface_layer>0.01</contact_surface_layer></constraints></ode></physics>
  <light type="directional" name="sun"><cast_shadows>true</cast_shadows><pose>0 0 10 0 0 0</pose>
    <diffuse>0.8 0.8 0.7 1</diffuse><specular>0.1 0.2 0.1 1</specular>
    <direction>0 0.1 -1</direction><attenuation><range>30</range><constant>0.5</constant>
    <linear>0.02</linear><quadratic>0.003</quadratic></attenuation></light>
  <model name="arm"><static>false</static><pose>0 0 2.1 0.5 0 0</pose>
    <link name="a"><self_collide>true</self_collide><gravity>false</gravity>
      <pose>0 0 0.5 0 0 0</pose>
      <velocity_decay><linear>0.1</linear><angular>0.2</angular></velocity_decay>
      <inertial><mass>10</mass><pose>0 0 -0.5 0 0 0</pose><inertia><ixx>1</ixx><ixy>0.1</ixy>
        <ixz>0</ixz><iyy>2</iyy><iyz>0</iyz><izz>1.5</izz></inertia></inertial>
      <visual name="v"><transparency>0.25</transparency><pose>0 0 -0.5 0 0 0</pose>
        <geometry><cylinder><radius>0.1</radius><length>1</length></cylinder></geometry>
        <material><script><name>Gazebo/Green</name></script><ambient>0.1 0.5 0.5 1</ambient>
        </material></visual>
      <collision name="c"><laser_retro>100</laser_retro><pose>0 0 -0.5 0 0 0</pose>
        <max_contacts>250</max_contacts><geometry><box><size>0.1 0.2 1</size></box></geometry>
        <surface><friction><ode><mu>0.5</mu><mu2>0.2</mu2><fdir1>1 0 0</fdir1><slip1>0</slip1>
          <slip2>0.1</slip2></ode></friction><bounce>
          <restitution_coefficient>0.1</restitution_coefficient><threshold>7</threshold></bounce>
          <contact><ode><kp>1e6</kp><kd>20</kd><max_vel>3</max_vel><min_depth>0.001</min_depth>
          </ode></contact></surface></collision>
      <sensor name="eye" type="camera"><pose>0.1 0 0 0 0 0</pose><camera>
          <horizontal_fov>1.2</horizontal_fov>
          <image><width>64</width><height>48</height><format>R8G8B8</format></image>
          <clip><near>0.1</near><far>20</far></clip></camera>
        <plugin name="p" filename="libx.so"><box size="2"/></plugin>
        <always_on>true</always_on><update_rate>30</update_rate><visualize>false</visualize>
      </sensor>
      <sensor name="feel" type="contact"><contact><collision>c</collision></contact></sensor>
      <sensor name="laser" type="ray"><ray><scan><horizontal><samples>5</samples>
        <resolution>1</resolution><min_angle>-1</min_angle><max_angle>1</max_angle></horizontal>
        </scan><range><min>0.1</min><max>9</max><resolution>0.01</resolution></range></ray>
      </sensor></link>
    <joint name="j" type="revolute"><parent>world</parent><child>a</child>
      <pose>0 0 0.1 0 0 0</pose><axis><xyz>1 0 0</xyz>
      <limit><lower>-2</lower><upper>3</upper><effort>10</effort><velocity>5</velocity></limit>
      <dynamics><damping>0.5</damping><friction>0.1</friction></dynamics></axis></joint></model>
  <model name="floor"><static>1</static><link name="l"><collision name="c"><geometry>
    <plane><normal>0 0 1</normal></plane></geometry></collision></link></model>
</world></sdf>"""


def world(text):
    return load_world(text, 'w.world', find_model=ModelSearch())


def content(element):
    """Return an element without the order of its children, which has no meaning."""
    return (
        element.tag,
        element.text,
        dict(element.attributes),
        sorted((content(child) for child in element.children), key=repr),
    )


def test_values_in_attributes_are_those_in_elements():
    old, new = world(OLD), world(NEW)
    assert (old.faults, new.faults) == ((), ())
    assert (old.physics, old.scene, old.lights) == (new.physics, new.scene, new.lights)
    (arm, pose), (floor, _) = old.models
    (other, other_pose), _ = new.models
    assert pose == other_pose == Pose((0.0, 0.0, 2.1), from_rpy(0.5, 0.0, 0.0))
    (link,), (other_link,) = arm.links, other.links
    assert replace(link, sensors=()) == replace(other_link, sensors=())
    assert arm.joints == other.joints
    for sensor, like in zip(link.sensors, other_link.sensors, strict=True):
        assert content(sensor.element) == content(like.element)
    assert (arm.static, floor.static) == (False, True)
    assert isinstance(floor.links[0].collisions[0].geometry, Plane)


def test_the_content_of_plugins_is_left_as_it_is():
    ((arm, _), _) = world(OLD).models
    (plugin,) = arm.links[0].sensors[0].plugins
    (box,) = plugin.element.children
    assert (box.tag, dict(box.attributes)) == ('box', {'size': '2'})


def test_the_file_of_an_old_mesh_is_found(tmp_path):
    (tmp_path / 'seat.obj').write_text('v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3', encoding='ascii')
    for mesh in (
        f'<mesh filename="{tmp_path}/seat.obj" scale="2 2 2"/>',
        f'<mesh><filename>{tmp_path}/seat.obj</filename><scale>2 2 2</scale></mesh>',
    ):
        spec = world(
            '<gazebo version="1.2"><world name="w"><model name="m"><link name="l">'
            f'<visual name="v"><geometry>{mesh}</geometry></visual></link></model>'
            '</world></gazebo>'
        )
        ((model, _),) = spec.models
        geometry = model.links[0].visuals[0].geometry
        assert (geometry.path, geometry.scale) == (f'{tmp_path}/seat.obj', (2.0, 2.0, 2.0))
