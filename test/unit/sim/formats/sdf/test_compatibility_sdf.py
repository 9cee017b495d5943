"""The table of SDF elements in doc/gazebo_compatibility.md agrees with the readers."""

import logging
import re

import pytest
from lxml import etree
from support import ROOT
from support.compatibility import rows

from rosbots_description.sim.formats.sdf import joints
from rosbots_description.sim.formats.sdf.omissions import Notes
from rosbots_description.sim.formats.sdf.world_file import load_world
from rosbots_description.sim.resources import xml_parser
from rosbots_description.sim.resources.search_path import ModelSearch

OFFERED = ('same', 'better')
MISSING, QUIET = 'not supported', 'level debug'

# Contains every supported element, and the parent of every unsupported one.
WORLD = """<sdf version="1.6"><world name="w"><gravity>0 0 -9</gravity><frame name="f">
<pose>0 0 0 0 0 0</pose></frame><physics><max_step_size>0.001</max_step_size>
  <real_time_update_rate>0</real_time_update_rate>
  <update_rate>0</update_rate><gravity>0 0 -9</gravity><max_contacts>5</max_contacts><ode>
  <max_contacts>5</max_contacts><solver><dt>0.001</dt><iters>9</iters><sor>1</sor>
  <friction_model>cone_model</friction_model>
  <precon_iters>1</precon_iters></solver><constraints><cfm>0</cfm><erp>1</erp>
  <contact_surface_layer>1</contact_surface_layer>
  <contact_max_correcting_vel>1</contact_max_correcting_vel></constraints></ode></physics>
<scene><ambient>1 1 1</ambient><background>1 1 1</background><shadows>1</shadows></scene>
<gui><camera><pose>0 0 0 0 0 0</pose></camera></gui>
<plugin name="p" filename="libgazebo_ros_factory.so"/>
<state><sim_time>1 0</sim_time><model name="m"><pose>0 0 0 0 0 0</pose>
  <link name="a"><pose>0 0 0 0 0 0</pose></link><model name="i"/></model></state>
<include><uri>model://ground_plane</uri><name>g</name><pose>0 0 0 0 0 0</pose>
  <static>1</static><plugin name="p" filename="lib.so"/></include>
<light name="l" type="spot"><pose>0 0 0 0 0 0</pose><cast_shadows>1</cast_shadows>
  <diffuse>1 1 1</diffuse><specular>1 1 1</specular><attenuation><range>1</range>
  <constant>1</constant><linear>1</linear><quadratic>1</quadratic></attenuation>
  <direction>0 0 -1</direction><spot><inner_angle>1</inner_angle><outer_angle>1</outer_angle>
  <falloff>1</falloff></spot></light>
<model name="m"><pose>0 0 0 0 0 0</pose><static>0</static><self_collide>1</self_collide>
  <frame name="f"><pose>0 0 0 0 0 0</pose></frame><plugin name="p" filename="lib.so"/>
  <model name="i"><link name="k"/></model>
  <link name="a"><pose>0 0 0 0 0 0</pose><gravity>1</gravity><self_collide>1</self_collide>
    <kinematic>1</kinematic><velocity_decay><linear>1</linear><angular>1</angular></velocity_decay>
    <inertial><pose>0 0 0 0 0 0</pose><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz>
      <ixy>0</ixy><ixz>0</ixz><iyz>0</iyz></inertia></inertial>
    <collision name="c"><pose>0 0 0 0 0 0</pose><geometry><box><size>1 1 1</size></box></geometry>
      <surface><friction><ode><mu>1</mu><mu2>1</mu2><fdir1>1 0 0</fdir1><slip1>0</slip1>
      <slip2>0</slip2></ode></friction>
      <bounce><restitution_coefficient>0</restitution_coefficient><threshold>1</threshold></bounce>
      <contact><ode><kp>1</kp><kd>1</kd></ode><collide_bitmask>1</collide_bitmask>
      <category_bitmask>1</category_bitmask></contact></surface>
      <laser_retro>1</laser_retro></collision><sensor name="s" type="ray">
      <pose>0 0 0 0 0 0</pose><update_rate>1</update_rate><always_on>1</always_on>
      <visualize>1</visualize><topic>t</topic><plugin name="p" filename="lib.so"/></sensor>
    <visual name="v"><pose>0 0 0 0 0 0</pose><transparency>0</transparency><visible>1</visible>
      <geometry><sphere><radius>1</radius></sphere></geometry><material><script>
      <name>Gazebo/Red</name></script><diffuse>1 1 1</diffuse><ambient>1 1 1</ambient>
      <specular>1 1 1</specular><emissive>1 1 1</emissive></material>
    </visual>
    <visual name="v2"><geometry><cylinder><radius>1</radius><length>1</length></cylinder></geometry>
    </visual><visual name="v3"><geometry><plane><normal>0 0 1</normal><size>1 1</size></plane>
    </geometry></visual><visual name="v4"><geometry><empty/></geometry></visual>
    <visual name="v5"><geometry><mesh><uri>model://meshes/camera.dae</uri><scale>1 1 1</scale>
      <filename>model://meshes/camera.dae</filename><submesh><name>camera</name><center>1</center>
      </submesh></mesh></geometry></visual></link>
  <link name="b"/><joint name="j" type="revolute"><pose>0 0 0 0 0 0</pose><parent>a</parent>
    <child>b</child><axis><xyz>0 0 1</xyz><use_parent_model_frame>1</use_parent_model_frame>
    <limit><effort>5</effort><lower>0</lower><upper>1</upper></limit>
    <dynamics><damping>1</damping><friction>1</friction>
      <spring_stiffness>1</spring_stiffness><spring_reference>1</spring_reference></dynamics>
    </axis></joint>
</model>
<model name="s"><static>1</static><include><uri>model://ground_plane</uri></include></model>
</world></sdf>"""

COLOUR = '1 0 0 1'
VALUES = {'ambient': COLOUR, 'background': COLOUR, 'fdir1': '1 0 0'}  # the value of others is 3


def row_name(path):
    """Return the name of a path in the table, the same for all models, lights and shapes."""
    path = re.sub(r'^(world/|model/)*(model|include|light)/', r'\2/', path)
    path = re.sub(r'^world/state/(model/)+', 'world/state/model/', path)
    return re.sub(r'^model/link/(collision|visual)/geometry/', 'geometry/', path)


def path_of(element):
    """Return the tags from below the root to an element."""
    tags = [element.tag, *(ancestor.tag for ancestor in element.iterancestors())]
    return '/'.join(reversed(tags[:-1]))


def leaves(paths):
    """Return the paths that are no prefix of another one."""
    ends = {path for path in paths if not any(other.startswith(path + '/') for other in paths)}
    return {path for path in ends if path[-1] not in '*.'}


@pytest.fixture
def requested(monkeypatch):
    """Return two sets, to be filled with the paths that the readers read and that they ignore."""
    wanted, idle = set(), set()
    check, parser = Notes.check, xml_parser._parser

    class Element(etree.ElementBase):
        """An element that records the lookups of children and attributes."""

    def asking(method):
        look = getattr(etree.ElementBase, method)

        def ask(self, path, *arguments):
            wanted.add(f'{path_of(self)}/{path}'.lstrip('/'))
            if path == 'geometry/*':
                wanted.update(path_of(child) for child in look(self, path))
            return look(self, path, *arguments)

        return ask

    def checking(self, element, read, unused=()):
        wanted.update(f'{path_of(element)}/{tag}' for tag in read)
        idle.update(unused)
        check(self, element, read, unused)

    def remembering(*arguments):
        made = parser(*arguments)
        made.set_element_class_lookup(etree.ElementDefaultClassLookup(element=Element))
        return made

    for method in ('find', 'findall', 'findtext', 'iterfind'):
        setattr(Element, method, asking(method))
    monkeypatch.setattr(Notes, 'check', checking)
    monkeypatch.setattr(xml_parser, '_parser', remembering)
    return wanted, idle


def load(text, caplog):
    """Return the log messages about a world, as (level, text)."""
    caplog.set_level(logging.DEBUG, 'rosbots_description')
    assert load_world(text, 'w.world', find_model=ModelSearch([ROOT])).faults == ()
    message = [(record.levelno, record.getMessage()) for record in caplog.records]
    return [(level, text) for level, text in message if text.startswith('w.world')]


def world_with(path):
    """Return WORLD with one more element at a row's path, first in its parent."""
    root = etree.fromstring(WORLD)
    tag = path.rpartition('/')[2]
    parent = next(e for e in root.iter() if row_name(f'{path_of(e)}/{tag}') == path)
    element = etree.Element(tag)
    element.text = VALUES.get(tag, '3')
    parent.insert(0, element)
    return etree.tostring(root)


ROWS = rows('SDF elements')
ELEMENTS = [row for row in ROWS if ' type=' not in row[0]]
TYPES = {name.split('"')[1]: state for name, state, _ in ROWS if ' type=' in name}
SUPPORTED = {name for name, state, _ in ELEMENTS if state != MISSING}
ABSENT = {name: how for name, state, how in ELEMENTS if state == MISSING}


def test_each_element_has_one_row_with_a_known_state():
    assert len({name for name, _, _ in ROWS}) == len(ROWS)
    assert [row for row in ROWS if row[1] not in (*OFFERED, MISSING)] == []
    assert [row for row in ROWS if row[1] != 'same' and not row[2]] == []


def test_rows_are_exactly_the_elements_that_the_readers_look_up(requested, caplog):
    load(WORLD, caplog)
    wanted, idle = requested
    assert leaves({row_name(path) for path in wanted}) - set(ABSENT) == SUPPORTED
    assert idle <= {name.rpartition('/')[2] for name, how in ABSENT.items() if QUIET in how}


def test_supported_elements_are_not_reported(caplog):
    assert {row_name(path_of(element)) for element in etree.fromstring(WORLD).iter()} >= SUPPORTED
    assert load(WORLD, caplog) == []


@pytest.mark.parametrize('name', ABSENT)
def test_unsupported_element_is_reported_at_the_level_of_its_row(name, caplog):
    tag = name.rpartition('/')[2]
    named = [
        level
        for level, text in load(world_with(name), caplog)
        if re.search(rf'/{tag} \(line|<{tag}>', text)
    ]
    assert named == [logging.DEBUG if QUIET in ABSENT[name] else logging.WARNING]


def test_every_type_of_joint_has_a_row():
    assert set(TYPES) == {*joints._TYPES, *joints._NOT_SIMULATED}


@pytest.mark.parametrize('kind', TYPES)
def test_type_of_joint_is_simulated_or_reported_as_in_its_row(kind, caplog):
    message = load(WORLD.replace('"revolute"', f'"{kind}"'), caplog)
    assert [f'{kind} joints are not simulated' in text for _, text in message] == [True] * (
        TYPES[kind] == MISSING
    )
