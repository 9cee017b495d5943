"""The <gazebo> blocks of a URDF are applied to links, joints and plugins."""

import math

import pytest
from support.urdf import INERTIAL, joint, link

from rosbots_description.sim.core.errors import ModelError
from rosbots_description.sim.core.transforms import to_rpy
from rosbots_description.sim.description.model_spec import Material, Surface
from rosbots_description.sim.formats.urdf.urdf import load_urdf
from rosbots_description.sim.formats.xml.values import ENDLESS_FRICTION

GREY = (0.7, 0.7, 0.7, 1.0)
BALL = '<geometry><sphere radius="1"/></geometry>'
FULL = f'{INERTIAL}<collision>{BALL}</collision><visual>{BALL}</visual>'
# b is at x = 1 m in a, rotated left by 90 degrees; c moves on b.
ROBOT = (
    ''.join(link(name, FULL) for name in 'abc')
    + joint('ab', 'a', 'b', 'fixed', '<origin xyz="1 0 0" rpy="0 0 1.5707963267948966"/>')
    + joint('bc', 'b', 'c')
)


def load(blocks, **options):
    return load_urdf(f'<robot name="r">{ROBOT}\n{blocks}</robot>', 'bot', source='s', **options)[0]


def tagged(inside, **options):
    """Return link c, which has a block."""
    return load(f'<gazebo reference="c">{inside}</gazebo>', **options).link('c')


def plugin(inside):
    return f'<gazebo><plugin name="p" filename="libp.so">{inside}</plugin></gazebo>'


def texts(element):
    return {child.tag: child.text for child in element.children}


def words(text):
    return [float(word) for word in text.split()]


def test_without_blocks_everything_has_sdfs_defaults():
    spec = load('')
    assert spec.static is False
    assert spec.plugins == ()
    link = spec.link('c')
    assert link.collisions[0].surface == Surface()
    assert (link.gravity, link.self_collide, link.linear_damping) == (True, False, 0.0)


@pytest.mark.parametrize('form', ['<{0}>{1}</{0}>', '<{0} value="{1}"/>', '<{0}> {1} </{0}>'])
def test_a_surface_is_read_from_text_or_attribute(form):
    values = {
        'mu1': 0.5,
        'mu2': 0.6,
        'kp': 1e6,
        'kd': 100.0,
        'maxVel': 1.0,
        'minDepth': 0.001,
        'maxContacts': 5,
        'laserRetro': 2.0,
    }
    tags = ''.join(form.format(tag, value) for tag, value in values.items())
    tags += form.format('fdir1', '1 0 0')
    surface = tagged(tags).collisions[0].surface
    assert surface == Surface(0.5, 0.6, (1.0, 0.0, 0.0), 1e6, 100.0, 1.0, 0.001, 5, 2.0)


def test_surface_in_the_structure_of_sdf_is_read():
    surface = (
        '<friction><ode><mu>0.1</mu><mu2>0.2</mu2></ode></friction>'
        '<contact><ode><kp>5</kp></ode></contact>'
    )
    collision = f'<surface>{surface}</surface><max_contacts>3</max_contacts>'
    surface = tagged(f'<collision>{collision}</collision>').collisions[0].surface
    assert (surface.mu, surface.mu2, surface.kp, surface.max_contacts) == (0.1, 0.2, 5.0, 3)


def test_surface_and_material_of_a_reduced_link_apply_to_its_own_shapes_only():
    block = '<gazebo reference="b"><mu1>0.2</mu1><material>Gazebo/Red</material></gazebo>'
    base = load(block).link('a')
    assert [shape.surface.mu for shape in base.collisions] == [1.0, 0.2]
    assert [shape.material.rgba for shape in base.visuals] == [GREY, (1.0, 0.0, 0.0, 1.0)]


@pytest.mark.parametrize('written', ['-1', 'inf', 'Infinity', '+INF'])
def test_negative_or_infinite_friction_is_unlimited(written):
    assert tagged(f'<mu1>{written}</mu1>').collisions[0].surface.mu == ENDLESS_FRICTION


@pytest.mark.parametrize(
    ('text', 'gravity'),
    [
        ('true', False),
        ('1', False),
        ('false', True),
        ('No', True),
        ('0', True),
        ('what', False),
    ],
)
def test_turn_gravity_off_reads_booleans_as_gazebo(text, gravity):
    assert tagged(f'<turnGravityOff>{text}</turnGravityOff>').gravity is gravity


def test_self_collision_and_damping_are_read():
    link = tagged('<selfCollide>Yes</selfCollide><dampingFactor>0.3</dampingFactor>')
    assert (link.self_collide, link.linear_damping, link.angular_damping) == (True, 0.3, 0.3)


def test_flag_of_a_reduced_link_applies_to_its_parent_with_a_warning(caplog):
    spec = load('<gazebo reference="b"><turnGravityOff>true</turnGravityOff></gazebo>')
    assert spec.link('a').gravity is False
    assert spec.link('c').gravity is True
    assert "'b': gravity, selfCollide or damping set for a reduced link" in caplog.text


def test_an_unknown_material_is_grey_with_a_warning(caplog):
    (visual,) = tagged('<material>Gazebo/Puce</material>').visuals
    assert visual.material == Material(script='Gazebo/Puce')
    assert "<gazebo reference='c'>: material 'Gazebo/Puce' is neither" in caplog.text


def test_visual_block_sets_the_colour():
    colours = '<ambient>0 0 0 1</ambient><diffuse>0.1 0.2 0.3 1</diffuse>'
    material = tagged(f'<visual><material>{colours}</material></visual>').visuals[0].material
    assert material.rgba == (0.1, 0.2, 0.3, 1.0)
    assert material.reflection.ambient == (0.0, 0.0, 0.0)
    assert material.reflection.diffuse == (0.1, 0.2, 0.3)


def test_static_is_a_property_of_the_model():
    assert load('<gazebo><static>true</static></gazebo>').static is True


def test_a_plugin_is_kept_with_all_its_elements_and_lines():
    (p,) = load(plugin('\n<a>1</a><b c="2"><d> x y </d></b>')).plugins
    assert (p.name, p.filename) == ('p', 'libp.so')
    assert texts(p.element) == {'a': '1', 'b': ''}
    assert p.element.child('b').attributes == {'c': '2'}
    assert p.element.child('b').child('d').text == 'x y'
    assert (p.element.line, p.element.child('a').line) == (2, 3)


def test_a_plugin_without_filename_is_ignored_with_a_warning(caplog):
    assert load('<gazebo><plugin name="p"/></gazebo>').plugins == ()
    assert "plugin 'p': a <plugin> without filename is ignored" in caplog.text


@pytest.mark.parametrize(
    ('inside', 'expected'),
    [
        ('', '/bot'),
        ('<robotNamespace>own</robotNamespace>', 'own'),
        ('<robotNamespace/>', ''),
    ],
)
def test_namespace_is_given_to_plugins_without_one(inside, expected):
    (p,) = load(plugin(inside), robot_namespace='/bot').plugins
    assert p.element.child('robotNamespace').text == expected


def test_namespace_is_given_to_plugins_in_sensors_unless_empty():
    block = '<sensor name="s"><plugin name="p" filename="l"/></sensor>'
    (sensor,) = tagged(block, robot_namespace='/bot').sensors
    assert sensor.plugins[0].element.child('robotNamespace').text == '/bot'
    (sensor,) = tagged(block).sensors
    assert sensor.plugins[0].element.children == ()


def test_namespace_with_control_characters_is_an_error():
    with pytest.raises(ModelError, match=r"robot_namespace is 'a.*which contains a control"):
        load(plugin(''), robot_namespace='a\x01b')


def test_sensors_lights_and_projectors_are_kept_in_their_link():
    link = tagged('<sensor name="s"/><light name="l"/><projector name="p"/>')
    assert [sensor.name for sensor in link.sensors] == ['s']
    assert [part.tag for part in link.parts] == ['light', 'projector']


@pytest.mark.parametrize(
    ('pose', 'expected'),
    [
        ('', (1.0, 0.0, 0.0, 0.0, 0.0, 1.5707963268)),
        ('<pose>1 0 0 0 0 0</pose>', (1.0, 1.0, 0.0, 0.0, 0.0, 1.5707963268)),
        ('<pose relative_to="b">1 0 0 0 0 0</pose>', (1.0, 1.0, 0.0, 0.0, 0.0, 1.5707963268)),
        ('<pose relative_to="a">1 0 0 0 0 0</pose>', (1.0, 0.0, 0.0, 0.0, 0.0, 0.0)),
    ],
)
def test_sensor_of_a_reduced_link_is_transformed_into_the_parent(pose, expected):
    block = f'<gazebo reference="b"><sensor name="s">{pose}<x/></sensor></gazebo>'
    (sensor,) = load(block).link('a').sensors
    pose = sensor.pose
    assert (*pose.position, *to_rpy(pose.orientation)) == pytest.approx(expected)
    assert sensor.element.child('x') is not None


def test_names_in_plugins_are_kept_and_reduced_links_have_poses():
    inside = '<bodyName>b</bodyName><frameName>c</frameName><linkName>b</linkName>'
    spec = load(plugin(inside))
    assert texts(spec.plugins[0].element) == {'bodyName': 'b', 'frameName': 'c', 'linkName': 'b'}
    ((name, (parent, pose)),) = spec.reduced.items()
    assert (name, parent) == ('b', 'a')
    assert pose.position == (1.0, 0.0, 0.0)
    assert to_rpy(pose.orientation) == pytest.approx((0.0, 0.0, math.pi / 2))


def test_omissions_are_reported_once(caplog):
    load(
        '<gazebo reference="c"><glow/><glow/></gazebo>\n<gazebo><wind/></gazebo>'
        '<gazebo reference="bc"><physics>1</physics><stopCfm>0</stopCfm></gazebo>'
    )
    assert caplog.messages == [
        "model 'bot' (s): not simulated in <gazebo> blocks: <glow> (line 2), <wind> (line 3), "
        '<physics> (line 3)'
    ]


def test_block_with_an_unknown_reference_is_reported_with_a_suggestion(caplog):
    load('<gazebo reference="ac"/>')
    assert 'there is no link or joint of that name; the block is ignored' in caplog.text


@pytest.mark.parametrize(
    ('tag', 'text'),
    [
        ('mu1', 'abc'),
        ('kp', 'nan'),
        ('kd', '-1'),
        ('fdir1', '1 0'),
        ('dampingFactor', 'x'),
    ],
)
def test_malformed_number_in_a_block_is_an_error(tag, text):
    with pytest.raises(ModelError, match=rf"^s, line 2: <gazebo reference='c'>: <{tag}> is "):
        tagged(f'<{tag}>{text}</{tag}>')


def test_empty_numbers_in_a_block_are_ignored_with_a_warning(caplog):
    surface = tagged('<mu1></mu1><kp/><mu2>0.25</mu2>').collisions[0].surface
    assert (surface.mu, surface.mu2) == (1.0, 0.25)
    assert '<mu1> is empty and ignored; give it a number' in caplog.text


def test_springs_of_joints_are_read(caplog):
    made = load(
        '<gazebo reference="bc"><springStiffness>7.5</springStiffness>'
        '<springReference>-0.5</springReference></gazebo>'
    )
    joint = next(joint for joint in made.joints if joint.name == 'bc')
    assert (joint.stiffness, joint.reference) == (7.5, -0.5)
    assert not caplog.messages
    with pytest.raises(ModelError, match='<springStiffness> is -1; it must not be negative'):
        load('<gazebo reference="bc"><springStiffness>-1</springStiffness></gazebo>')
