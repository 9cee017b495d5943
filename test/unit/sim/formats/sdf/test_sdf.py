"""Models from SDF; omissions are reported, invalid text is rejected."""

import logging
import math
from pathlib import Path

import pytest
from support.collada import INSTANCE, collada
from support.refusals import sentence_of

from rosbots_description.sim.core.errors import ModelError
from rosbots_description.sim.core.transforms import Pose
from rosbots_description.sim.description import (
    Box,
    Cylinder,
    Material,
    Plane,
    Sphere,
    Surface,
    gazebo_material,
)
from rosbots_description.sim.description.built_in import GROUND_PLANE
from rosbots_description.sim.formats.sdf.sdf import load_sdf, load_sdf_light
from rosbots_description.sim.formats.xml.values import ENDLESS_FRICTION
from rosbots_description.sim.meshes.loader import check_mesh, read_mesh
from rosbots_description.sim.resources.search_path import ModelSearch

BOX_SHAPE = '<box><size>1 1 1</size></box>'
BOX = f'<geometry>{BOX_SHAPE}</geometry>'
TRIANGLE = 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n'


def load(body, version='1.6', **options):
    text = f'<sdf version="{version}"><model name="own">{body}</model></sdf>'
    options = {'find_model': ModelSearch()} | options
    return load_sdf(text, 'bot', source='bot.sdf', **options)[0]


def link(inside='', name='a'):
    return f'<link name="{name}">{inside}</link>'


def shaped(shape, more=''):
    """Return a link with a collision."""
    return link(f'<collision name="c"><geometry>{shape}</geometry>{more}</collision>')


def only(inside=''):
    """Return the link of a model that has one."""
    return load(link(inside)).links[0]


def collision(inside):
    return only(f'<collision name="c">{inside}</collision>').collisions[0]


def visual(inside):
    return only(f'<visual name="v">{inside}{BOX}</visual>').visuals[0]


def error_message(body):
    sentence = sentence_of(ModelError, load, body)
    assert sentence.startswith('bot.sdf, line ')
    return sentence


def warnings_of(caplog, body, **options):
    with caplog.at_level(logging.DEBUG):
        load(body, **options)
    return [r.getMessage() for r in caplog.records if r.levelno == logging.WARNING]


def test_model_gets_the_spawn_name_and_keeps_its_own_pose():
    text = (
        '<sdf version="1.6"><model name="x"><pose>1 2 3 0 0 0</pose><link name="a"/></model></sdf>'
    )
    spec, pose = load_sdf(text, 'bot', find_model=ModelSearch())
    assert spec.name == 'bot'
    assert pose == Pose((1.0, 2.0, 3.0))


def test_root_element_gazebo_is_accepted():
    text = '<gazebo version="1.3"><model name="x"><link name="a"/></model></gazebo>'
    assert load_sdf(text, 'bot', find_model=ModelSearch())[0].links[0].name == 'a'


def test_malformed_pose_of_the_model_is_ignored(caplog):
    text = '<sdf version="1.6"><model name="x"><pose>1 left</pose><link name="a"/></model></sdf>'
    assert load_sdf(text, 'bot', find_model=ModelSearch())[1] == Pose()
    assert 'six finite numbers' in caplog.text


def test_the_built_in_ground_plane_is_the_one_of_the_empty_world():
    text = (
        '<sdf version="1.6"><world name="w"><include><uri>model://ground_plane</uri></include>'
        '</world></sdf>'
    )
    spec, _ = load_sdf(text, 'ground_plane', find_model=ModelSearch())
    assert spec == GROUND_PLANE


def test_default_mass_and_moments_are_one():
    inertial = only().inertial
    assert (inertial.mass, inertial.ixx, inertial.iyy, inertial.izz) == (1.0, 1.0, 1.0, 1.0)
    assert (inertial.ixy, inertial.ixz, inertial.iyz) == (0.0, 0.0, 0.0)


def test_an_inertial_is_read_with_its_own_pose():
    inertial = only(
        '<inertial><mass>2</mass><pose>0 0 0.5 0 0 0</pose><inertia><ixx>0.1</ixx><iyy>0.2</iyy>'
        '<izz>0.25</izz><ixy>0.01</ixy><ixz>0</ixz><iyz>0</iyz></inertia></inertial>'
    ).inertial
    assert (inertial.mass, inertial.pose) == (2.0, Pose((0.0, 0.0, 0.5)))
    assert (inertial.ixx, inertial.iyy, inertial.izz, inertial.ixy) == (0.1, 0.2, 0.25, 0.01)


def test_zero_inertia_becomes_that_of_a_ball(caplog):
    inertia = '<inertia><ixx>0</ixx><iyy>0</iyy><izz>0</izz></inertia>'
    assert only(f'<inertial>{inertia}</inertial>').inertial.ixx > 0.0
    assert "link 'a': an inertia of zero" in caplog.text


def test_static_model_may_have_any_mass():
    spec = load('<static>true</static>' + link('<inertial><mass>0</mass></inertial>'))
    assert spec.static
    assert spec.links[0].inertial is None


@pytest.mark.parametrize(
    'shape, expected',
    [
        ('<box><size>1 2 3</size></box>', Box((1.0, 2.0, 3.0))),
        ('<sphere><radius>0.5</radius></sphere>', Sphere(0.5)),
        ('<cylinder><radius>0.5</radius><length>2</length></cylinder>', Cylinder(0.5, 2.0)),
    ],
)
def test_a_shape_has_its_size(shape, expected):
    assert collision(f'<geometry>{shape}</geometry>').geometry == expected


def test_a_plane_has_a_unit_normal():
    body = shaped('<plane><normal>0 0 2</normal><size>3 4</size></plane>')
    plane = load('<static>1</static>' + body).links[0].collisions[0].geometry
    assert plane == Plane((0.0, 0.0, 1.0), (3.0, 4.0))


def test_plane_in_a_movable_model_is_left_out_and_reported(caplog):
    assert load(shaped('<plane/>')).links[0].collisions == ()
    assert 'an infinite plane cannot move' in caplog.text


def test_mesh_is_found_on_the_model_path_and_scaled(tmp_path):
    (tmp_path / 'chair' / 'meshes').mkdir(parents=True)
    (tmp_path / 'chair' / 'meshes' / 'seat.obj').write_text(TRIANGLE, encoding='ascii')
    uri = 'model://chair/meshes/seat.obj'
    mesh = f'<geometry><mesh><uri>{uri}</uri><scale>2 2 1</scale></mesh></geometry>'
    body = link(f'<visual name="v">{mesh}</visual>')
    (visual,) = load(body, find_model=ModelSearch([tmp_path])).links[0].visuals
    assert visual.geometry.path == str(tmp_path / 'chair' / 'meshes' / 'seat.obj')
    assert (visual.geometry.scale, visual.geometry.uri) == ((2.0, 2.0, 1.0), uri)
    assert visual.material is None


def test_a_mesh_without_address_is_left_out_and_the_model_stays(caplog):
    assert only('<visual name="v"><geometry><mesh/></geometry></visual>').visuals == ()
    assert 'a <mesh> without <uri>; add <uri>model://MODEL/meshes/FILE</uri>' in caplog.text


def test_negative_limits_of_contacts_that_gazebo_writes_are_accepted():
    limits = '<max_vel>-1</max_vel><min_depth>-1</min_depth>'
    surface = collision(f'{BOX}<surface><contact><ode>{limits}</ode></contact></surface>').surface
    assert (surface.max_vel, surface.min_depth) == (0.0, 0.0)


def test_a_mesh_of_a_package_is_found(tmp_path):
    (tmp_path / 'seat.obj').write_text(TRIANGLE, encoding='ascii')
    body = link(
        '<visual name="v"><geometry><mesh><uri>package://furniture/seat.obj</uri></mesh>'
        '</geometry></visual>'
    )
    spec = load(body, find_package={'furniture': str(tmp_path)}.get)
    assert spec.links[0].visuals[0].geometry.path == str(tmp_path / 'seat.obj')


def load_submesh(tmp_path, name, center):
    """Return a link with one submesh of a file of two triangles in units of 0.01 m."""
    file = tmp_path / 'two.dae'
    if not file.exists():
        file.write_text(two_triangles(), encoding='utf-8')
    part = f'<submesh><name>{name}</name><center>{center}</center></submesh>'
    return load(shaped(f'<mesh><uri>file://{file}</uri>{part}</mesh>')).links[0]


def submesh(tmp_path, name, center):
    """Return the vertices of such a submesh [m]."""
    shape = load_submesh(tmp_path, name, center).collisions[0].geometry
    vertices, faces = read_mesh(shape.path).triangles()
    return vertices[faces.ravel()]


def two_triangles():
    nodes = (
        f'<node name="{name}"><translate>{x} 0 0</translate>{INSTANCE}</node>'
        for name, x in (('left', 1000), ('right', -1000))
    )
    return collada('0 0 0 100 0 0 0 200 0', unit='0.01', nodes=''.join(nodes))


def test_submesh_is_only_one_part_of_its_file(tmp_path):
    corners = submesh(tmp_path, 'left', 'false')
    assert corners.min(axis=0) == pytest.approx((10.0, 0.0, 0.0))
    assert corners.max(axis=0) == pytest.approx((11.0, 2.0, 0.0))


def test_centred_submesh_has_its_centre_at_the_origin(tmp_path):
    corners = submesh(tmp_path, 'right', 'true')
    assert corners.min(axis=0) == pytest.approx((-0.5, -1.0, 0.0))
    assert corners.max(axis=0) == pytest.approx((0.5, 1.0, 0.0))


@pytest.mark.parametrize('center', ['false', 'true'])
def test_file_of_a_submesh_exists_as_long_as_its_model(tmp_path, center):
    first, second = (load_submesh(tmp_path, 'left', center) for _ in range(2))
    file = Path(str(first.collisions[0].geometry.path))
    assert second.collisions[0].geometry.path == str(file)
    check_mesh(second.collisions[0].geometry.path)
    del first
    assert [file] == list(file.parent.iterdir())
    del second
    assert list(file.parent.iterdir()) == []
    again = load_submesh(tmp_path, 'left', center)
    assert again.collisions[0].geometry.path == str(file)
    assert file.exists()


def test_unknown_submesh_is_left_out_and_a_similar_one_suggested(tmp_path, caplog):
    with pytest.raises(IndexError):  # the link has no shape
        submesh(tmp_path, 'lef', 'false')
    assert "no submesh 'lef'; did you mean 'left'" in caplog.text


@pytest.mark.parametrize('uri', ['model://../secret.dae', 'model://a/../../secret.dae'])
def test_path_out_of_the_model_path_is_rejected(uri):
    assert "'..' is not accepted" in error_message(shaped(f'<mesh><uri>{uri}</uri></mesh>'))


def test_heightmap_is_reported_with_path_and_line(caplog):
    shape = '<heightmap><uri>x.png</uri></heightmap>'
    message = warnings_of(caplog, '\n' + shaped(shape))
    assert message == ['bot.sdf: not simulated: model/link/collision/geometry/heightmap (line 2)']


def test_a_surface_has_sdfs_defaults():
    assert collision(BOX).surface == Surface()


def test_a_surface_is_read():
    surface = collision(
        BOX
        + """<max_contacts>5</max_contacts><laser_retro>7</laser_retro>
      <surface><friction><ode><mu>0.3</mu><mu2>0.2</mu2><fdir1>1 0 0</fdir1></ode></friction>
      <contact><ode><kp>1e6</kp><kd>10</kd><max_vel>0.1</max_vel><min_depth>0.001</min_depth>
      </ode></contact></surface>"""
    ).surface
    assert surface == Surface(0.3, 0.2, (1.0, 0.0, 0.0), 1e6, 10.0, 0.1, 0.001, 5, 7.0)


@pytest.mark.parametrize('mu', ['-1', 'inf', 'Infinity'])
def test_negative_or_infinite_friction_is_unlimited(mu):
    surface = collision(BOX + f'<surface><friction><ode><mu>{mu}</mu></ode></friction></surface>')
    assert surface.surface.mu == ENDLESS_FRICTION


def test_a_script_of_gazebo_gives_its_colour():
    inside = '<material><script><name>Gazebo/Red</name><uri>file://media</uri></script></material>'
    assert visual(inside).material == gazebo_material('Gazebo/Red')


def test_diffuse_colour_takes_precedence_over_the_script():
    inside = (
        '<material><script><name>Gazebo/Red</name></script><ambient>0 1 0 1</ambient>'
        '<diffuse>0 0 1</diffuse></material>'
    )
    material = visual(inside).material
    assert (material.rgba, material.script) == ((0.0, 0.0, 1.0, 1.0), 'Gazebo/Red')
    assert material.reflection.ambient == (0.0, 1.0, 0.0)
    assert material.reflection.diffuse == (0.0, 0.0, 1.0)
    assert material.reflection.specular == (0.1, 0.1, 0.1)  # the script's


def test_transparency_reduces_alpha():
    inside = '<material><diffuse>0 0 1 1</diffuse></material><transparency>0.25</transparency>'
    assert visual(inside).material.rgba == (0.0, 0.0, 1.0, 0.75)


def test_unknown_script_is_grey_and_reported(caplog):
    inside = '<material><script><name>Road1/Image</name></script></material>'
    assert visual(inside).material == Material(script='Road1/Image')
    assert "material 'Road1/Image'" in caplog.text


def test_invisible_visual_is_left_out():
    assert only(f'<visual name="v"><visible>0</visible>{BOX}</visual>').visuals == ()


def test_flags_of_a_link_are_read():
    made = only(
        '<gravity>0</gravity><self_collide>1</self_collide><kinematic>true</kinematic>'
        '<velocity_decay><linear>0.1</linear><angular>0.2</angular></velocity_decay>'
    )
    assert (made.gravity, made.self_collide, made.kinematic) == (False, True, True)
    assert (made.linear_damping, made.angular_damping) == (0.1, 0.2)


def test_self_collide_of_a_link_defaults_to_that_of_the_model():
    other = link('<self_collide>0</self_collide>', 'b')
    body = '<self_collide>true</self_collide>' + link() + other
    assert [made.self_collide for made in load(body).links] == [True, False]


def test_duplicate_names_of_shapes_become_unique():
    shape = f'<collision name="c">{BOX}</collision>'
    assert [made.name for made in only(shape + shape).collisions] == ['c', 'c_1']


def test_sensors_and_plugins_are_kept_with_their_lines():
    spec = load(
        link('<sensor name="s" type="ray"><update_rate>5</update_rate></sensor>')
        + '\n<plugin name="p" filename="lib.so"><a>1</a></plugin>'
    )
    sensor, plugin = spec.links[0].sensors[0], spec.plugins[0]
    assert (sensor.type, sensor.update_rate) == ('ray', 5.0)
    assert (plugin.name, plugin.filename, plugin.element.child('a').text) == ('p', 'lib.so', '1')
    assert plugin.element.line == 2


def test_namespace_is_given_to_plugins_without_one():
    spec = load(
        link() + '<plugin name="p" filename="a.so"/><plugin name="q" filename="b.so">'
        '<robotNamespace/></plugin>',
        robot_namespace='/r1',
    )
    assert [p.element.child('robotNamespace').text for p in spec.plugins] == ['/r1', '']


def test_omissions_are_reported_once_with_path_and_line(caplog):
    body = link('<audio_source>x</audio_source><battery>y</battery>')
    body += '\n' + link('<battery>z</battery>', 'b')
    assert warnings_of(caplog, body) == [
        'bot.sdf: not simulated: model/link/audio_source (line 1), '
        'model/link/battery (line 1 and 1 more)'
    ]


def test_elements_without_effect_are_not_reported(caplog):
    body = (
        link(
            f'<enable_wind>0</enable_wind><collision name="c">{BOX}<surface><bounce/>'
            '<friction><torsional><ode/></torsional><ode/></friction><contact><ode/></contact>'
            '</surface></collision>'
        )
        + '<allow_auto_disable>1</allow_auto_disable>'
    )
    assert warnings_of(caplog, body) == []


def test_spawned_light_has_the_requested_name():
    text = """<sdf version="1.6"><light type="spot" name="lamp"><pose>0 0 3 0 0 0</pose>
      <diffuse>1 0.5 0 1</diffuse><direction>0 0 -1</direction><cast_shadows>1</cast_shadows>
      <attenuation><range>20</range><constant>0.5</constant><linear>0.1</linear>
      <quadratic>0.01</quadratic></attenuation></light></sdf>"""
    light = load_sdf_light(text, 'kitchen')
    assert (light.name, light.type, light.pose.position) == ('kitchen', 'spot', (0.0, 0.0, 3.0))
    assert (light.diffuse, light.cast_shadows) == ((1.0, 0.5, 0.0, 1.0), True)
    assert (light.range, light.attenuation_constant) == (20.0, 0.5)
    assert (light.attenuation_linear, light.attenuation_quadratic) == (0.1, 0.01)


def test_model_is_not_read_as_a_light():
    assert load_sdf_light('<sdf version="1.6"><model name="m"/></sdf>', 'm') is None


def test_a_pose_in_degrees_or_as_a_quaternion_is_understood():
    spec = load(
        link('<pose degrees="true">0 0 0 0 0 90</pose>')
        + link('<pose rotation_format="quat_xyzw">0 0 0 0 0 2 2</pose>', 'b')
    )
    quarter = math.sqrt(0.5)
    for made in spec.links:
        assert made.pose.orientation == pytest.approx((0.0, 0.0, quarter, quarter))


@pytest.mark.parametrize(
    'body, part',
    [
        ('', 'the model has no <link>'),
        (link(name=''), 'a <link> without name'),
        (link(name='world'), "a link cannot be called 'world'"),
        (link() + link(), "there are two links 'a'"),
        (link('<inertial><mass>-1</mass></inertial>'), 'mass -1 kg is not valid'),
        (link('<inertial><mass>heavy</mass></inertial>'), "<mass> is 'heavy'"),
        (link('<inertial><inertia><ixx>-1</ixx></inertia></inertial>'), '<ixx> is -1'),
        (link('<pose>0 0 nan 0 0 0</pose>'), 'it takes six finite numbers'),
        (link('<collision name="c"/>'), "<collision name='c'> has no shape"),
        (shaped('<box/>'), '<box> has no <size>'),
        (shaped('<sphere><radius>-1</radius></sphere>'), 'a size must be greater than zero'),
        (shaped('<torus/>'), "geometry 'torus' is unknown"),
        (
            shaped(BOX_SHAPE, '<surface><contact><ode><kp>-5</kp></ode></contact></surface>'),
            '<kp> is -5; it must not be negative',
        ),
    ],
)
def test_invalid_element_is_rejected_with_location_and_reason(body, part):
    assert part in error_message(body)


@pytest.mark.parametrize(
    'text, part',
    [
        ('<robot name="r"/>', 'the first element is <robot>'),
        ('<sdf version="1.6"/>', 'neither a <model> nor a <world> with an <include>'),
        ('<sdf version="new"><model name="m"/></sdf>', 'version="new" is not valid'),
        ('<sdf version="1.6"><model name="m">', 'not well-formed XML'),
    ],
)
def test_text_that_is_not_sdf_is_rejected(text, part):
    with pytest.raises(ModelError, match=part):
        load_sdf(text, 'm', find_model=ModelSearch())


def test_a_newer_version_is_read_as_the_newest_known_one(caplog):
    assert load(link(), version='1.9').links
    assert 'SDF 1.9 is newer than 1.7' in caplog.text
