"""The manifests agree with the code: every import is declared, and all versions are one."""

import ast
import re
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest
from catkin_pkg.changelog import get_changelog_from_path

ROOT = Path(__file__).resolve().parents[2]
SIMULATOR = ROOT / 'companions' / 'rosbots_simulator'
# Where pip installs a module by another name.
FROM_PYPI = {
    re.split('[=<>]', line)[0]
    for path in ROOT.glob('requirements/*.pip')
    for line in path.read_text(encoding='utf-8').splitlines()
    if '==' in line
} | {'collada'}


def manifest(folder: Path) -> ElementTree.Element:
    return ElementTree.parse(folder / 'package.xml').getroot()


def imports(folder: Path) -> set[str]:
    """Return the third-party packages that a folder's modules import."""
    modules = list(folder.rglob('*.py'))
    names: set[str] = set()
    for module in modules:
        for node in ast.walk(ast.parse(module.read_text(encoding='utf-8'))):
            if isinstance(node, ast.Import):
                names |= {alias.name.partition('.')[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.level == 0:
                names.add(node.module.partition('.')[0])
    programs = [
        path
        for folder in ('benchmark', 'scripts', 'tools')  # which tests load
        for path in ROOT.glob(f'{folder}/**/*.py')
    ]
    own = {module.stem for module in [*modules, *programs]}
    own |= {inner.name for inner in folder.rglob('*/')}
    # setuptools brings distutils to a Python that has none
    return names - sys.stdlib_module_names - own - {'_typeshed', 'distutils', 'rosbots_description'}


@pytest.mark.parametrize(
    ('folder', 'package', 'kinds'),
    [
        (ROOT / 'src', SIMULATOR, ('exec_depend',)),
        (ROOT / 'test', ROOT, ('exec_depend', 'test_depend', 'buildtool_depend')),
    ],
)
def test_imports_are_declared(folder, package, kinds):
    declared = {each.text for kind in kinds for each in manifest(package).iter(kind)}
    missing = {
        name
        for name in imports(folder) - FROM_PYPI
        if not {name, f'python3-{name.replace("_", "-").lower()}'} & declared
    }
    assert missing == set()


def test_version_is_that_of_the_latest_release_in_the_changelog():
    changelog = get_changelog_from_path(str(ROOT / 'CHANGELOG.rst'), 'rosbots_description')
    version, date, _ = next(changelog.foreach_version())
    assert date is not None
    ours = (ROOT, *ROOT.glob('companions/rosbots_*'))
    assert {manifest(folder).findtext('version') for folder in ours} == {version}


def test_unreleased_changes_are_first_in_the_changelog():
    titles = re.findall(r'^(.+)\n-+$', (ROOT / 'CHANGELOG.rst').read_text(encoding='utf-8'), re.M)
    assert 'Forthcoming' not in titles[1:]
