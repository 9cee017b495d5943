"""Packages: permitted imports, public names only, and a simulator without ROS."""

import ast
import re
from functools import cache

import pytest
from support import LIBRARY
from support.programs import python

MESSAGES = re.compile(r'\w+_(msgs|srvs)')

# Permitted imports between folders; imports for type checking count too.
# fmt: off
ARROWS = {
    'sim/core': '',
    'sim/description': 'sim/core',
    'sim/plugin_registry': 'sim/core',
    'sim/xacro_module': '',
    'sim/resources': 'sim/core sim/description',
    'sim/meshes': 'sim/core sim/description sim/resources',
    'sim/formats': '',
    'sim/formats/xml': 'sim/core sim/description sim/plugin_registry',
    'sim/formats/ogre': 'sim/core sim/description sim/resources',
    'sim/formats/kinematics': 'sim/core sim/description sim/formats/xml',
    'sim/formats/urdf':
        'sim/core sim/description sim/resources sim/meshes sim/plugin_registry sim/xacro_module '
        'sim/formats/xml sim/formats/kinematics sim/formats/ogre',
    'sim/formats/sdf':
        'sim/core sim/description sim/resources sim/meshes sim/plugin_registry sim/formats/xml '
        'sim/formats/kinematics sim/formats/ogre',
    'sim/physics': 'sim/core sim/description sim/meshes',
    'sim/physics/bullet': 'sim/core sim/description sim/meshes sim/physics',
    'sim/runtime': 'sim/core sim/description sim/physics sim/plugin_registry',
    'sim/plugins': 'sim/core sim/description sim/runtime sim/plugin_registry',
    'sim/plugins/drive': 'sim/core sim/description sim/runtime sim/plugin_registry sim/plugins',
    'sim/plugins/force': 'sim/core sim/description sim/runtime sim/plugin_registry sim/plugins',
    'sim/plugins/state': 'sim/core sim/runtime sim/plugin_registry sim/plugins',
    'sim/controllers':
        'sim/core sim/description sim/runtime sim/plugin_registry sim/plugins',
    'sim/controllers/drive': 'sim/core sim/description sim/runtime sim/controllers',
    'sim/rendering':
        'sim/core sim/description sim/resources sim/meshes sim/runtime sim/rendering/gl',
    'sim/rendering/gl': '',
    'sim/placement': 'sim/core sim/description sim/meshes sim/runtime',
    'sim/mapping': 'sim/core sim/description sim/meshes sim/resources sim/runtime',
    'sim/sensors/rays': 'sim/core sim/description sim/meshes sim/runtime',
    'sim/sensors':
        'sim/core sim/description sim/meshes sim/runtime sim/plugin_registry sim/plugins '
        'sim/rendering sim/sensors/rays',
    'sim/public':
        'sim/core sim/description sim/resources sim/formats sim/physics sim/runtime sim/mapping '
        'sim/plugins sim/controllers sim/sensors',
    'sim': '',
    'ros_api': '',
    'ros_api/transport': 'sim/core',
    'ros_api/messages': 'sim/core sim/description sim/runtime sim/sensors',
    'ros_api/server':
        'sim/core sim/resources sim/physics sim/runtime ros_api/transport ros_api/messages',
    'ros_api/services':
        'sim/core sim/description sim/resources sim/formats sim/physics sim/placement sim/runtime '
        'ros_api/server ros_api/messages ros_api/transport',
    'ros_api/topics':
        'sim/core sim/runtime ros_api/server ros_api/messages ros_api/transport ros_api/services',
    'ros_api/reconfigure':
        'sim/plugins sim/controllers sim/sensors '
        'ros_api/server ros_api/transport ros_api/services',
    'ros_api/adapters':
        'sim/core sim/formats sim/runtime sim/plugins sim/controllers sim/sensors '
        'ros_api/server ros_api/messages ros_api/transport ros_api/reconfigure',
    'ros_api/adapters/controllers':
        'sim/controllers sim/core sim/formats sim/runtime ros_api/adapters ros_api/messages '
        'ros_api/reconfigure ros_api/server ros_api/transport',
    'ros_api/views':
        'sim/core sim/description sim/runtime sim/rendering '
        'ros_api/server ros_api/messages ros_api/transport',
    'ros_api/clients':
        'sim/core sim/description sim/public sim/resources sim/rendering sim/runtime '
        'ros_api/messages ros_api/transport ros_api/views batch',
    'ros_api/controller_programs': 'ros_api/clients ros_api/transport',
    'ros_api/window':
        'sim/core sim/description sim/resources sim/formats '
        'ros_api/messages ros_api/transport ros_api/clients',
    'ros_api/node':
        'sim/core sim/description sim/resources sim/meshes sim/formats sim/physics sim/runtime '
        'ros_api/transport ros_api/server ros_api/services ros_api/topics ros_api/adapters '
        'ros_api/reconfigure ros_api/views',
    'batch': 'sim sim/core sim/plugins',
    'web/controls': 'sim/core sim/description',
    'web/site': 'web/controls',
    'web/scene': 'sim/core sim/description sim/meshes sim/rendering web/controls',
    'web/editing': 'sim/core sim/description web/controls web/site web/scene',
    'web/panels': 'sim/core sim/description sim/rendering web/controls web/site web/scene',
    'web': 'sim/core sim/description web/controls web/site web/scene web/editing web/panels',
    'viewer':
        'sim sim/controllers sim/core sim/description sim/formats sim/physics sim/placement '
        'sim/plugins sim/resources sim/runtime sim/sensors web',
    'gym':
        'sim sim/controllers sim/core sim/description sim/plugins sim/rendering sim/runtime '
        'sim/sensors viewer',
    'gym/tasks': 'gym sim sim/description sim/rendering',
    'cli':
        'sim/core sim/xacro_module ros_api/transport ros_api/clients ros_api/controller_programs '
        'ros_api/window ros_api/node web viewer batch',
    '': '',
}
# fmt: on
# Upwards, but only within a function, when it is called: World.show and World.recording.
LATE = {('sim/public', 'viewer')}


@cache
def modules():
    """Return the syntax tree of each module, by its path without suffix."""
    return {
        path.relative_to(LIBRARY).with_suffix('').as_posix(): ast.parse(path.read_text())
        for path in sorted(LIBRARY.rglob('*.py'))
    }


def folder_of(module):
    return module.rpartition('/')[0]


def imports():
    """Yield importing module, imported module or package, and name, of all relative imports."""
    for module, tree in modules().items():
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and node.level:
                above = module.split('/')[: -node.level]
                source = '/'.join([*above, *(node.module or '').split('.')]).rstrip('/')
                for alias in node.names:
                    inner = f'{source}/{alias.name}'.lstrip('/')
                    if inner in modules() or f'{inner}/__init__' in modules():
                        yield module, inner, None
                    else:
                        yield module, source, alias.name


def room_of(imported):
    """Return the folder of a module, or of a package."""
    return folder_of(imported) if imported in modules() else imported


@cache
def arrows():
    """Return the pairs (importing folder, imported folder).

    An __init__.py may also import from its subfolders, to register or to re-export.
    """
    pairs = {(module, folder_of(module), room_of(imported)) for module, imported, _ in imports()}
    return {
        (a, b)
        for module, a, b in pairs
        if a != b
        and (a, b) not in LATE
        and not (module.endswith('__init__') and b.startswith(f'{a}/'))
    }


@cache
def public_names(room):
    """Return the public names of a room's __init__.py."""
    for node in modules()[f'{room}/__init__'].body:
        if isinstance(node, ast.Assign) and node.targets[0].id == '__all__':
            return set(ast.literal_eval(node.value))
    return set()


@cache
def imported_packages(tree):
    """Return the external packages that a module imports, within functions too."""
    names = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names |= {alias.name.split('.')[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            names.add(node.module.split('.')[0])
    return names


def test_every_folder_is_in_the_table_and_has_a_docstring():
    assert {folder_of(module) for module in modules()} == set(ARROWS)
    for folder in ARROWS:
        assert ast.get_docstring(modules()[f'{folder}/__init__'.lstrip('/')])


@pytest.mark.parametrize('folder', ARROWS)
def test_folder_imports_only_from_those_in_the_table(folder):
    found = {b for a, b in arrows() if a == folder}
    assert found <= set(ARROWS[folder].split())


def test_late_imports_are_within_functions_or_for_types():
    late = {
        (module, imported)
        for module, imported, _ in imports()
        if (folder_of(module), room_of(imported)) in LATE
    }
    assert {(folder_of(a), room_of(b)) for a, b in late} == LATE
    for module, _ in late:
        at_once = [node for node in modules()[module].body if isinstance(node, ast.ImportFrom)]
        assert not any('viewer' in (node.module or '') for node in at_once)


def test_other_rooms_do_not_import_from_nested_rooms_of_the_simulator():
    inner = [(a, b) for a, b in arrows() if not a.startswith('sim') and b.count('/') > 1]
    assert inner == []  # re-export names in the outer room instead


def test_imports_between_folders_have_no_cycles():
    below = {a: {b for x, b in arrows() if x == a} for a in ARROWS}
    while below:
        lowest = {folder for folder, others in below.items() if not others & set(below)}
        assert lowest, f'import cycle among {sorted(below)}'
        below = {folder: others for folder, others in below.items() if folder not in lowest}


def test_the_simulator_is_at_most_eight_rooms_deep():
    @cache
    def depth(room):
        return 1 + max((depth(b) for a, b in arrows() if a == room), default=0)

    assert max(depth(room) for room in ARROWS if room.startswith('sim/')) <= 8


def test_folders_use_each_others_public_names_only():
    private = []
    for module, imported, name in imports():
        own, room = folder_of(module), room_of(imported)
        if (
            own == room
            or own.startswith(f'{room}/')
            or (module.endswith('__init__') and room.startswith(f'{own}/'))
        ):
            continue  # a nested room may use the modules of the outer one
        wanted = name if imported == room else imported.rpartition('/')[2]
        if wanted is not None and wanted not in public_names(room):
            private.append(f'{module}: {imported} {name or ""}')
    assert private == []


def test_public_names_exist():
    for module, tree in modules().items():
        room = folder_of(module)
        if module.endswith('/__init__'):
            bound = {
                alias.name
                for node in ast.walk(tree)
                if isinstance(node, ast.ImportFrom)
                for alias in node.names
            }
            files = {name.rpartition('/')[2] for name in modules() if folder_of(name) == room}
            assert public_names(room) <= bound | files


def _last_name(base: ast.expr) -> str:
    return ast.unparse(base).rpartition('.')[2]


def test_class_names_are_unique():
    where = {}
    for module, tree in modules().items():
        for node in tree.body:
            # A subclass may have the name of its base class.
            if isinstance(node, ast.ClassDef) and node.name not in map(_last_name, node.bases):
                where.setdefault(node.name, []).append(module)
    assert {name: found for name, found in where.items() if len(found) > 1} == {}


def test_pybullet_is_imported_in_one_place():
    using = [name for name, tree in modules().items() if 'pybullet' in imported_packages(tree)]
    assert using == ['sim/physics/bullet/client']


def test_only_the_engine_on_pybullet_knows_pybullet():
    using = {folder_of(module) for module, _, name in imports() if name == 'pybullet'}
    assert using == {'sim/physics/bullet'}


def test_only_ros_api_imports_rospy():
    using = [name for name, tree in modules().items() if 'rospy' in imported_packages(tree)]
    assert using
    assert all(name.startswith('ros_api/') for name in using)


def test_only_transport_touches_rospys_internals():
    inner = {'impl', 'core', 'topics', 'exceptions', 'rostime', '_connection_header'}
    found = []
    for module, tree in modules().items():
        if folder_of(module) == 'ros_api/transport':
            continue
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and not node.level:
                if node.module.startswith('rospy.'):
                    found.append((module, node.module))
            elif isinstance(node, ast.Attribute) and node.attr in inner:
                found.append((module, ast.unparse(node)))
    assert found == []


def test_the_simulator_imports_no_messages():
    found = {
        (module, name)
        for module, tree in modules().items()
        if module.startswith('sim/')
        for name in imported_packages(tree)
        if MESSAGES.fullmatch(name)
    }
    assert not found


def test_no_module_imports_this_library_by_a_name():
    using = [
        name
        for name, tree in modules().items()
        if imported_packages(tree) & {'rosbots_description', 'rosbots_simulator'}
    ]
    assert using == []  # a user's package may have the same name, and the other is a symbolic link


def test_the_simulator_needs_no_ros():
    names = [
        f'rosbots_description.{name.removesuffix("/__init__").replace("/", ".")}'
        for name in modules()
        if name.startswith('sim/')
    ]
    program = (
        "import importlib, sys; sys.modules['rospy'] = None\n"
        'for name in sys.argv[1:]: importlib.import_module(name)\n'
        "print(*(name for name in sys.modules if name.endswith(('_msgs', '_srvs'))))"
    )
    ended = python(program, *names)
    assert (ended.returncode, ended.stdout.strip(), ended.stderr) == (0, '', '')
