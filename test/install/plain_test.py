"""HIRES built without ROS, installed, is found by a stranger's CMake and by Python, also after it was moved.
Usage: plain_test.py BUILD"""

import os
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = os.path.dirname(os.path.realpath(__file__))
ROOT = os.path.realpath(os.path.join(HERE, '..', '..'))
SOURCE = os.path.join(ROOT, 'examples', 'own_program', 'src', 'imagine.cpp')
IN_PYTHON = os.path.join(ROOT, 'examples', 'own_program', 'scripts', 'imagine_in_python.py')
PYTHON = '/usr/bin/python3'


def run(*command, **environment):
    """What it prints; what it says goes into the failure if it fails."""
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False,
                          stdin=subprocess.DEVNULL, env={**os.environ, **environment})
    if done.returncode != 0:
        raise AssertionError('%s:\n%s' % (' '.join(command), done.stdout))
    return done.stdout


class PlainTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix='hires_install_')
        first = os.path.join(cls.folder, 'first')
        run('cmake', '--install', BUILD, '--prefix', first)
        cls.prefix = os.path.join(cls.folder, 'moved')
        os.rename(first, cls.prefix)
        cls.data = os.path.join(cls.prefix, 'share', 'hires')

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def test_a_program_links_the_core_and_imagines(self):
        build = os.path.join(self.folder, 'build')
        run('cmake', '-S', os.path.join(HERE, 'plain'), '-B', build, '-DSOURCE=' + SOURCE,
            '-DCMAKE_PREFIX_PATH=' + self.prefix, '-DCMAKE_BUILD_TYPE=Release')
        run('cmake', '--build', build)
        with open(os.path.join(build, 'data_folder'), encoding='utf-8') as file:
            self.assertEqual(os.path.realpath(file.read()), os.path.realpath(self.data))
        self.assertIn('16 of 16 rollouts succeeded', run(os.path.join(build, 'stranger'), self.data))

    def test_python_finds_the_core_and_its_files(self):
        modules = os.path.join(self.prefix, 'lib', 'python3', 'dist-packages')
        printed = run(PYTHON, IN_PYTHON, os.path.join(self.data, 'worlds', 'workshop.world'),
                      PYTHONPATH=modules)
        self.assertIn('16 of 16 rollouts succeeded', printed)

    def test_headers_that_are_linked_with_ros_are_not_installed(self):
        layers = os.listdir(os.path.join(self.prefix, 'include', 'hires'))
        self.assertIn('imagination', layers)
        self.assertNotIn('ros', layers)
        self.assertNotIn('cli', layers)

    def test_the_program_finds_its_files(self):
        program = os.path.join(self.prefix, 'bin', 'hires')
        self.assertIn(os.path.join('moved', 'share', 'hires'), run(program, 'list', 'worlds'))


if __name__ == '__main__':
    BUILD = sys.argv.pop(1)
    unittest.main()
