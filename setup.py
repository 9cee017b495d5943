"""Install the Python packages: by catkin, here and in the companion that links here, or by pip."""

import re
from glob import glob
from pathlib import Path
from xml.etree import ElementTree

from setuptools import find_packages, setup

MANIFEST = ElementTree.parse('package.xml')  # what catkin knows is said there only


def told(tag: str) -> str:
    """Return what the manifest says, in one line."""
    return ' '.join(MANIFEST.findtext(tag, '').split())


def required(name: str) -> list[str]:
    """Return the requirements of a set, without those of the sets that it includes.

    The files have the versions that are tested; pip may take later ones that only mend these.
    """
    folder = Path(__file__).resolve().parent / 'requirements'
    lines = (folder / f'{name}.pip').read_text(encoding='utf-8').splitlines()
    entries = (line.partition('#')[0].strip() for line in lines)
    return [
        re.sub(r'^([\w.-]+)==', r'\1~=', entry)
        for entry in entries
        if entry and not entry.startswith('-r ')
    ]


setup(
    name=told('name'),
    version=told('version'),
    description=told('description'),
    license=told('license'),
    python_requires='>=3.11',
    packages=find_packages('src'),
    package_dir={'': 'src'},
    package_data={'': ['config/*', 'models/*/*.sdf', 'models/*/meshes/*', 'worlds/*', 'py.typed']},
    # The robot, where its package:// addresses lead; catkin installs it there, too.
    data_files=[
        (f'share/{told("name")}/{folder}', files)
        for folder in ('', 'meshes', 'urdf')
        if (files := glob(f'{folder}/*') if folder else ['package.xml'])
    ],
    # Of `sim` and the command line; what the ROS side needs comes from Debian, as package.xml says.
    install_requires=required('core'),
    extras_require={name: required(name) for name in ('batch', 'gym', 'web')},
)
