"""Computers of their own on this one: network namespaces, joined by a cable that can be pulled.

    with Network('robot', 'imaginer') as network:      # 10.99.0.1 and 10.99.0.2
        network.hosts['imaginer'].command(['ping', '-c', '1', '10.99.0.1'])  # what to run there
        network.cut()
        network.mend()

Nothing in them is reachable from outside. Each has a name, and an /etc/hosts of its own. They are
gone in the end, and those of tests that were killed are swept away by the next.
"""

import ctypes
import os
import shutil
import subprocess
import unittest

_LIBC = ctypes.CDLL(None, use_errno=True)
_CLONE_NEWNET = 0x40000000
_PREFIX = 'hires'
_NET = '10.99.0.%d'


def _ip(*arguments, check=True):
    return subprocess.run(['ip', *arguments], check=check, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True)


def reason_against():
    """Why there can be no namespaces here; empty if there can."""
    if os.geteuid() != 0:
        return 'network namespaces need root: run ctest as root to test two hosts'
    if shutil.which('ip') is None or shutil.which('unshare') is None:
        return 'no `ip` or `unshare` here: install iproute2 and util-linux to test two hosts'
    probe = '%s_%d_probe' % (_PREFIX, os.getpid())
    made = _ip('netns', 'add', probe, check=False)
    _ip('netns', 'del', probe, check=False)
    return '' if made.returncode == 0 else 'no network namespaces here: ' + made.stdout.strip()


def skip_unless_possible():
    """For setUpModule()."""
    reason = reason_against()
    if reason:
        print(reason)
        raise unittest.SkipTest(reason)


class Host:
    """One of the computers."""

    def __init__(self, name, address):
        self.name = name
        self.address = address
        self.namespace = '%s_%d_%s' % (_PREFIX, os.getpid(), name)
        self._etc = '/etc/netns/' + self.namespace
        _ip('netns', 'add', self.namespace)
        _ip('-n', self.namespace, 'link', 'set', 'lo', 'up')

    def know(self, names):
        """Its /etc/hosts: {name: address}, and localhost."""
        os.makedirs(self._etc, exist_ok=True)
        lines = ['127.0.0.1 localhost'] + ['%s %s' % (at, name) for name, at in names.items()]
        with open(self._etc + '/hosts', 'w') as file:
            file.write('\n'.join(lines) + '\n')
        with open(self._etc + '/resolv.conf', 'w') as file:
            file.write('# no name server: only /etc/hosts\n')

    def command(self, command):
        """`command` to be run there; its process id is the command's own."""
        return ['ip', 'netns', 'exec', self.namespace, 'unshare', '--uts', 'sh', '-c',
                'hostname "$0" && exec "$@"', self.name, *command]

    def link(self, state):
        _ip('-n', self.namespace, 'link', 'set', 'eth0', state)

    def pids(self):
        return [int(pid) for pid in _ip('netns', 'pids', self.namespace).stdout.split()]

    def enter(self):
        """The calling thread's connections start from there; a function that brings it back."""
        own = os.open('/proc/thread-self/ns/net', os.O_RDONLY)
        there = os.open('/run/netns/' + self.namespace, os.O_RDONLY)
        _set_namespace(there)
        os.close(there)

        def leave():
            _set_namespace(own)
            os.close(own)
        return leave

    def destroy(self):
        _ip('netns', 'del', self.namespace, check=False)
        shutil.rmtree(self._etc, ignore_errors=True)


def _set_namespace(descriptor):
    if _LIBC.setns(descriptor, _CLONE_NEWNET) != 0:
        raise OSError(ctypes.get_errno(), 'setns')


class Network:
    """Two hosts and the cable between them; each knows both names."""

    def __init__(self, first, second):
        _sweep()
        self.hosts = {}
        try:
            self._make(first, second)
        except BaseException:
            self.destroy()
            raise

    def _make(self, first, second):
        for number, name in enumerate((first, second), 1):
            self.hosts[name] = Host(name, _NET % number)
        a, b = self.hosts.values()
        _ip('-n', a.namespace, 'link', 'add', 'eth0', 'type', 'veth', 'peer', 'name', 'eth0',
            'netns', b.namespace)
        for host in self.hosts.values():
            _ip('-n', host.namespace, 'address', 'add', host.address + '/24', 'dev', 'eth0')
            host.link('up')
            host.know({other.name: other.address for other in self.hosts.values()})

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.destroy()

    def cut(self):
        """Pulls the cable at the second host: the first one's packets vanish."""
        list(self.hosts.values())[1].link('down')

    def mend(self):
        list(self.hosts.values())[1].link('up')

    def destroy(self):
        for host in self.hosts.values():
            host.destroy()


def _sweep():
    """Removes what tests left that were killed."""
    for name in os.listdir('/run/netns') if os.path.isdir('/run/netns') else []:
        prefix, _, rest = name.partition('_')
        pid = rest.partition('_')[0]
        if prefix == _PREFIX and pid.isdigit() and not os.path.exists('/proc/' + pid):
            _ip('netns', 'del', name, check=False)
            shutil.rmtree('/etc/netns/' + name, ignore_errors=True)
