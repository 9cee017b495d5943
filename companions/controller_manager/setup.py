"""Tell catkin where the Python module controller_manager lies."""

from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=['controller_manager'], package_dir={'': 'src'}))
