"""A world that is written is read as the same world, bit for bit."""

import math
import re
from dataclasses import replace

import pytest
from lxml import etree
from support import LIBRARY, ROOT

from rosbots_description.sim import Pose, Twist, from_rpy
from rosbots_description.sim.core import normalise, rotate
from rosbots_description.sim.description import (
    JointSpec,
    LightSpec,
    LinkSpec,
    ModelSpec,
    ModelState,
    PhysicsSettings,
    SceneSpec,
    WorldSpec,
)
from rosbots_description.sim.formats import open_world, sdf_of_world
from rosbots_description.sim.formats.sdf.world_file import load_world
from rosbots_description.sim.resources import ModelSearch, find_world

WORLDS = sorted(path.stem for path in (LIBRARY / 'worlds').glob('*.world'))
TURN = normalise((0.1, -0.7, 0.3, -0.2))
BODY = LinkSpec('l')  # as a static model has it: without a mass
INNER = """<model name="outer"><link name="base"/><model name="inner"><pose>1 2 3 0.1 0.2 0.3</pose>
<link name="tip"><pose>0 0 1 0.3 0 0</pose></link></model>
<joint name="j" type="revolute"><parent>base</parent><child>inner::tip</child>
<pose>0.1 0.2 0.3 0.4 0.5 0.6</pose><axis><xyz>0.6 0.1 0.3</xyz></axis></joint></model>"""
SUBMESH = re.compile(r'<node[^>]* name="([^"]+)"')
UNREAD = (
    '<gui><camera name="user"><pose>1 2 3 0 0.5 0</pose></camera></gui>'
    '<magnetic_field>1e-6 2e-6 3e-6</magnetic_field>'
)


def read(text):
    return load_world(text, 'w.world', find_model=ModelSearch())


def world(body):
    return read(f'<sdf version="1.6"><world name="w">{body}</world></sdf>')


def again(spec):
    return read(sdf_of_world(spec))


@pytest.mark.parametrize('name', WORLDS)
def test_the_included_worlds_are_read_as_they_were_written(name):
    spec = open_world(find_world(name, [LIBRARY]), find_model=ModelSearch())
    assert _without_lines(again(spec)) == _without_lines(spec)


def test_every_setting_of_a_world_is_written():
    physics = PhysicsSettings(
        0.002, 250.0, (0.1, 0.2, -3.7), False, 3, 70, 1.1, 0.0, 1e-5, 0.3, 0.002, 50.0, 15, True
    )
    lights = (
        LightSpec(
            'sun',
            'directional',
            Pose((1.0, 2.0, 30.0), TURN),
            (0.1, 0.2, 0.3, 0.4),
            (0.5, 0.6, 0.7, 0.8),
            20.0,
            0.5,
            0.25,
            0.125,
            (0.1, 0.2, -0.9),
            True,
        ),
        LightSpec('spot', 'spot', spot_inner_angle=0.3, spot_outer_angle=0.7, spot_falloff=2.0),
        LightSpec('lamp'),
    )
    spec = WorldSpec(
        'mars',
        physics=physics,
        lights=lights,
        scene=SceneSpec(
            (0.1, 0.2, 0.3, 1.0), (0.4, 0.5, 0.6, 1.0), False, Pose((1.0, 2.0, 3.0), TURN)
        ),
    )
    assert replace(again(spec), parts=()) == spec


def test_what_nothing_here_acts_on_is_kept_as_it_was():
    sky = '<scene><sky><clouds><speed>12</speed></clouds></sky><ambient>1 1 1 1</ambient></scene>'
    text = sdf_of_world(world(f'{UNREAD}<road name="r"><width>3</width></road>{sky}'))
    root = etree.fromstring(text)
    assert root.findtext('world/road/width') == '3'
    assert root.findtext('world/gui/camera/pose') == '1 2 3 0 0.5 0'
    assert root.findtext('world/magnetic_field') == '1e-6 2e-6 3e-6'
    assert root.findtext('world/scene/sky/clouds/speed') == '12'
    assert [scene.findtext('ambient') for scene in root.iter('scene')] == ['1 1 1 1']


def test_textures_and_parts_of_meshes_are_found_again(tmp_path):
    (tmp_path / 'materials' / 'scripts').mkdir(parents=True)
    (tmp_path / 'materials' / 'textures').mkdir()
    (tmp_path / 'materials' / 'textures' / 'wood.png').write_bytes(b'')
    (tmp_path / 'materials' / 'scripts' / 'm.material').write_text(
        'material My/Wood { technique { pass { ambient 1 0.5 0.25 1 \n texture_unit {\n'
        'texture wood.png\n } } } }'
    )
    (tmp_path / 'part.dae').write_bytes((ROOT / 'meshes' / 'battery.dae').read_bytes())
    part = SUBMESH.search((tmp_path / 'part.dae').read_text())[1]
    path = tmp_path / 'w.world'
    path.write_text(f"""<sdf version="1.6"><world name="w"><model name="m"><static>1</static>
<link name="l"><visual name="v"><geometry><mesh><uri>part.dae</uri><submesh><name>{part}</name>
<center>true</center></submesh></mesh></geometry><material><script>
<uri>file://materials/scripts</uri><uri>materials/textures</uri><name>My/Wood</name></script>
</material></visual><visual name="whole"><geometry><mesh><uri>part.dae</uri><scale>2 2 2</scale>
</mesh></geometry></visual></link></model></world></sdf>""")
    spec = open_world(path, find_model=ModelSearch())
    visual, whole = spec.models[0][0].links[0].visuals
    found, other = again(spec).models[0][0].links[0].visuals
    assert visual.material.image.endswith('wood.png')
    assert found.material == visual.material
    assert (found.geometry.path, found.geometry.submesh, found.geometry.is_centred) == (
        visual.geometry.path,
        part,
        True,
    )
    assert (other.geometry.path, other.geometry.scale) == (str(tmp_path / 'part.dae'), (2, 2, 2))
    assert whole.geometry.path == other.geometry.path


def test_a_nested_model_is_written_with_its_frame_and_its_links_bit_for_bit():
    spec = world(INNER)
    found = again(spec)
    (model, _), (written, _) = found.models[0], spec.models[0]
    assert (model.links, model.joints, model.nested) == (
        written.links,
        written.joints,
        written.nested,
    )


def test_reduced_links_are_found_again():
    reduced = {'camera_link': ('l', Pose((0.1, 0.2, 0.3), TURN))}
    model = ModelSpec('m', (BODY,), static=True, reduced=reduced)
    assert again(WorldSpec(models=((model, Pose()),))).models[0][0].reduced == reduced


@pytest.mark.parametrize('effort', [5.0, math.inf])
def test_a_state_is_read_bit_for_bit(effort):
    model = ModelSpec(
        'm', (BODY, replace(BODY, name='k')), (JointSpec('j', 'revolute', 'l', 'k'),), static=True
    )
    state = ModelState(
        'm',
        Pose((0.1, 1 / 3, -2e-17), TURN),
        {'l': Pose((1.0, 2.0, 3.0), TURN), 'k': Pose()},
        {'l': Twist((0.1, 0.2, 0.3), (1e-300, 5.0, 6.0)), 'k': Twist()},
        {'j': (37.3, -2 / 3)},
        {'j': (0.5, effort)},
        {'l': Pose((3.0, 2.0, 1.0), TURN)},
    )
    spec = WorldSpec(models=((model, Pose()),), states=(state,), time=1234.567)
    found = again(spec)
    assert (found.states, found.time) == (spec.states, spec.time)


@pytest.mark.parametrize(
    'pitch',
    [
        0.0,
        1.2,
        *(
            sign * (math.pi / 2.0 - offset)
            for sign in (1, -1)
            for offset in (0.0, 1e-9, 1e-7, 1e-3)
        ),
    ],
)
@pytest.mark.parametrize('yaw', [0.0, 0.3, -2.9, math.pi])
def test_a_pose_means_the_same_to_programs_that_read_angles_only(pitch, yaw):
    q = from_rpy(0.4, pitch, yaw)
    text = sdf_of_world(WorldSpec(lights=(LightSpec('a', pose=Pose(orientation=q)),)))
    (light,) = read(text).lights
    assert light.pose.orientation == q
    element = etree.fromstring(text).find('world/light/pose')
    element.attrib.clear()
    (plain,) = read(etree.tostring(element.getroottree().getroot(), encoding='unicode')).lights
    for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)):
        assert rotate(plain.pose.orientation, axis) == pytest.approx(rotate(q, axis), abs=1e-7)


def test_angles_that_are_changed_by_hand_are_believed():
    text = sdf_of_world(WorldSpec(lights=(LightSpec('a', pose=Pose(orientation=TURN)),)))
    root = etree.fromstring(text)
    root.find('world/light/pose').text = '0 0 0 0 0 0.5'
    (light,) = read(etree.tostring(root, encoding='unicode')).lights
    assert light.pose.orientation == from_rpy(0.0, 0.0, 0.5)


def test_velocities_of_gazebos_own_states_are_not_applied_as_by_gazebo():
    spec = world(
        '<model name="m"><link name="l"/></model><state world_name="w"><model name="m">'
        '<link name="l"><pose>0 0 1 0 0 0</pose><velocity>1 2 3 0 0 0</velocity></link>'
        '</model></state>'
    )
    assert spec.states[0].twists == {}


def test_axes_that_are_no_rotation_do_not_count():
    state = ModelState('m', links={'l': Pose()}, axes={'l': Pose(orientation=TURN)})
    spec = WorldSpec(models=((ModelSpec('m', (BODY,), static=True), Pose()),), states=(state,))
    root = etree.fromstring(sdf_of_world(spec))
    link = root.find('world/state/model/link')
    link.set('{urn:rosbots}axes', '0 0 0 0 0 0 0')
    assert read(etree.tostring(root, encoding='unicode')).states[0].axes == {}
    link.set('{urn:rosbots}axes', '0 0 0')
    damaged = read(etree.tostring(root, encoding='unicode'))
    assert damaged.states == ()
    assert '0 0 0' in damaged.faults[0]


def _without_lines(value):
    """Return a value as text, without the lines on which its elements were read."""

    def keep(part):
        if hasattr(part, '__dataclass_fields__'):
            return {
                name: keep(getattr(part, name))
                for name in part.__dataclass_fields__
                if name not in ('line', 'location')
            }
        if isinstance(part, (tuple, list)):
            return [keep(one) for one in part]
        return part

    return keep(value)
