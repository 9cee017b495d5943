"""Convert SDF 1.0 to 1.2, which has values in attributes, to the elements of later versions.

The tables are the rules of sdformat's conversion from 1.0 to 1.2. Beyond them the name of a contact
sensor's <collision> becomes its text, without which it would be lost. Later versions differ in
names that the readers know.
"""

from lxml import etree

FIRST_WITH_ELEMENTS = (1, 3)

# Element -> attributes that become elements of the same name, unless there is one already.
_ATTRIBUTES = {
    'state': 'time',
    'physics': 'update_rate',
    'solver': 'type dt iters precon_iters sor',
    'constraints': 'cfm erp contact_max_correcting_vel contact_surface_layer',
    'fog': 'type start end density',
    'light': 'cast_shadows',
    'spot': 'inner_angle outer_angle falloff',
    'attenuation': 'range linear constant quadratic',
    'model': 'static',
    'link': 'gravity self_collide kinematic',
    'inertial': 'mass density',
    'inertia': 'ixx ixy ixz iyy iyz izz',
    'damping': 'linear angular',
    'sensor': 'always_on update_rate visualize',
    'horizontal': 'samples resolution min_angle max_angle',
    'vertical': 'samples resolution min_angle max_angle',
    'range': 'min max resolution',
    'image': 'width height format filename scale threshold granularity',
    'clip': 'near far',
    'depth_camera': 'output',
    'collision': 'laser_retro',
    'bounce': 'restitution_coefficient threshold',
    'ode': 'mu mu2 fdir1 slip1 slip2 soft_cfm soft_erp kp kd max_vel min_depth',
    'visual': 'cast_shadows laser_retro transparency',
    'box': 'size',
    'sphere': 'radius',
    'cylinder': 'radius length',
    'mesh': 'filename scale',
    'heightmap': 'filename size',
    'plane': 'normal',
    'material': 'script',
    'axis': 'xyz',
    'axis2': 'xyz',
    'dynamics': 'damping friction',
    'limit': 'lower upper effort velocity cfm erp',
    'suspension': 'cfm erp',
}
# Element -> the attribute that becomes its text.
_TEXTS = {
    'origin': 'pose',
    'gravity': 'xyz',
    'ambient': 'rgba',
    'background': 'rgba',
    'diffuse': 'rgba',
    'specular': 'rgba',
    'emissive': 'rgba',
    'shadows': 'enabled',
    'grid': 'enabled',
    'direction': 'xyz',
    'horizontal_fov': 'angle',
    'parent': 'link',
    'child': 'link',
}
# The same, where the element has another meaning elsewhere: (parent, element) -> attribute.
_NAMED = {('contact', 'collision'): 'name'}
# (parent, element) -> the new name of the element.
_NAMES = {('link', 'damping'): 'velocity_decay'}
_FOREIGN = ('plugin',)  # their content is interpreted by their readers


def to_elements(element: etree._Element) -> None:
    """Turn attributes below `element` into elements, in place."""
    for key in _ATTRIBUTES.get(element.tag, '').split():
        value = _take(element, key)
        if value is not None and element.find(key) is None:
            etree.SubElement(element, key).text = value
            element[-1].sourceline = element.sourceline
    for child in element:
        if child.tag in _FOREIGN:
            continue
        text = _take(child, _NAMED.get((element.tag, child.tag)) or _TEXTS.get(child.tag, ''))
        if text is not None and not (child.text or '').strip():
            child.text = text
        to_elements(child)
        child.tag = (
            'pose' if child.tag == 'origin' else _NAMES.get((element.tag, child.tag), child.tag)
        )


def _take(element: etree._Element, key: str) -> str | None:
    """Remove an attribute and return its value; None if there is none."""
    return str(element.attrib.pop(key)) if key and key in element.attrib else None
