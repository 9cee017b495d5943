"""Textures lie on shapes the right way round."""

import numpy as np
import pytest
from PIL import Image
from support.cameras import camera_sdf

from rosbots_description.sim import Pose, World, from_rpy

TEXTURED = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset/>
<library_images><image id="i"><init_from>{image}</init_from></image></library_images>
<library_effects><effect id="e"><profile_COMMON>
 <newparam sid="s"><surface type="2D"><init_from>i</init_from></surface></newparam>
 <newparam sid="t"><sampler2D><source>s</source></sampler2D></newparam>
 <technique sid="c"><phong><emission><color>0 0 0 1</color></emission>
  <ambient><color>1 1 1 1</color></ambient><diffuse><texture texture="t" texcoord="UV"/></diffuse>
 </phong></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh>
 <source id="p"><float_array id="pa" count="12">0 -1 -1 0 1 -1 0 1 1 0 -1 1</float_array>
  <technique_common><accessor source="#pa" count="4" stride="3"><param name="X" type="float"/>
  <param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common>
 </source><source id="u"><float_array id="ua" count="8">0 0 1 0 1 1 0 1</float_array>
  <technique_common><accessor source="#ua" count="4" stride="2"><param name="S" type="float"/>
  <param name="T" type="float"/></accessor></technique_common></source>
 <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
 <triangles material="M" count="2"><input semantic="VERTEX" source="#v" offset="0"/>
  <input semantic="TEXCOORD" source="#u" offset="1" set="0"/>
  <p>0 0 2 2 1 1 0 0 3 3 2 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="w"><node><instance_geometry url="#g"><bind_material>
 <technique_common><instance_material symbol="M" target="#m"/></technique_common></bind_material>
 </instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#w"/></scene></COLLADA>"""


# Red and green at the top, blue at the bottom left.
CORNERS = Image.fromarray(
    np.array([[(255, 0, 0), (0, 255, 0)], [(0, 0, 255), (0, 0, 0)]], np.uint8)
)


def test_texture_has_the_right_orientation(tmp_path):
    """Seen along +x: y to the left, so that what is left in the image is right in the picture."""
    folder = tmp_path / 'model' / 'meshes'
    folder.mkdir(parents=True)
    CORNERS.save(folder / 'image.png')
    (folder / 'square.dae').write_text(TEXTURED.format(image='image.png'))
    with World.empty() as world:
        world.spawn(
            '<sdf version="1.6"><model name="s"><static>1</static><pose>3 0 1 0 0 0</pose>'
            f'<link name="l"><visual name="v"><geometry><mesh><uri>{folder}/square.dae'
            '</uri></mesh></geometry></visual></link></model></sdf>',
            's',
        )
        seen = world.spawn(camera_sdf(), z=1.0).sensor('s').read().pixels.astype(int)
    left, right, upper, lower = 120, 200, 80, 160  # [pixels] within the quarters of the square
    assert [
        int(seen[row, column].argmax())
        for row, column in ((upper, right), (upper, left), (lower, right))
    ] == [0, 1, 2]
    # The side that faces away from the sun has the scene's ambient light, 0.4 of 255; there is some
    # of the pixels beside in it.
    assert seen[upper, right, 0] == pytest.approx(102, abs=20)


def test_an_image_of_a_script_lies_on_the_ground_with_its_top_along_y(tmp_path):
    CORNERS.save(tmp_path / 'track.png')
    (tmp_path / 'track.material').write_text(
        'material track\n{\n technique\n {\n  pass\n  {\n   texture_unit\n   {\n    '
        'texture track.png\n   }\n  }\n }\n}\n'
    )
    with World.empty() as world:
        world.spawn(
            '<sdf version="1.6"><model name="t"><static>1</static><pose>0 0 .01 0 0 0</pose><link '
            'name="l"><visual name="v"><geometry><plane><normal>0 0 1</normal><size>2 2</size>'
            f'</plane></geometry><material><script><uri>file://{tmp_path}</uri><name>track</name>'
            '</script></material></visual></link></model></sdf>',
            't',
        )
        pose = Pose((0.0, 0.0, 3.0), from_rpy(0.0, 1.5708, 0.0))
        seen = world.spawn(camera_sdf(), pose=pose).sensor('s').read().pixels.astype(int)
    # The picture's top is +x and its left is +y.
    x_left_y_top, x_right_y_top, x_left_y_bottom = seen[160, 120], seen[80, 120], seen[160, 200]
    assert [int(one.argmax()) for one in (x_left_y_top, x_right_y_top, x_left_y_bottom)] == [
        0,
        1,
        2,
    ]
    assert seen[80, 200].max() < 60
