"""World files are read into WorldSpec values."""

import logging
import math

import pytest
from support.refusals import sentence_of

from rosbots_description.sim.core.errors import ModelError
from rosbots_description.sim.core.transforms import Pose, from_rpy
from rosbots_description.sim.description.built_in import GROUND_PLANE
from rosbots_description.sim.description.physics_settings import PhysicsSettings
from rosbots_description.sim.description.world_spec import SceneSpec
from rosbots_description.sim.formats.sdf.world_file import load_world, open_world
from rosbots_description.sim.resources.search_path import ModelSearch

SUN = '<include><uri>model://sun</uri></include>'
GROUND = '<include><uri>model://ground_plane</uri></include>'
BOX = '<model name="{}"><pose>{}</pose><link name="link"/></model>'


def load(body, version='1.6', directories=()):
    text = f'<sdf version="{version}"><world name="w">{body}</world></sdf>'
    return load_world(text, 'w.world', find_model=ModelSearch(directories))


def physics(body):
    return load(f'<physics type="ode">{body}</physics>').physics


def error_message(body):
    sentence = sentence_of(ModelError, load, body)
    assert sentence.startswith('w.world, line ')
    return sentence


def test_empty_world_has_the_builtin_ground_and_sun():
    world = load(GROUND + SUN)
    assert world.models == ((GROUND_PLANE, Pose()),)
    sun = world.lights[0]
    assert (sun.name, sun.type, sun.cast_shadows) == ('sun', 'directional', True)
    assert sun.direction[2] < 0.0
    assert (world.physics, world.scene, world.faults) == (PhysicsSettings(), SceneSpec(), ())


def test_models_are_in_the_order_of_the_file():
    world = load(BOX.format('b', '1 0 0 0 0 0') + GROUND + BOX.format('a', '0 2 0 0 0 0'))
    assert [model.name for model, _ in world.models] == ['b', 'ground_plane', 'a']
    assert [pose.position for _, pose in world.models] == [(1, 0, 0), (0, 0, 0), (0, 2, 0)]


def test_an_include_overrides_name_and_pose():
    include = (
        '<include><uri>model://ground_plane</uri><name>floor</name>'
        '<pose>0 0 -1 0 0 0</pose></include>'
    )
    model, pose = load(include).models[0]
    assert (model.name, pose) == ('floor', Pose((0.0, 0.0, -1.0)))


def test_light_can_be_included_with_name_and_pose():
    include = '<include><uri>model://sun</uri><name>lamp</name><pose>0 0 3 0 0 0</pose></include>'
    light = load(include).lights[0]
    assert (light.name, light.pose.position) == ('lamp', (0.0, 0.0, 3.0))


def test_models_may_be_posed_in_frames_of_the_world():
    world = load(
        f"""<frame name="corner"><pose>5 0 0 0 0 {math.pi / 2}</pose></frame>
      <model name="m"><pose relative_to="corner">1 0 0 0 0 0</pose><link name="a"/></model>
      <model name="n"><pose relative_to="m">1 0 0 0 0 0</pose><link name="a"/></model>""",
        '1.7',
    )
    assert world.models[0][1].position == pytest.approx((5.0, 1.0, 0.0))
    assert world.models[1][1].position == pytest.approx((5.0, 2.0, 0.0))


def test_duplicate_names_of_models_become_unique(caplog):
    world = load(BOX.format('m', '0 0 0 0 0 0') * 3)
    assert [model.name for model, _ in world.models] == ['m', 'm_0', 'm_1']
    assert "this one is called 'm_0'" in caplog.text


def test_invalid_model_is_left_out_with_an_error(caplog):
    broken = '<model name="bad"><link name="a"><inertial><mass>0</mass></inertial></link></model>'
    included = '<include><uri>model://no</uri></include>'
    world = load(broken + BOX.format('good', '0 0 0 0 0 0') + included)
    assert [model.name for model, _ in world.models] == ['good']
    assert len(world.faults) == 2
    assert 'mass 0 kg is not valid' in world.faults[0]
    assert "'model://no' is not to be found" in world.faults[1]
    errors = [record.getMessage() for record in caplog.records if record.levelno == logging.ERROR]
    assert errors == [f'{fault}; this model is left out' for fault in world.faults]


def test_all_missing_models_of_a_world_are_one_error(caplog):
    included = '<include><uri>model://{}</uri></include>'
    world = load(
        ''.join(map(included.format, ('shelf', 'sun', 'lamp', 'shelf'))), directories=['/models']
    )
    (fault,) = world.faults
    assert fault == (
        "w.world: 3 <include>s: 'shelf', 'lamp' are not to be found along the model path (/models)"
        '; add the folder that holds them to GAZEBO_MODEL_PATH where the simulator is started'
    )
    errors = [record.getMessage() for record in caplog.records if record.levelno == logging.ERROR]
    assert errors == [f'{fault}; the world is loaded without them']
    assert len(world.lights) == 1


def test_physics_is_read():
    assert physics("""<max_step_size>0.002</max_step_size><real_time_factor>1</real_time_factor>
      <real_time_update_rate>0</real_time_update_rate><max_contacts>30</max_contacts>
      <gravity>0 0 -1.6</gravity><ode><solver><type>quick</type><iters>100</iters>
      <precon_iters>2</precon_iters><sor>1.1</sor></solver><constraints><cfm>0.1</cfm><erp>0.3</erp>
      <contact_max_correcting_vel>50</contact_max_correcting_vel><contact_surface_layer>0.002
      </contact_surface_layer></constraints></ode>""") == PhysicsSettings(
        step_size=0.002,
        max_update_rate=0.0,
        gravity=(0.0, 0.0, -1.6),
        sor_pgs_precon_iters=2,
        sor_pgs_iters=100,
        sor_pgs_w=1.1,
        cfm=0.1,
        erp=0.3,
        contact_surface_layer=0.002,
        contact_max_correcting_vel=50.0,
        max_contacts=30,
    )


def test_physics_of_sdf_1_3_is_read():
    made = physics('<update_rate>500</update_rate><ode><solver><dt>0.005</dt></solver></ode>')
    assert (made.step_size, made.max_update_rate) == (0.005, 500.0)


def test_gravity_of_the_world_takes_precedence_over_that_of_its_physics():
    world = load('<gravity>0 0 -3.7</gravity><physics><gravity>0 0 -1</gravity></physics>')
    assert world.physics.gravity == (0.0, 0.0, -3.7)


def test_default_one_of_several_physics_is_used():
    slow = '<physics name="a"><max_step_size>0.01</max_step_size></physics>'
    fast = '<physics name="b" default="1"><max_step_size>0.02</max_step_size></physics>'
    assert load(slow + fast).physics.step_size == 0.02
    assert load(slow + fast.replace(' default="1"', '')).physics.step_size == 0.01


def test_other_physics_engine_is_reported(caplog):
    load('<physics type="bullet"/>')
    assert "physics type 'bullet' is not available" in caplog.text


@pytest.mark.parametrize(
    ('model', 'cone', 'logged'),
    [
        ('pyramid_model', False, ''),
        ('cone_model', True, ''),
        ('box_model', False, "friction_model 'box_model' is not supported; pyramid_model is used"),
    ],
)
def test_the_friction_model_is_read(model, cone, logged, caplog):
    tag = f'<friction_model>{model}</friction_model>'
    made = physics(f'<ode><solver>{tag}</solver></ode>')
    assert made == PhysicsSettings(friction_cone=cone)
    assert logged in caplog.text and bool(logged) == bool(caplog.text)


def test_the_scene_is_kept():
    scene = load("""<scene><ambient>0.1 0.2 0.3 1</ambient><background>0 0 1 1</background>
      <shadows>0</shadows></scene>""").scene
    assert scene == SceneSpec((0.1, 0.2, 0.3, 1.0), (0.0, 0.0, 1.0, 1.0), False)


def test_the_view_of_the_gui_is_kept():
    camera = load(
        '<gui><camera name="user_camera"><pose>5 -5 2 0 0.5 2.36</pose>'
        '<view_controller>orbit</view_controller></camera></gui>'
    ).scene.user_camera
    assert camera == Pose((5.0, -5.0, 2.0), from_rpy(0.0, 0.5, 2.36))
    for without in ('', '<gui/>', '<gui><camera/></gui>'):
        assert load(without).scene.user_camera is None


def test_a_view_that_is_no_pose_is_left_out():
    world = load('<gui><camera><pose>5 -5 2e9 0 0 0</pose></camera></gui>')
    assert world.scene == SceneSpec()
    (sentence,) = world.faults
    assert sentence.startswith('w.world, line 1: the position of <pose> has a length of 2e+09 m')


def test_lights_of_the_world_are_kept():
    lights = load(
        '<light type="point" name="a"><pose>1 2 3 0 0 0</pose></light>'
        '<light type="directional" name="b"/>'
    ).lights
    assert [(light.name, light.type, light.pose.position) for light in lights] == [
        ('a', 'point', (1.0, 2.0, 3.0)),
        ('b', 'directional', (0.0, 0.0, 0.0)),
    ]


def test_plugins_of_the_world_are_kept():
    plugin = load('<plugin name="p" filename="lib.so"><a>1</a></plugin>').plugins[0]
    assert (plugin.name, plugin.filename, plugin.element.child('a').text) == ('p', 'lib.so', '1')


def test_a_model_without_name_is_left_out():
    assert load('<model><link name="a"/></model>').faults == (
        'w.world, line 1: a <model> without name; add name="..."',
    )


def test_omissions_are_reported_once_with_path_and_line(caplog):
    load(
        '\n<actor name="walker"><pose>0 0 0 0 0 0</pose></actor>\n<population name="p"><a>1</a>'
        '</population><wind><linear_velocity>0 0 0</linear_velocity></wind><audio><a>1</a>'
        '</audio>'
    )
    assert [record.getMessage() for record in caplog.records] == [
        'w.world: not simulated: world/actor (line 2), world/population (line 3)'
    ]


def test_saved_state_is_separate_from_the_initial_poses():
    world = load(
        BOX.format('m', '0 0 0 0 0 0')
        + """<state world_name="w">
      <sim_time>12 500000000</sim_time><real_time>3 0</real_time><iterations>7</iterations>
      <model name="m"><pose>1 0 0 0 0 0</pose><scale>1 1 1</scale>
        <link name="link"><pose>1 0 0 0 0 0</pose><velocity>9 0 0 0 0 0</velocity></link>
        <model name="in"><link name="l"><pose>2 0 0 0 0 0</pose></link></model></model></state>
      <state world_name="w"><sim_time>99 0</sim_time></state>"""
    )
    assert world.time == 12.5
    assert world.models[0][1] == Pose()
    state = world.states[0]
    assert (state.name, state.pose.position) == ('m', (1.0, 0.0, 0.0))
    assert {name: pose.position for name, pose in state.links.items()} == {
        'link': (1.0, 0.0, 0.0),
        'in::l': (2.0, 0.0, 0.0),
    }


@pytest.mark.parametrize(
    'body, part',
    [
        (
            '<physics><max_step_size>0</max_step_size></physics>',
            'line 1: <max_step_size> is wrong: step_size is 0; it must be from 1e-09 to 10 [s]',
        ),
        ('<physics><ode><solver><iters>50000</iters></solver></ode></physics>', 'from 0 to 10000'),
        (
            '<physics><real_time_update_rate>-5</real_time_update_rate></physics>',
            'from 0 to inf [Hz]',
        ),
        (
            '<physics><real_time_update_rate>1e-7</real_time_update_rate></physics>',
            'at least 0.001',
        ),
        ('<physics><max_step_size>fast</max_step_size></physics>', 'it takes one finite number'),
        ('<gravity>0 0</gravity>', 'it takes three finite numbers'),
    ],
)
def test_invalid_element_of_the_world_is_rejected(body, part):
    assert part in error_message(body)


@pytest.mark.parametrize(
    'body, logged, without',
    [
        (
            '<light type="laser" name="l"/>',
            "light type 'laser' is unknown",
            'this light is left out',
        ),
        ('<light type="point"/>', 'a <light> without name', 'this light is left out'),
        ('<light name="l"><pose>a b</pose></light>', 'it takes six finite numbers', 'this light'),
        ('<frame/>', 'a <frame> without name', 'this frame is left out'),
        ('<frame name="f"><pose>far away</pose></frame>', 'six finite', 'this frame is left out'),
        (BOX.format('b', '1 2 nan'), 'it takes six finite numbers', 'this model is left out'),
        (
            '<include><uri>model://ground_plane</uri><name>g</name><pose>a</pose></include>',
            'it takes six finite numbers',
            'this model is left out',
        ),
        ('<include><uri>https://fuel/x</uri></include>', 'not fetched', 'this model is left out'),
        ('<model/>', 'a <model> without name', 'this model is left out'),
        (
            '<state world_name="w"><model name="m"><pose>a</pose></model></state>',
            'it takes six finite numbers',
            "the world's <state> is not applied",
        ),
    ],
)
def test_invalid_element_is_left_out_of_the_world(body, logged, without, caplog):
    world = load(body + GROUND)
    assert [model.name for model, _ in world.models] == ['ground_plane']
    (fault,) = world.faults
    assert logged in fault
    (error,) = [r.getMessage() for r in caplog.records if r.levelno == logging.ERROR]
    assert error.startswith(fault) and without in error


def test_model_of_many_links_is_kept_without_its_missing_mesh(caplog):
    wall = '<collision name="c"><geometry><box><size>1 1 1</size></box></geometry></collision>'
    mailbox = (
        '<{0} name="{0}"><geometry><mesh><uri>model://letters/meshes/letters.dae</uri>'
        '</mesh></geometry></{0}>'
    )
    house = (
        f'<model name="house"><static>1</static><link name="wall">{wall}</link>'
        f'<link name="mailbox">{mailbox.format("collision")}{mailbox.format("visual")}</link>'
        '</model>'
    )
    world = load(GROUND + house)
    assert [model.name for model, _ in world.models] == ['ground_plane', 'house']
    spec = world.models[1][0]
    assert [len(link.collisions) for link in spec.links] == [1, 0]
    assert spec.left_out == ("mesh 'model://letters/meshes/letters.dae'",)
    assert world.faults == ()
    (logged,) = caplog.messages
    assert logged.endswith(
        "; left out: collision of link 'mailbox' (line 1), visual of link 'mailbox' (line 1)"
    )


@pytest.mark.parametrize(
    'pose, position, count',
    [
        ('1 2 0.5 0 0', (1.0, 2.0, 0.5), 5),
        ('1', (1.0, 0.0, 0.0), 1),
        ('1 2 3 0 0 0 7', (1.0, 2.0, 3.0), 7),
    ],
)
def test_pose_with_wrong_count_of_numbers_is_read_as_in_gazebo(pose, position, count, caplog):
    box = BOX.format('b', pose)
    include = (
        f'<include><uri>model://ground_plane</uri><name>floor</name><pose>{pose}</pose></include>'
    )
    world = load(f'{box}\n{include}')
    assert [at.position for _, at in world.models] == [position, position]
    logged = [message for message in caplog.messages if 'six numbers' in message]
    assert len(logged) == 2
    assert logged[1].startswith(f'w.world, line 2: a <pose> has six numbers, this one has {count}:')


def test_pose_within_a_plugin_is_unchanged(caplog):
    plugin = '<plugin name="p" filename="libp.so"><pose>1 2 3</pose></plugin>'
    model, _ = load(f'<model name="m"><link name="l"/>{plugin}</model>').models[0]
    assert model.plugins[0].element.child('pose').text == '1 2 3'
    assert 'six numbers' not in caplog.text


def test_error_names_a_missing_file(tmp_path):
    with pytest.raises(ModelError, match=f"world file '{tmp_path}/w.world' cannot be read"):
        open_world(tmp_path / 'w.world', find_model=ModelSearch())


def test_addresses_may_be_relative_to_the_world_file(tmp_path):
    (tmp_path / 'floor.sdf').write_text(
        '<sdf version="1.6"><model name="m"><link name="a"/></model></sdf>', encoding='utf-8'
    )
    (tmp_path / 'w.world').write_text(
        '<sdf version="1.6"><world name="w"><include><uri>floor.sdf</uri></include></world></sdf>',
        encoding='utf-8',
    )
    world = open_world(tmp_path / 'w.world', find_model=ModelSearch())
    assert [model.name for model, _ in world.models] == ['m']


def test_text_without_world_is_rejected():
    with pytest.raises(ModelError, match='it has no <world>'):
        load_world('<sdf version="1.6"/>', 'w.world', find_model=ModelSearch())
