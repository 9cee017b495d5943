"""Ogre's material scripts, which <script> names: their colours and their image.

Of the first pass of a material these are read: ambient, diffuse, specular, emissive and texture.
Parents, shaders, blending and the placing of textures are not.
"""

import os
import re
from collections.abc import Iterator
from contextlib import suppress

from lxml import etree

from ...core import Fault, ModelError, Vector, parse_numbers, report
from ...description import Material, Reflection
from ...resources import Addresses, read_file, within

MAX_SCRIPT_BYTES = 1_000_000
_COMMENT = re.compile(r'//[^\n]*|/\*.*?\*/', re.DOTALL)
_SETTING = re.compile(
    r'(?:^|{)[ \t]*(ambient|diffuse|specular|emissive|texture)[ \t]+([^\s{}][^\n{}]*)', re.MULTILINE
)


def script_material(
    element: etree._Element, name: str, addresses: Addresses, directory: str = '', home: str = ''
) -> Material | None:
    """Return a material of the scripts that the <uri>s of a <material> name, or None.

    A <uri> is a script, or a folder of scripts or images. As in Gazebo those of the resource path,
    in media/materials/scripts, need none.

    Args:
        directory, home: see `Addresses.path`.
    Raises:
        ModelError: a script cannot be read.
    """
    places = []
    for uri in element.iterfind('script/uri'):
        with suppress(ModelError):  # nothing there: Gazebo looks on, too
            places.append(addresses.path(uri, (uri.text or '').strip(), directory, home))
    places += addresses.material_folders()
    for path in _scripts(places):
        text = _COMMENT.sub(
            '', read_file(path, MAX_SCRIPT_BYTES, 'material script').decode(errors='replace')
        )
        if (body := _body(text, name)) is not None:
            folder = os.path.dirname(path)
            return _material(
                body,
                name,
                path,
                [
                    *(place for place in places if os.path.isdir(place)),
                    folder,
                    os.path.join(os.path.dirname(folder), 'textures'),
                ],
            )
    return None


def _scripts(places: list[str]) -> Iterator[str]:
    for place in places:
        if os.path.isfile(place):
            yield place
        elif os.path.isdir(place):
            yield from (
                os.path.join(place, file)
                for file in sorted(os.listdir(place))
                if file.endswith('.material')
            )


def _body(text: str, name: str) -> str | None:
    """Return what is between the braces of a material, or None."""
    head = re.search(
        rf'^\s*material\s+"?{re.escape(name)}"?\s*(?::[^{{\n]*)?\s*{{', text, re.MULTILINE
    )
    if head is None:
        return None
    depth, end = 1, head.end()
    while depth and end < len(text):
        depth += {'{': 1, '}': -1}.get(text[end], 0)
        end += 1
    return text[head.end() : end]


def _material(body: str, name: str, path: str, folders: list[str]) -> Material:
    settings: dict[str, str] = {}
    for key, value in _SETTING.findall(body):
        settings.setdefault(key, value)
    white, black = Reflection().diffuse, Reflection().specular
    diffuse = _colour(settings, 'diffuse', white)
    shininess = parse_numbers(' '.join(settings.get('specular', '').split()[3:][-1:]), 1)
    return Material(
        (*diffuse, 1.0),
        name,
        Reflection(
            _colour(settings, 'ambient', white),
            diffuse,
            _colour(settings, 'specular', black),
            shininess[0] if shininess else 0.0,
            _colour(settings, 'emissive', black),
        ),
        _image(settings['texture'], name, folders) if 'texture' in settings else '',
        path,
    )


def _colour(settings: dict[str, str], key: str, default: Vector) -> Vector:
    numbers = parse_numbers(' '.join(settings.get(key, '').split()[:3]), 3)
    return default if numbers is None else (numbers[0], numbers[1], numbers[2])


def _image(setting: str, name: str, folders: list[str]) -> str:
    """Return the path of the image of a `texture` line; '' if it is not there."""
    file = setting.split(maxsplit=1)[0].strip('"')
    for folder in folders:
        path = os.path.join(folder, file)
        if within(path, folder) and os.path.isfile(path):
            return os.path.realpath(path)
    report(Fault(f"material '{name}' names the image '{file}', which is not there"))
    return ''
