"""./rosbots navigation: what it gets and builds, decided without network by the manifests' facts.

The sources cannot be had where tests run. Their manifests are written from test/data/navigation,
and the repositories that are cloned are made here.
"""

import os
import re
import runpy
import subprocess
from pathlib import Path

import pytest
import yaml
from support import ROOT
from support.programs import in_setup, ran

NAVIGATION = ROOT / 'tools' / 'navigation'
FACTS = yaml.safe_load((ROOT / 'test/data/navigation/manifests.yaml').read_text(encoding='utf-8'))
REPOSITORIES = yaml.safe_load((NAVIGATION / 'navigation.repos').read_text(encoding='utf-8'))[
    'repositories'
]
TARGETS = yaml.safe_load((NAVIGATION / 'targets.yaml').read_text(encoding='utf-8'))
PLAN = runpy.run_path(str(NAVIGATION / 'build_plan.py'))
MANIFEST = """<package format="2"><name>{}</name><version>1.0.0</version>
<description>x</description>
<maintainer email="a@b.example">a</maintainer><license>BSD</license>{}</package>"""
NONE = ''  # no package of its own
# What is a system's library in the manifests, and not called as Debian's packages are.
LIBRARIES = {
    'bullet': 'libbullet-dev',
    'catkin': 'catkin',
    'eigen': 'libeigen3-dev',
    'netpbm': NONE,  # of a test of navfn
    'pluginlib': 'pluginlib-dev',
    'nodelet': 'libnodeletlib-dev',
    'sdl': 'libsdl1.2-dev',
    'sdl-image': 'libsdl-image1.2-dev',
    'cmake_modules': 'ros-cmake-modules',
    'message_generation': 'ros-message-generation',
    'dynamic_reconfigure': 'libdynamic-reconfigure-config-init-mutex-dev',
    'python3-setuptools': NONE,  # comes with catkin
    # come with libroscpp-dev, and that with libtf-dev
    'roscpp': 'libtf-dev',
    'rosconsole': 'libtf-dev',
    'tf2': 'libtf2-ros-dev',
    'tf2_msgs': 'libtf2-ros-dev',
    'rostest': 'librostest-dev',
}


def write_manifest(folder, name, build=(), run=()):
    folder.mkdir(parents=True, exist_ok=True)
    depends = [
        f'<{tag}>{each}</{tag}>'
        for tag, names in (('build_depend', build), ('exec_depend', run))
        for each in names
        if each != 'catkin'
    ]
    (folder / 'package.xml').write_text(
        MANIFEST.format(name, ''.join(['<buildtool_depend>catkin</buildtool_depend>', *depends])),
        encoding='utf-8',
    )


@pytest.fixture
def sources(tmp_path):
    """Return a folder with the manifests of all repositories, as vcstool leaves them."""
    for repository, packages in FACTS.items():
        for name, depends in packages.items():
            inner = '.' if len(packages) == 1 else name
            write_manifest(tmp_path / repository / inner, name, **depends)
    return tmp_path


def in_navigation(script, workspace, **environment):
    """Run a script with the functions of the set-up, the set navigation chosen."""
    folders = dict.fromkeys(('WORKSPACE', 'HOME'), str(workspace))
    return in_setup(f'choose_sets navigation; {script}', **folders, **environment)


def test_sources_are_commits_of_the_repositories_that_the_facts_are_of():
    assert set(REPOSITORIES) == set(FACTS)
    for each in REPOSITORIES.values():
        assert each['type'] == 'git'
        assert re.fullmatch(r'https://github\.com/[\w-]+/\w+\.git', each['url'])
        assert re.fullmatch('[0-9a-f]{40}', each['version'])


def test_only_what_the_nodes_need_is_built(sources):
    plan = {name: targets for name, _, targets in PLAN['build_plan'](sources, TARGETS)}
    assert set(plan) == {
        'map_server',
        'amcl',
        'openslam_gmapping',
        'gmapping',
        'voxel_grid',
        'costmap_2d',
        'nav_core',
        'navfn',
        'base_local_planner',
        'dwa_local_planner',
        'clear_costmap_recovery',
        'rotate_recovery',
        'move_base',
    }
    assert {name: targets for name, targets in plan.items() if targets} == TARGETS


def test_a_package_is_built_after_those_it_needs(sources):
    order = [name for name, *_ in PLAN['build_plan'](sources, TARGETS)]
    depends = {name: facts for packages in FACTS.values() for name, facts in packages.items()}
    for name in order:
        for need in set(depends[name]['build']) & set(order):
            assert order.index(need) < order.index(name), f'{need} after {name}'


def test_folders_are_those_of_the_manifests(sources):
    for name, folder, _ in PLAN['build_plan'](sources, TARGETS):
        assert f'<name>{name}</name>' in (folder / 'package.xml').read_text(encoding='utf-8')


def test_incomplete_sources_are_an_error_in_one_sentence(sources):
    (sources / 'navigation' / 'amcl' / 'package.xml').unlink()
    done = ran('/usr/bin/python3', NAVIGATION / 'build_plan.py', sources)
    assert (done.returncode, done.stderr) == (
        1,
        f'rosbots: there is no package amcl in {sources}\n',
    )


def test_a_circle_of_packages_is_an_error_that_names_them(tmp_path):
    write_manifest(tmp_path / 'a', 'a', build=['b'])
    write_manifest(tmp_path / 'b', 'b', build=['a'])
    with pytest.raises(PLAN['PlanError'], match='depend on each other in a circle: a, b'):
        list(PLAN['build_plan'](tmp_path, {'a': ()}))


@pytest.mark.parametrize('debian', ['12', '13'])
def test_debian_has_what_the_packages_need_besides_each_other(sources, debian):
    done = in_navigation(f'DEBIAN={debian}; debian_packages "${{CHOSEN[@]}}"', sources)
    installed = set(done.stdout.split())
    assert {'git', 'vcstool'} < installed
    plan = {name for name, *_ in PLAN['build_plan'](sources, TARGETS)}
    depends = {
        name: facts['build']
        for packages in FACTS.values()
        for name, facts in packages.items()
        if name in plan
    }
    for name, needs in depends.items():
        for need in set(needs) - plan:
            dashed = need.replace('_', '-')
            here = (
                {LIBRARIES[need]}
                if need in LIBRARIES
                else {f'lib{dashed}-dev', f'python3-{dashed}'}
            )
            assert here & {*installed, NONE}, f'{name} needs {need}'


def commit(folder: Path, **files: str) -> str:
    """Make a git repository with these files; return its commit."""
    for name, text in files.items():
        path = folder / name.replace('__', '/').replace('_dot_', '.')
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding='utf-8')
    git = ['git', '-C', str(folder), '-c', 'user.name=a', '-c', 'user.email=a@b.example']
    for command in (['init', '--quiet'], ['add', '.'], ['commit', '--quiet', '-m', 'x']):
        subprocess.run([*git, *command], check=True)
    return ran(*git, 'rev-parse', 'HEAD').stdout.strip()


@pytest.fixture
def stand_in(tmp_path):
    """Return a copy of tools/navigation whose slam_gmapping is a repository made here."""
    nodelet = ['//'] * 31 + ['#include <pluginlib/class_list_macros.h>', '//']
    version = commit(
        tmp_path / 'origin',
        gmapping__src__slam_gmapping_dot_cpp='//\n' * 140,
        gmapping__src__nodelet_dot_cpp='\n'.join(nodelet) + '\n',
    )
    made = tmp_path / 'navigation'
    made.mkdir()
    (made / 'patches').symlink_to(NAVIGATION / 'patches')
    entry = REPOSITORIES['slam_gmapping'] | {'version': version}
    (made / 'navigation.repos').write_text(
        yaml.safe_dump({'repositories': {'slam_gmapping': entry}}), encoding='utf-8'
    )
    return made


def redirected(url):
    """Return the environment in which git takes this instead of the address of slam_gmapping."""
    return {
        'GIT_CONFIG_COUNT': '1',
        'GIT_CONFIG_KEY_0': f'url.{url}.insteadOf',
        'GIT_CONFIG_VALUE_0': REPOSITORIES['slam_gmapping']['url'],
    }


def test_sources_are_got_and_patched(tmp_path, stand_in):
    done = in_navigation(
        f'NAVIGATION={stand_in}; get_sources {tmp_path}/sources',
        tmp_path,
        **redirected(tmp_path / 'origin'),
    )
    assert done.returncode == 0, done.stdout + done.stderr
    code = tmp_path / 'sources' / 'slam_gmapping' / 'gmapping' / 'src'
    lines = (code / 'slam_gmapping.cpp').read_text().splitlines()
    assert [(i, line) for i, line in enumerate(lines, 1) if line != '//'] == [
        (136, '#include <boost/bind.hpp>')
    ]
    assert (code / 'nodelet.cpp').read_text().splitlines()[31] == (
        '#include <pluginlib/class_list_macros.hpp>'
    )


def test_without_a_network_one_sentence_says_so(tmp_path, stand_in):
    done = in_navigation(
        f'NAVIGATION={stand_in}; phase "Sources" sources get_sources {tmp_path}/sources',
        tmp_path,
        **redirected('https://127.0.0.1:1/'),
    )
    assert done.returncode == 1
    assert done.stderr == (
        'rosbots: Sources: a server of sources cannot be reached; connect this machine to the '
        f'network, and run this again (details: {tmp_path}/log/sources.log)\n'
    )


@pytest.mark.parametrize(('free', 'most'), [(100, 1), (1600, 1), (3500, 2), (10**6, None)])
def test_as_many_compilers_as_memory_allows(tmp_path, free, most):
    (tmp_path / 'meminfo').write_text(f'MemTotal: 1 kB\nMemAvailable: {free * 1000} kB\n')
    done = in_navigation(f'compilers {tmp_path}/meminfo', tmp_path)
    processors = len(os.sched_getaffinity(0))
    assert done.stdout == f'{min(most or processors, processors)}\n', done.stderr


def test_stack_is_built_once_and_again_when_its_description_changes(tmp_path):
    made = tmp_path / 'navigation'
    (made / 'patches').mkdir(parents=True)
    for name in ('a.repos', 'patches/a.patch'):
        (made / name).touch()
    done = in_navigation(
        f'NAVIGATION={made}; say() {{ navigation_done && echo done || echo open; }}; say; '
        'mark_done navigation "$(navigation_fingerprint)"; say; '
        f'echo "-" >> {made}/patches/a.patch; say; choose_sets base; say',
        tmp_path,
    )
    assert done.stdout.split() == ['open', 'done', 'open', 'done'], done.stderr


def test_built_stack_is_in_the_environment(tmp_path):
    script = (
        f'source "$ROOT/tools/environment.bash"; WORKSPACE={tmp_path}; '
        'CMAKE_PREFIX_PATH=/ours ROS_PACKAGE_PATH=/ours/src:/usr/share PYTHONPATH=/ours/lib; '
        'use_navigation; echo "$CMAKE_PREFIX_PATH $ROS_PACKAGE_PATH $PYTHONPATH '
        '${LD_LIBRARY_PATH-}"'
    )
    assert in_navigation(script, tmp_path).stdout == '/ours /ours/src:/usr/share /ours/lib \n'
    (tmp_path / 'stamps').mkdir()
    (tmp_path / 'stamps' / 'navigation').touch()
    devel = tmp_path / 'navigation' / 'devel'
    assert in_navigation(script, tmp_path).stdout.split() == [
        f'/ours:{devel}',
        f'/ours/src:{tmp_path}/navigation/src:/usr/share',
        f'/ours/lib:{devel}/lib/python3/dist-packages',
        f'{devel}/lib',
    ]
