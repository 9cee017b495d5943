"""Check a description file as the simulator reads it, or show it as SDF; without a ROS master."""

from lxml import etree

from ...sim.core import ModelError
from ...sim.formats import load_sdf, load_urdf, open_world, sdf_of_model
from ...sim.resources import MAX_XML_BYTES, parse_xml, read_file, root_tag
from .packages import SEARCHES

_NAME = 'model'  # of what is checked; the one in the file has no effect


def check_description(path: str) -> tuple[str, ...]:
    """Return what is wrong with a world, an SDF model or a URDF; warnings are logged.

    Raises:
        ModelError: it cannot be read, or is none of these.
    """
    text = read_file(path, MAX_XML_BYTES)
    if root_tag(text) == 'robot':
        load_urdf(text, _NAME, source=path, **SEARCHES)
    elif parse_xml(text, path).find('world') is not None:
        return open_world(path, **SEARCHES).faults
    else:
        load_sdf(text, _NAME, source=path, **SEARCHES)
    return ()


def sdf_text(path: str) -> str:
    """Return the text of an SDF file, or a URDF as SDF after fixed joint reduction.

    Raises:
        ModelError: it cannot be read, or is neither.
    """
    text = read_file(path, MAX_XML_BYTES)
    root = parse_xml(text, path)
    if root.tag == 'robot':
        spec, pose = load_urdf(text, root.get('name') or _NAME, source=path, **SEARCHES)
        return sdf_of_model(spec, pose)
    if root.tag not in ('sdf', 'gazebo'):
        raise ModelError(f"'{path}' is not SDF: its first element is <{root.tag}>")
    return etree.tostring(root, encoding='unicode')
