"""Install the Python packages: by catkin, here and in the companion that links here, or by pip."""

from glob import glob
from xml.etree import ElementTree

from setuptools import find_packages, setup

MANIFEST = ElementTree.parse('package.xml')  # what catkin knows is said there only


def told(tag: str) -> str:
    """Return what the manifest says, in one line."""
    return ' '.join(MANIFEST.findtext(tag, '').split())


setup(
    name=told('name'),
    version=told('version'),
    description=told('description'),
    license=told('license'),
    python_requires='>=3.11',
    packages=find_packages('src'),
    package_dir={'': 'src'},
    package_data={'': ['config/*', 'worlds/*', 'py.typed']},
    # The robot, where its package:// addresses lead; catkin installs it there, too.
    data_files=[
        (f'share/{told("name")}/{folder}', files) for folder in ('', 'meshes', 'urdf')
        if (files := glob(f'{folder}/*') if folder else ['package.xml'])
    ],
    # Of `sim` alone; what the ROS side needs comes from Debian, as package.xml has it.
    install_requires=['embreex==4.4.0.post1', 'lxml', 'moderngl==5.12.0', 'numpy',
                      'pillow', 'pybullet==3.2.7', 'pycollada==0.9.3'],
    extras_require={'gym': ['PyYAML', 'gymnasium==1.4.0', 'xacro==1.13.3'],
                    'ray': ['PyYAML', 'msgspec==0.22.0', 'pyarrow==23.0.1', 'ray==2.60.0',
                            'rich==14.3.4', 'simpleeval==1.0.8'],
                    'web': ['av==18.1.0', 'rich==14.3.4', 'viser==1.1.1', 'websockets==16.1.1'],
                    'xacro': ['PyYAML', 'xacro==1.13.3']},
)
