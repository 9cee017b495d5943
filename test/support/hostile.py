"""The malicious inputs that test/data/hostile/cases.yaml lists, ready to be sent."""

import os
import struct
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import yaml

FOLDER = Path(__file__).resolve().parents[1] / 'data' / 'hostile'
DESCRIPTIONS = ('urdf', 'sdf', 'world')  # every other kind is a mesh file

_INERTIAL = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>'
_BALL = '<collision><geometry><sphere radius="0.01"/></geometry></collision>'
_TRIANGLE = 'v 0 0 0\nv 1 0 0\nv 0 1 0\n'

Make = Callable[[Path], str | bytes]  # its argument is a folder for files of the case
_MADE: dict[str, tuple[str, Make]] = {}


@dataclass(frozen=True)
class Case:
    """An entry of the table; see there for the fields."""

    name: str
    kind: str  # 'urdf', 'sdf', 'world', or the suffix of a mesh file
    make: Make
    says: str = ''
    warns: str = ''
    logs: str = ''
    call_error: bool = False
    parser: str = ''
    wire_says: str = ''
    hides: str = ''
    opens: str = ''
    wire: bool = True

    def text(self, folder: Path) -> str | bytes:
        """Return the description to send; for a mesh, a robot that refers to the file.

        Args:
            folder: an empty folder for files of the case, which outlives it.
        """
        content = self.make(folder)
        if self.kind in DESCRIPTIONS:
            return content
        path = FOLDER / self.name
        if not path.is_file():
            path = folder / f'{self.name}.{self.kind}'
            path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return _mesh(path)


def cases() -> list[Case]:
    """Return all cases, in the order of the table."""
    return [_case(row) for row in yaml.safe_load((FOLDER / 'cases.yaml').read_text('utf-8'))]


def _case(row: dict) -> Case:
    row = dict(row)
    if 'made' in row:
        name = row.pop('made')
        kind, make = _MADE[name]
        return Case(name, kind, make, **row)
    name = row.pop('file')
    return Case(name, name.rpartition('.')[2], lambda _: (FOLDER / name).read_bytes(), **row)


def _made(kind: str) -> Callable[[Make], Make]:
    def add(make: Make) -> Make:
        _MADE[make.__name__] = (kind, make)
        return make

    return add


def _robot(*parts: str) -> str:
    return f'<robot name="hostile">\n{"".join(parts)}</robot>\n'


def _link(name: str, inside: str = '') -> str:
    return f'<link name="{name}">{_INERTIAL}{inside}</link>\n'


def _joint(name: str, parent: str, child: str, kind: str) -> str:
    ends = f'<parent link="{parent}"/><child link="{child}"/>'
    return f'<joint name="{name}" type="{kind}">{ends}</joint>\n'


def _mesh(path: str | os.PathLike) -> str:
    return _robot(
        _link('a', f'<collision><geometry><mesh filename="file://{path}"/></geometry></collision>')
    )


def _sdf(inside: str) -> str:
    return f'<sdf version="1.6"><model name="hostile">\n{inside}\n</model></sdf>\n'


def _include(uri: str) -> str:
    return f'<sdf version="1.6"><world name="w"><include><uri>{uri}</uri></include></world></sdf>'


def _chain(count: int, kind: str) -> str:
    """Return a robot of links in a row, on joints of a type."""
    joints = (_joint(f'j{i}', f'l{i}', f'l{i + 1}', kind) for i in range(count - 1))
    return _robot(*(_link(f'l{i}') for i in range(count)), *joints)


def _star(count: int, inside: str, kind: str, *parts: str) -> str:
    """Return a robot of links with something inside, all on joints of a type to the first link."""
    links = (_link(f'l{i}', inside) + _joint(f'j{i}', 'a', f'l{i}', kind) for i in range(count))
    return _robot(_link('a'), *links, *parts)


def _attributes(count: int) -> str:
    return ' '.join(f'a{i}=""' for i in range(count))


# Those that need no folder, made when they are needed, for some are large.
_MADE |= {
    # Elements nested 201 deep.
    'deep_nesting': ('urdf', lambda _: _robot('<a>' * 200 + '</a>' * 200)),
    # Elements nested 20 000 deep.
    'deeper_than_the_stack': ('urdf', lambda _: _robot('<a>' * 20_000 + '</a>' * 20_000)),
    # A thousand times the attributes that are accepted; libxml2 would take minutes.
    'many_attributes': ('urdf', lambda _: f'<robot {_attributes(200_000)}/>'),
    # The same with namespace declarations.
    'many_namespaces': (
        'urdf',
        lambda _: '<robot ' + ' '.join(f'xmlns:a{i}="u"' for i in range(100_000)) + '/>',
    ),
    # The same in a tag that is never closed.
    'attributes_never_closed': ('urdf', lambda _: f'<robot {_attributes(200_000)}'),
    # Three times the elements that are accepted.
    'many_elements': ('urdf', lambda _: _robot('<a/>' * 300_000)),
    # A robot of 100 MB of white space.
    'hundred_megabytes_of_blanks': ('urdf', lambda _: _robot(' ' * 100_000_000)),
    # 100 MB that are no XML.
    'hundred_megabytes_of_text': ('urdf', lambda _: 'a' * 100_000_000),
    # Four million times ${, so that a naive search for ${...} takes quadratic time.
    'dollars_that_never_close': (
        'urdf',
        lambda _: _robot(_link('a'), f'<a>{"${" * 4_000_000}</a>'),
    ),
    # A number of a million digits and a word; the error message must not quote it all.
    'long_attribute': (
        'urdf',
        lambda _: _robot(
            _link('a', _BALL.replace('<geometry>', f'<origin xyz="{"9" * 10**6} x"/><geometry>'))
        ),
    ),
    # A name longer than the engine's buffers.
    'long_name': ('urdf', lambda _: _robot(_link('a' * 1100))),
    # One joint more than the engine can hold.
    'long_chain_of_joints': ('urdf', lambda _: _chain(129, 'continuous')),
    # Three thousand links on fixed joints, which are reduced to one.
    'long_chain_of_fixed_links': ('urdf', lambda _: _chain(3_000, 'fixed')),
    # As many links as the text may have elements.
    'hundred_thousand_links': (
        'urdf',
        lambda _: _robot(*(f'<link name="l{i}"/>' for i in range(99_000))),
    ),
    # Links without joints.
    'many_links_in_sdf': (
        'sdf',
        lambda _: _sdf(''.join(f'<link name="l{i}"/>' for i in range(5_000))),
    ),
    # Links on floating joints.
    'many_free_links': ('urdf', lambda _: _star(2_000, _BALL, 'floating')),
    # Coincident collisions, each of which touches the ground.
    'many_shapes': ('urdf', lambda _: _robot(_link('a', _BALL * 10_000))),
    # More surfaces on one link than the engine allows auxiliary links.
    'many_surfaces': (
        'urdf',
        lambda _: _star(
            140,
            _BALL,
            'fixed',
            *(f'<gazebo reference="l{i}"><mu1>{0.001 * i:.3f}</mu1></gazebo>' for i in range(140)),
        ),
    ),
    # Unknown names; a search for a similar one, each time among a thousand, would be slow.
    'thousands_of_unknown_references': (
        'urdf',
        lambda _: _star(1000, '', 'fixed', *(f'<gazebo reference="k{i}"/>' for i in range(50_000))),
    ),
    # Models nested 190 deep; only the innermost has a link.
    'models_in_models': (
        'sdf',
        lambda _: _sdf('<model name="m">' * 190 + '<link name="l"/>' + '</model>' * 190),
    ),
    # Five megabytes of random bytes.
    'mesh_of_garbage': ('stl', lambda _: b'\xff\x00garbage\x80' * 500_000),
    # Nodes nested 3000 deep.
    'mesh_nested_deep': (
        'dae',
        lambda _: '<COLLADA>' + '<node>' * 3000 + '</node>' * 3000 + '</COLLADA>',
    ),
    # As `many_attributes`.
    'mesh_of_many_attributes': ('dae', lambda _: f'<COLLADA {_attributes(200_000)}/>'),
    # A material for each triangle.
    'mesh_of_many_materials': (
        'obj',
        lambda _: _TRIANGLE + ''.join(f'usemtl m{i}\nf 1 2 3\n' for i in range(50_000)),
    ),
    # Five thousand models of one name, all of which must be renamed.
    'world_of_one_name': (
        'world',
        lambda _: (
            '<sdf version="1.6"><world name="w">'
            + '<model name="m"><link name="l"/></model>' * 5_000
            + '</world></sdf>'
        ),
    ),
}


@_made('sdf')
def many_surfaces_that_stand(_: Path) -> str:
    """As `many_surfaces`, in a static model."""
    return _sdf(
        '<static>1</static><link name="l">'
        + ''.join(
            f'<collision name="c{i}"><geometry><sphere><radius>0.01</radius></sphere></geometry>'
            f'<surface><friction><ode><mu>{0.001 * i:.3f}</mu></ode></friction></surface>'
            '</collision>'
            for i in range(140)
        )
        + '</link>'
    )


@_made('urdf')
def pipe(folder: Path) -> str:
    """A mesh that is a named pipe without a writer."""
    os.mkfifo(folder / 'pipe.dae')
    return _mesh(folder / 'pipe.dae')


@_made('sdf')
def pipe_to_include(folder: Path) -> str:
    """A model that is a named pipe."""
    os.mkfifo(folder / 'pipe.sdf')
    return _include(f'file://{folder}/pipe.sdf')


@_made('urdf')
def link_out_of_package(folder: Path) -> str:
    """A symbolic link to a mesh elsewhere, as in symlinked workspaces; this is permitted."""
    (folder / 'link.obj').symlink_to(FOLDER / 'triangle.obj')
    return _mesh(folder / 'link.obj')


@_made('sdf')
def model_that_climbs(folder: Path) -> str:
    """A model of the model path that refers to a file outside its folder."""
    (folder / 'climber').mkdir()
    (folder / 'climber' / 'model.sdf').write_text(
        _sdf(
            '<link name="a"><collision name="c"><geometry><mesh><uri>../secret.obj</uri></mesh>'
            '</geometry></collision></link>'
        )
    )
    (folder / 'secret.obj').write_text(f'{_TRIANGLE}f 1 2 3\n')
    return _include('model://climber')


@_made('sdf')
def manifest_that_climbs(folder: Path) -> str:
    """A model.config that refers to a description outside its folder."""
    (folder / 'climber').mkdir()
    (folder / 'climber' / 'model.config').write_text(
        '<model><sdf version="1.6">../../etc/passwd</sdf></model>'
    )
    return _include('model://climber')


@_made('stl')
def mesh_of_half_a_million_triangles(_: Path) -> bytes:
    """25 MB of a fine surface, as from a scanner; valid, and simplified."""
    import numpy as np

    count = 501
    x, y = np.meshgrid(np.linspace(-1, 1, count), np.linspace(-1, 1, count), indexing='ij')
    points = np.stack([x, y, np.sin(5 * x) * np.cos(3 * y)], axis=2).astype('<f4')
    corners = [points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]]
    triangles = np.zeros(
        (2, (count - 1) ** 2), np.dtype([('n', '<f4', 3), ('c', '<f4', (3, 3)), ('a', '<u2')])
    )
    for i, chosen in enumerate(((0, 1, 2), (0, 2, 3))):
        triangles['c'][i] = np.stack([corners[c].reshape(-1, 3) for c in chosen], axis=1)
    return bytes(80) + struct.pack('<I', triangles.size) + triangles.tobytes()


@_made('urdf')
def mesh_too_big(folder: Path) -> str:
    """A sparse file of a terabyte."""
    with open(folder / 'big.obj', 'wb') as file:
        file.truncate(10**12)
    return _mesh(folder / 'big.obj')
