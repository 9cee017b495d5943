"""Make elements of an SDF 1.7 document: numbers so that they are read as the same."""

from lxml import etree

from ...core import IDENTITY, Pose
from ...description import Element, PluginSpec
from .exact import NAMESPACE, QUATERNION, REDUCED, angles_of, quaternion_text

Value = str | bool | float | tuple[float, ...]


def new_document() -> etree._Element:
    """Return the root of an empty document."""
    return etree.Element('sdf', version='1.7', nsmap={'rosbots': NAMESPACE})


def text_of_document(root: etree._Element) -> str:
    """Return a document as text, without what nothing in it needs."""
    etree.cleanup_namespaces(root)
    etree.indent(root)
    return etree.tostring(root, encoding='unicode')


def remove_ours(root: etree._Element) -> None:
    """Leave only SDF in a document: the frames of reduced links and our attributes go."""
    for frame in root.findall(f'.//frame[@{REDUCED}]'):
        frame.getparent().remove(frame)  # type: ignore[union-attr]  # it is not the root
    etree.strip_attributes(root, f'{{{NAMESPACE}}}*')


def text_of_value(value: Value) -> str:
    """Return a value as the text of an element."""
    if isinstance(value, str):
        return value
    if isinstance(value, bool):
        return str(int(value))
    numbers = value if isinstance(value, tuple) else (value,)
    return ' '.join(repr(number).removesuffix('.0') for number in numbers)


def put(parent: etree._Element, path: str, value: Value, default: Value | None = None) -> None:
    """Write a value at a path below an element, unless it is the default."""
    if value == default:
        return
    for tag in path.split('/'):
        child = parent.find(tag)
        parent = etree.SubElement(parent, tag) if child is None else child
    parent.text = text_of_value(value)


def put_pose(parent: etree._Element, pose: Pose) -> None:
    """Give an element a <pose>, unless it is the identity."""
    if pose != IDENTITY:
        add_pose(parent, pose)


def add_pose(parent: etree._Element, pose: Pose) -> None:
    """Give an element a <pose>."""
    rpy = angles_of(pose.orientation)
    element = etree.SubElement(parent, 'pose')
    element.text = text_of_value((*pose.position, *rpy))
    quaternion = quaternion_text(pose.orientation, rpy)
    if quaternion:
        element.set(QUATERNION, quaternion)


def add_element(parent: etree._Element, spec: Element) -> etree._Element:
    """Add an element as it was written, with all that is in it."""
    element = etree.SubElement(parent, spec.tag, dict(spec.attributes))
    element.text = spec.text or None
    for child in spec.children:
        add_element(element, child)
    return element


def add_plugin(parent: etree._Element, spec: PluginSpec) -> None:
    """Add a <plugin>."""
    plugin = add_element(parent, spec.element)
    plugin.set('name', spec.name)
    plugin.set('filename', spec.filename)
