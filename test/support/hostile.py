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


def _joint(name: str, parent: str, child: str, kind: str = 'fixed', inside: str = '') -> str:
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'{inside}</joint>\n'
    )


def _mesh(path: str | os.PathLike) -> str:
    return _robot(
        _link('a', f'<collision><geometry><mesh filename="file://{path}"/></geometry></collision>')
    )


def _sdf(inside: str) -> str:
    return f'<sdf version="1.6"><model name="hostile">\n{inside}\n</model></sdf>\n'


def _include(uri: str) -> str:
    return f'<sdf version="1.6"><world name="w"><include><uri>{uri}</uri></include></world></sdf>'


@_made('urdf')
def deep_nesting(_: Path) -> str:
    """Elements nested 201 deep."""
    return _robot('<a>' * 200 + '</a>' * 200)


@_made('urdf')
def deeper_than_the_stack(_: Path) -> str:
    """Elements nested 20 000 deep."""
    return _robot('<a>' * 20_000 + '</a>' * 20_000)


@_made('urdf')
def many_attributes(_: Path) -> str:
    """As many attributes as the text may have; libxml2 would take hours."""
    return f'<robot {" ".join(f"a{i}={chr(34) * 2}" for i in range(800_000))}/>'


@_made('urdf')
def many_namespaces(_: Path) -> str:
    """The same with namespace declarations."""
    return f'<robot {" ".join(f"xmlns:a{i}={chr(34)}u{chr(34)}" for i in range(300_000))}/>'


@_made('urdf')
def attributes_never_closed(_: Path) -> str:
    """The same in a tag that is never closed."""
    return f'<robot {" ".join(f"a{i}={chr(34) * 2}" for i in range(800_000))}'


@_made('urdf')
def many_elements(_: Path) -> str:
    """A million elements."""
    return _robot('<a/>' * 1_000_000)


@_made('urdf')
def hundred_megabytes_of_blanks(_: Path) -> str:
    """A robot of 100 MB of white space."""
    return _robot(' ' * 100_000_000)


@_made('urdf')
def hundred_megabytes_of_text(_: Path) -> str:
    """100 MB that are no XML."""
    return 'a' * 100_000_000


@_made('urdf')
def dollars_that_never_close(_: Path) -> str:
    """Four million times ${, so that a naive search for ${...} takes quadratic time."""
    return _robot(_link('a'), f'<a>{"${" * 4_000_000}</a>')


@_made('urdf')
def long_attribute(_: Path) -> str:
    """A number of a million digits and a word; the error message must not quote it all."""
    return _robot(
        _link('a', _BALL.replace('<geometry>', f'<origin xyz="{"9" * 1_000_000} x"/><geometry>'))
    )


@_made('urdf')
def long_name(_: Path) -> str:
    """A name longer than the engine's buffers."""
    return _robot(_link('a' * 1100))


@_made('urdf')
def long_chain_of_joints(_: Path) -> str:
    """One joint more than the engine can hold."""
    return _robot(
        *(_link(f'l{i}') for i in range(129)),
        *(_joint(f'j{i}', f'l{i}', f'l{i + 1}', 'continuous') for i in range(128)),
    )


@_made('urdf')
def long_chain_of_fixed_links(_: Path) -> str:
    """Ten thousand links on fixed joints, which are reduced to one."""
    return _robot(
        *(_link(f'l{i}') for i in range(10_000)),
        *(_joint(f'j{i}', f'l{i}', f'l{i + 1}') for i in range(9_999)),
    )


@_made('urdf')
def hundred_thousand_links(_: Path) -> str:
    """As many links as the text may have elements."""
    return _robot(*(f'<link name="l{i}"/>' for i in range(99_000)))


@_made('sdf')
def many_links_in_sdf(_: Path) -> str:
    """Links without joints."""
    return _sdf(''.join(f'<link name="l{i}"/>' for i in range(20_000)))


@_made('urdf')
def many_free_links(_: Path) -> str:
    """Links on floating joints."""
    return _robot(
        _link('a'),
        *(_link(f'l{i}', _BALL) + _joint(f'j{i}', 'a', f'l{i}', 'floating') for i in range(5_000)),
    )


@_made('urdf')
def many_shapes(_: Path) -> str:
    """Coincident collisions, each of which touches the ground."""
    return _robot(_link('a', _BALL * 20_000))


@_made('urdf')
def many_surfaces(_: Path) -> str:
    """More surfaces on one link than the engine allows auxiliary links."""
    return _robot(
        _link('a'),
        *(
            _link(f'l{i}', _BALL)
            + _joint(f'j{i}', 'a', f'l{i}')
            + f'<gazebo reference="l{i}"><mu1>{0.001 * i:.3f}</mu1></gazebo>'
            for i in range(140)
        ),
    )


@_made('sdf')
def many_surfaces_that_stand(_: Path) -> str:
    """The same in a static model."""
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
def thousands_of_unknown_references(_: Path) -> str:
    """Unknown names; a search for a similar one, each time among a thousand, would be slow."""
    return _robot(
        _link('a'),
        *(_link(f'l{i}') + _joint(f'j{i}', 'a', f'l{i}') for i in range(1000)),
        *(f'<gazebo reference="k{i}"/>' for i in range(50_000)),
    )


@_made('sdf')
def models_in_models(_: Path) -> str:
    """Models nested 190 deep; only the innermost has a link."""
    return _sdf('<model name="m">' * 190 + '<link name="l"/>' + '</model>' * 190)


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
def mesh_of_a_million_triangles(_: Path) -> bytes:
    """Fifty megabytes of a fine surface, as from a scanner; valid, and simplified."""
    import numpy as np

    count = 708
    x, y = np.meshgrid(np.linspace(-1, 1, count), np.linspace(-1, 1, count), indexing='ij')
    points = np.stack([x, y, np.sin(5 * x) * np.cos(3 * y)], axis=2).astype('<f4')
    corners = [points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]]
    triangles = np.zeros(
        (2, (count - 1) ** 2), np.dtype([('n', '<f4', 3), ('c', '<f4', (3, 3)), ('a', '<u2')])
    )
    for i, chosen in enumerate(((0, 1, 2), (0, 2, 3))):
        triangles['c'][i] = np.stack([corners[c].reshape(-1, 3) for c in chosen], axis=1)
    return bytes(80) + struct.pack('<I', triangles.size) + triangles.tobytes()


@_made('stl')
def mesh_of_garbage(_: Path) -> bytes:
    """Five megabytes of random bytes."""
    return b'\xff\x00garbage\x80' * 500_000


@_made('dae')
def mesh_nested_deep(_: Path) -> str:
    """Nodes nested 3000 deep."""
    return '<COLLADA>' + '<node>' * 3000 + '</node>' * 3000 + '</COLLADA>'


@_made('dae')
def mesh_of_many_attributes(_: Path) -> str:
    """As `many_attributes`."""
    return f'<COLLADA {" ".join(f"a{i}={chr(34) * 2}" for i in range(800_000))}/>'


@_made('obj')
def mesh_of_many_materials(_: Path) -> str:
    """A material for each triangle."""
    return _TRIANGLE + ''.join(f'usemtl m{i}\nf 1 2 3\n' for i in range(50_000))


@_made('urdf')
def mesh_too_big(folder: Path) -> str:
    """A sparse file of a terabyte."""
    with open(folder / 'big.obj', 'wb') as file:
        file.truncate(10**12)
    return _mesh(folder / 'big.obj')


@_made('world')
def world_of_one_name(_: Path) -> str:
    """Twenty thousand models of one name, all of which must be renamed."""
    return (
        '<sdf version="1.6"><world name="w">'
        + '<model name="m"><link name="l"/></model>' * 20_000
        + '</world></sdf>'
    )
