"""For catkin_python_setup() alone: where the Python module lies."""

from setuptools import setup
from catkin_pkg.python_setup import generate_distutils_setup

setup(**generate_distutils_setup(packages=['hires'], package_dir={'': 'python'}))
