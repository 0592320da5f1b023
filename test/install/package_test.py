"""The Debian package on a bare system: installed by apt into a folder where nothing but Debian's base is, it
ranks drives. Usage: package_test.py FOLDER, to work in. Needs root, debootstrap and a mirror; skips without."""

import glob
import os
import shutil
import subprocess
import sys
import time
import unittest

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..'))
sys.path.insert(0, os.path.join(ROOT, 'test', 'house'))

from readme_test import bare, examples  # noqa: E402


def run(*command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False,
                          stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        raise AssertionError('%s:\n%s' % (' '.join(command), done.stdout[-6000:]))
    return done.stdout


def mirror():
    """(address, release) of the Debian that this computer installs from; nothing where apt knows none."""
    with open('/etc/os-release', encoding='utf-8') as file:
        release = [line.split('=')[1].strip() for line in file if line.startswith('VERSION_CODENAME=')]
    targets = run('apt-get', 'indextargets', '--format', '$(REPO_URI) $(CODENAME)', 'Created-By: Packages')
    for line in targets.splitlines():
        address, _, codename = line.partition(' ')
        if [codename] == release:
            return address, codename
    return None


class PackageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if os.getuid() != 0:
            raise unittest.SkipTest('not root: no system can be made in a folder')
        if not shutil.which('debootstrap'):
            raise unittest.SkipTest('debootstrap is missing; scripts/setup long installs it')
        if not mirror():
            raise unittest.SkipTest('apt knows no mirror of this release of Debian')
        cls.system = os.path.join(FOLDER, 'system')
        shutil.rmtree(FOLDER, ignore_errors=True)
        os.makedirs(FOLDER)
        print(run(os.path.join(ROOT, 'scripts', 'package'), FOLDER).splitlines()[-1], flush=True)
        (cls.package,) = glob.glob(os.path.join(FOLDER, 'ros-hires_*.deb'))
        address, release = mirror()
        run('debootstrap', '--variant=minbase', release, cls.system, address)
        # It installs from where this computer does.
        for name in os.listdir('/etc/apt/apt.conf.d'):
            shutil.copy(os.path.join('/etc/apt/apt.conf.d', name), os.path.join(cls.system, 'etc/apt/apt.conf.d'))
        for name in ('resolv.conf', 'hosts'):
            shutil.copy(os.path.join('/etc', name), os.path.join(cls.system, 'etc'))
        shutil.copy(cls.package, os.path.join(cls.system, 'hires.deb'))
        begin = time.monotonic()
        cls.inside('apt-get', 'update')
        cls.inside('env', 'DEBIAN_FRONTEND=noninteractive', 'apt-get', 'install', '-y',
                   '--no-install-recommends', '/hires.deb')
        cls.installed_in = time.monotonic() - begin

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(FOLDER, ignore_errors=True)

    @classmethod
    def inside(cls, *command):
        return run('chroot', cls.system, 'env', '-i', 'PATH=/usr/sbin:/usr/bin:/sbin:/bin', 'HOME=/root', *command)

    def test_the_first_table_comes_with_nothing_built_there(self):
        with open(os.path.join(ROOT, 'README.md'), encoding='utf-8') as file:
            words, shown = examples(file.read())[0]
        words[words.index('--world') + 1] = '/usr/share/hires/worlds/workshop.world'
        begin = time.monotonic()
        answer = self.inside(*words, '--quiet')
        print('package: installed in %.0f s, first table after %.0f s more' %
              (self.installed_in, time.monotonic() - begin), flush=True)
        self.assertEqual(bare(answer), bare('\n'.join(shown)))

    def test_nodes_and_python_are_found(self):
        self.assertIn('/usr/share/hires', self.inside('rospack', 'find', 'hires'))
        nodes = self.inside('roslaunch', '--nodes', 'hires', 'imagination.launch', 'workers:=1')
        self.assertIn('/imagination_client', nodes)
        self.assertIn('0.2', self.inside('python3', '-c', 'from hires import core, Imagination; '
                                         'core.Scene(); print(core.__version__)'))

    def test_the_rest_of_a_package_is_there(self):
        listed = run('dpkg-deb', '--contents', self.package)
        for path in ('/usr/share/man/man1/hires.1', '/usr/share/man/man1/hires-imagine.1',
                     '/usr/share/bash-completion/completions/hires',
                     '/usr/lib/systemd/system/hires-imagination.service'):
            self.assertIn(' .%s\n' % path, listed)

    def test_the_completion_offers_verbs_and_options(self):
        complete = ('. /usr/share/bash-completion/completions/hires; COMP_WORDS=(%s); COMP_CWORD=%d; _hires; '
                    'echo "${COMPREPLY[@]}"')
        self.assertEqual(self.inside('bash', '-c', complete % ('hires imag', 1)), 'imagine\n')
        self.assertIn('--rollouts', self.inside('bash', '-c', complete % ('hires imagine --roll', 2)))


if __name__ == '__main__':
    FOLDER = os.path.abspath(sys.argv.pop(1))
    unittest.main()
