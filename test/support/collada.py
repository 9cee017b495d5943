"""Collada files, as text."""

MATERIAL = """<library_effects><effect id="e"><profile_COMMON><technique sid="t"><lambert>
<diffuse><color>0.2 0.4 0.6 1</color></diffuse></lambert></technique></profile_COMMON></effect>
</library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>"""
INSTANCE = """<instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="mat" target="#m"/></technique_common></bind_material>
</instance_geometry>"""
VERTICES = '<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>'
SCENE = '<scene><instance_visual_scene url="#s"/></scene>'


def collada(
    points='0 0 0 1 0 0 0 1 0',
    index='0 1 2',
    unit='1',
    up='Z_UP',
    matrix='1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1',
    nodes='',
):
    """Return a file of triangles in one node with this matrix, or in these nodes."""
    numbers = len(points.split())
    return f"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="{unit}"/><up_axis>{up}</up_axis></asset>
{MATERIAL}
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="{numbers}">{points}</float_array><technique_common>
<accessor source="#pa" count="{numbers // 3}" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
{VERTICES}
<triangles count="{len(index.split()) // 3}" material="mat"><input semantic="VERTEX" source="#v"
offset="0"/><p>{index}</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s">
{nodes or f'<node><matrix>{matrix}</matrix>{INSTANCE}</node>'}
</visual_scene></library_visual_scenes>
{SCENE}</COLLADA>"""
