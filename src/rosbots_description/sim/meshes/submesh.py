"""Extract a part of a Collada file by name into a file of its own: SDF's <submesh>.

A part is the content of the <node> of that name, as in Gazebo. The rest of the file is kept, and so
are units, transforms and colours.
"""

import hashlib
from pathlib import Path

from lxml import etree

from ..core import ModelError, suggestion
from ..resources import SharedFile, SharedFiles, read_file, regular_state
from .collada_limits import ColladaError, safe_collada
from .loader import MAX_MESH_BYTES, read_mesh

_SHOWN = ('instance_geometry', 'instance_controller', 'instance_node')
_files = SharedFiles('rosbots_submeshes_')


def submesh_file(path: str, name: str, center: bool) -> SharedFile:
    """Return a file with only the part `name` of the mesh file `path`.

    The file exists as long as the returned object is held, e.g. by a model's spec.

    Args:
        center: move the centre of the part's bounding box to the origin.
    Raises:
        ModelError: the file is not readable Collada, or has no such part; or the new file cannot
            be written.
    """
    state = regular_state(path, 'mesh file')
    if not path.lower().endswith('.dae') or state.st_size > MAX_MESH_BYTES:
        raise ModelError(
            f"mesh file '{path}': only .dae files of at most {MAX_MESH_BYTES} bytes have "
            'submeshes here'
        )
    key = repr((path, state.st_mtime_ns, state.st_size, name, center)).encode()
    made = f'{Path(path).stem}_{hashlib.sha256(key).hexdigest()[:32]}.dae'
    return _files.get(made) or _files.write(made, _content(path, name, center), path)


def _content(path: str, name: str, center: bool) -> bytes:
    root = _parse(path)
    _keep_only(root, path, name)
    if center:
        _move_to_middle(root, submesh_file(path, name, center=False))
    return etree.tostring(root)


def _parse(path: str) -> etree._Element:
    content = read_file(path, MAX_MESH_BYTES, 'mesh file')
    try:
        document = safe_collada(content)
    except ColladaError as error:
        raise ModelError(f"mesh file '{path}' {error}") from error
    return etree.fromstring(
        document, etree.XMLParser(resolve_entities=False, no_network=True, huge_tree=True)
    )


def _keep_only(root: etree._Element, path: str, name: str) -> None:
    shown = [
        (node, element)
        for node in root.iterfind('.//{*}node')
        for element in node
        if isinstance(element.tag, str) and etree.QName(element).localname in _SHOWN
    ]
    names = {_name(node) for node, _ in shown}
    if name not in names:
        raise ModelError(f"mesh file '{path}' has no submesh '{name}'{suggestion(name, names)}")
    for node, element in shown:
        if _name(node) != name:
            node.remove(element)


def _name(node: etree._Element) -> str:
    return node.get('name') or node.get('id') or ''


def _move_to_middle(root: etree._Element, file: str) -> None:
    vertices, faces = read_mesh(file).triangles()
    used = vertices[faces.ravel()]
    unit = root.find('{*}asset/{*}unit')
    metres = 1.0 if unit is None else float(unit.get('meter', '1'))
    shift = -(used.min(axis=0) + used.max(axis=0)) / 2.0 / metres
    scene = next(root.iterfind('.//{*}visual_scene'))  # the file could be read, so it has one
    namespace = etree.QName(scene).namespace
    tag = f'{{{namespace}}}' if namespace else ''
    wrapper = etree.Element(f'{tag}node', id='submesh_centre')
    etree.SubElement(wrapper, f'{tag}translate').text = ' '.join(f'{x:.12g}' for x in shift)
    wrapper.extend(scene.findall('{*}node'))
    scene.insert(0, wrapper)
