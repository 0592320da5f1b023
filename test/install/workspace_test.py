"""HIRES in a catkin workspace beside packages that use it: built by catkin_make, and by catkin_make_isolated
into an install space. Usage: workspace_test.py FOLDER, which is always the same, so that ccache remembers what
it compiled there."""

import os
import shutil
import signal
import socket
import subprocess
import sys
import unittest

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..'))
SUCCESS = '16 of 16 rollouts succeeded'
CMAKE = ('-DCMAKE_BUILD_TYPE=Release', '-DPYTHON_EXECUTABLE=/usr/bin/python3')


def bare_environment():
    """Of somebody who entered no workspace. Message code for other languages would only cost time."""
    entered = ('CCACHE_BASEDIR', 'CMAKE_PREFIX_PATH', 'LD_LIBRARY_PATH', 'PYTHONPATH', 'PKG_CONFIG_PATH', 'ROS_PACKAGE_PATH')
    kept = {name: value for name, value in os.environ.items() if name not in entered}
    return {**kept, 'ROS_LANG_DISABLE': 'genlisp:geneus:gennodejs', 'ROS_HOSTNAME': 'localhost',
            'CCACHE_DEPEND': '1', 'CCACHE_NOHASHDIR': '1'}


def run(*command, cwd=None, **options):
    environment = bare_environment()
    if cwd:
        environment['PWD'] = cwd  # which catkin_make believes
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False,
                          stdin=subprocess.DEVNULL, cwd=cwd, env=environment, **options)
    if done.returncode != 0:
        raise AssertionError('%s:\n%s' % (' '.join(command), done.stdout[-6000:]))
    return done.stdout


def free_port():
    with socket.socket() as listener:
        listener.bind(('127.0.0.1', 0))
        return listener.getsockname()[1]


class WorkspaceTest(unittest.TestCase):
    def setUp(self):
        self.folder = FOLDER
        shutil.rmtree(self.folder, ignore_errors=True)
        source = os.path.join(self.folder, 'src')
        os.makedirs(source)
        os.symlink(ROOT, os.path.join(source, 'hires'))
        for name in ('own_program', 'own_action'):
            shutil.copytree(os.path.join(ROOT, 'examples', name), os.path.join(source, name))

    def in_workspace(self, space, *command):
        """Runs a command as somebody does who sourced setup.bash of a space."""
        enter = '. "$0/setup.bash" && exec "$@"'
        return run('bash', '-c', enter, os.path.join(self.folder, space), *command)

    def check_programs(self, space):
        data = self.in_workspace(space, 'rospack', 'find', 'hires').strip()
        self.assertIn(SUCCESS, self.in_workspace(space, 'rosrun', 'own_program', 'own_program_imagine', data))
        world = os.path.join(data, 'worlds', 'workshop.world')
        self.assertIn(SUCCESS, self.in_workspace(space, 'rosrun', 'own_program', 'imagine_in_python.py', world))
        library = os.path.join(self.folder, space, 'lib', 'libown_action.so')
        listed = self.in_workspace(space, 'hires', 'imagine', '--local', '--quiet', '--actions', library,
                                   '--action', 'turn_towards', '--arg', 'sittingAreaWestTable1', '--arg',
                                   'slow', '--from', 'preManipulationAreaEastCounter1', '--rollouts', '2',
                                   '--min-success', '0.1')
        self.assertIn('turn_towards', listed)
        self.in_workspace(space, 'roslaunch', '--files', 'hires', 'fake_pr2.launch')
        self.in_workspace(space, 'roslaunch', '--nodes', 'hires', 'fake_pr2.launch')

    def check_asking_nodes(self, space):
        """The client in C++ asks nodes that roslaunch starts."""
        port = str(free_port())
        enter = '. "$0/setup.bash" && export ROS_MASTER_URI=http://localhost:%s && exec "$@"' % port
        folder = os.path.join(self.folder, space)
        with open(os.path.join(self.folder, 'nodes.log'), 'w+', encoding='utf-8') as log:
            nodes = subprocess.Popen(
                ['bash', '-c', enter, folder, 'roslaunch', '-p', port, 'hires', 'imagination.launch',
                 'workers:=1'],
                stdout=log, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                env={**bare_environment(), 'ROS_HOME': self.folder})
            try:
                answer = run('bash', '-c', enter, folder, 'rosrun', 'own_program', 'own_program_ask',
                             'preManipulationAreaEastCounter1', 'preManipulationAreaNorthTable1', timeout=120)
                self.assertIn('16 of 16 rollouts', answer)
            except BaseException:
                log.seek(0)
                sys.stderr.write(log.read()[-4000:])
                raise
            finally:
                nodes.send_signal(signal.SIGINT)
                nodes.wait()

    def test_two_packages_in_one_build_and_in_builds_of_their_own(self):
        run('catkin_make', '--use-ninja', *CMAKE, cwd=self.folder)
        built = os.path.join(self.folder, 'devel', 'lib', 'hires')
        self.assertIn('sim_worker', os.listdir(built))
        self.assertNotIn('base_test', os.listdir(built), 'tests are for who asks for them')
        targets = run('ninja', '-C', os.path.join(self.folder, 'build'), '-t', 'query', 'run_tests')
        self.assertIn('run_tests_hires', targets)
        self.check_programs('devel')
        self.check_asking_nodes('devel')
        for space in ('build', 'devel'):  # the same folders again, for the sake of ccache
            shutil.rmtree(os.path.join(self.folder, space))
        run('catkin_make_isolated', '--use-ninja', '--merge', '--install', '--build', 'build', '--devel', 'devel',
            *CMAKE, '-DCATKIN_ENABLE_TESTING=OFF', cwd=self.folder)
        shutil.rmtree(os.path.join(self.folder, 'devel'))  # what is installed needs nothing of it
        self.check_programs('install_isolated')
        self.check_asking_nodes('install_isolated')


if __name__ == '__main__':
    FOLDER = os.path.abspath(sys.argv.pop(1))
    unittest.main()
