"""Masters and processes for tests: on free ports, watched, and gone when the test is.

A test that needs more than the one master rostest brings starts them here:

    processes = Processes()
    main = processes.master()
    talker = processes.start([executable('relay_test_peer'), 'stream', '/a', '10'], main)
    wait_until(lambda: '/a' in main.publishers(), 'the talker to register')
    processes.stop_all()
"""

import ctypes
import os
import re
import signal
import socket
import subprocess
import tempfile
import threading
import time
import xmlrpc.client

# Far beyond what anything takes: a limit ends a broken test, it measures nothing.
LIMIT = 60.0

_LIBC = ctypes.CDLL(None, use_errno=True)
_PR_SET_PDEATHSIG = 1


def _die_with_parent():
    _LIBC.prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)


def wait_until(condition, what, limit=LIMIT):
    """Waits until condition() is true and returns its value.
    @param what  is waited for: words, or what says them once it was in vain."""
    end = time.monotonic() + limit
    pause = threading.Event()
    while True:
        value = condition()
        if value:
            return value
        if time.monotonic() > end:
            words = what() if callable(what) else what
            raise AssertionError('waited %g s in vain for %s' % (limit, words))
        pause.wait(0.01)


def free_port():
    """A port of the loopback interface that nobody listens on now."""
    return free_port_block(1)


_FIRST_PORT, _NUM_PORTS = 20000, 12000  # below the range of outgoing connections
_handed_out = set()


def free_port_block(size):
    """First of `size` ports in a row that are free now, and were given to nobody else here: they
    may be taken only later. Tests that run side by side begin their search far from each other."""
    start = os.getpid() * 37 % 1000 * (_NUM_PORTS // 1000)
    for offset in range(0, _NUM_PORTS - size, size):
        first = _FIRST_PORT + (start + offset) % (_NUM_PORTS - size)
        block = range(first, first + size)
        if not _handed_out.intersection(block) and all(map(is_port_free, block)):
            _handed_out.update(block)
            return first
    raise AssertionError('no %d free ports in a row' % size)


def is_port_free(port):
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind(('127.0.0.1', port))
        except OSError:
            return False
    return True


def executable(name, package='hires'):
    """Path of a program of the built or installed workspace."""
    for prefix in os.environ.get('CMAKE_PREFIX_PATH', '').split(os.pathsep):
        path = os.path.join(prefix, 'lib', package, name)
        if os.access(path, os.X_OK):
            return path
    raise AssertionError('%s is not built, or setup.bash is not sourced' % name)


class _BoundedTransport(xmlrpc.client.Transport):
    def make_connection(self, host):
        connection = super().make_connection(host)
        connection.timeout = 5.0
        return connection


def bounded_proxy(uri):
    """Of a node or master: who is given the port of one that is gone may accept calls and never answer."""
    return xmlrpc.client.ServerProxy(uri, transport=_BoundedTransport())


class Process:
    """A running program whose output is read line by line.
    @param master  that its nodes are registered at, if any."""

    def __init__(self, command, environment, master=None):
        self.command = command
        self._master = master
        self.lines = []
        self._changed = threading.Condition()
        self._popen = subprocess.Popen(
            command, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, text=True, errors='replace', start_new_session=True,
            preexec_fn=_die_with_parent)
        self.pid = self._popen.pid
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        for line in self._popen.stdout:
            with self._changed:
                self.lines.append(line.rstrip('\n'))
                self._changed.notify_all()
        with self._changed:
            self._changed.notify_all()

    def output(self):
        return '\n'.join(self.lines)

    def wait_for(self, pattern, limit=LIMIT, first=0):
        """Waits for a line, the first-th or later, that `pattern` is found in; the match."""
        end = time.monotonic() + limit
        with self._changed:
            seen = first
            while True:
                for line in self.lines[seen:]:
                    match = re.search(pattern, line)
                    if match:
                        return match
                seen = max(seen, len(self.lines))
                rest = end - time.monotonic()
                if rest <= 0.0 or (not self._reader.is_alive() and seen == len(self.lines)):
                    raise AssertionError('no line like "%s" from %s, which said:\n%s' % (
                        pattern, ' '.join(self.command), '\n'.join(self.lines[-40:])))
                self._changed.wait(min(rest, 0.5))

    def is_running(self):
        return self._popen.poll() is None

    def signal(self, number):
        if self.is_running():
            os.kill(self.pid, number)

    def kill(self):
        """SIGKILL to the program alone; returns when it is gone."""
        self.signal(signal.SIGKILL)
        self._popen.wait()

    def wait(self, limit=LIMIT):
        """Exit code; waits for the end."""
        try:
            code = self._popen.wait(limit)
        except subprocess.TimeoutExpired:
            raise AssertionError('%s does not end; it said:\n%s' % (
                ' '.join(self.command), '\n'.join(self.lines[-40:])))
        self._reader.join(5.0)
        return code

    def destroy(self):
        """Kills the program and whatever it started in its session's group; its master forgets it."""
        self.end()
        if self._master is not None:
            self._master.forget_the_gone()

    def end(self):
        """The same, but its master goes on telling others, and telling it, of what it had."""
        try:
            os.killpg(self.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        self._popen.wait()


class Master:
    """A bare rosmaster on the loopback interface."""

    def __init__(self, environment, port=None, wait=True):
        self.port = port or free_port()
        self.uri = 'http://127.0.0.1:%d/' % self.port
        self._environment = environment
        self.process = None
        if wait:
            self.start()
        else:
            self.launch()

    def start(self):
        """Starts it (again, after kill()), and returns when it answers."""
        self.launch()
        self.wait_until_there()

    def launch(self):
        self.process = Process(['rosmaster', '--core', '-p', str(self.port)], self._environment)

    def wait_until_there(self):
        wait_until(lambda: self._call('getPid') == self.process.pid, 'master %s' % self.uri)

    def kill(self):
        self.process.signal(signal.SIGCONT)
        self.process.kill()

    def forget_the_gone(self):
        """Takes killed nodes off its lists. A port that was theirs is given to somebody else one day,
        of another test maybe: who is told then who publishes the dead one's topics drops the links it
        has, and a subscriber that still tries the dead one does not notice the new one there. Who
        waits until a service is registered takes that of the dead for the next one's."""
        publishers, subscribers, services = self._call('getSystemState') or [[], [], []]
        nodes = {node for _, nodes in publishers + subscribers + services for node in nodes}
        uris = {node: self.node_uri(node) or '' for node in nodes}
        gone = {node: uri for node, uri in uris.items() if self._is_gone(uri)}
        for service, nodes in services:
            for node in gone.keys() & set(nodes):
                uri = self._call('lookupService', service)
                self._call('unregisterService', service, uri, caller=node)
        for topics, unregister in ((publishers, 'unregisterPublisher'),
                                   (subscribers, 'unregisterSubscriber')):
            for topic, nodes in topics:
                for node in gone.keys() & set(nodes):
                    self._call(unregister, topic, gone[node], caller=node)

    def _is_gone(self, uri):
        """Whether nobody listens there, or somebody who belongs to another master and was given the port.
        That the port could be bound would not tell: a connection that somebody opened may have it."""
        if not uri.startswith('http://127.0.0.1:'):
            return False
        try:
            with bounded_proxy(uri) as node:
                pid = node.getPid('/test')[2]
        except ConnectionRefusedError:
            return True
        except (OSError, xmlrpc.client.Error, xmlrpc.client.http.client.HTTPException, IndexError):
            return False  # it may be stopped
        return not _is_below(pid, os.getpid()) and pid not in processes_with('ROS_MASTER_URI', self.uri)

    def _call(self, method, *arguments, caller='/test'):
        """The value, or None when there is no answer or a failure."""
        try:
            # A proxy of its own for each call: tests kill and stop masters at any time.
            with bounded_proxy(self.uri) as proxy:
                code, _, value = getattr(proxy, method)(caller, *arguments)
        except (OSError, xmlrpc.client.Error, xmlrpc.client.http.client.HTTPException):
            return None
        return value if code == 1 else None

    def publishers(self, topic=None):
        """{topic: [node]}, or the nodes that publish `topic`."""
        state = self._call('getSystemState') or [[], [], []]
        publishers = dict(state[0])
        return publishers if topic is None else publishers.get(topic, [])

    def subscribers(self, topic):
        """Nodes that listen to `topic`."""
        return dict((self._call('getSystemState') or [[], [], []])[1]).get(topic, [])

    def services(self):
        return dict((self._call('getSystemState') or [[], [], []])[2])

    def topic_types(self):
        return dict(self._call('getTopicTypes') or [])

    def node_uri(self, node):
        return self._call('lookupNode', node)

    def param(self, name):
        return self._call('getParam', name)

    def set_param(self, name, value):
        return self._call('setParam', name, value)


class Processes:
    """Everything one test started."""

    def __init__(self):
        self._processes = []
        self._masters = []
        self._foreign_masters = set()  # of other tests, too
        self.folder = tempfile.TemporaryDirectory(prefix='hires_test_')

    def environment(self, master=None, **more):
        environment = dict(os.environ)
        environment.pop('ROS_HOSTNAME', None)
        environment['ROS_IP'] = '127.0.0.1'
        environment['ROS_LOG_DIR'] = os.path.join(self.folder.name, 'log')
        environment['ROSCONSOLE_STDOUT_LINE_BUFFERED'] = '1'
        environment['PYTHONUNBUFFERED'] = '1'
        if master is not None:
            environment['ROS_MASTER_URI'] = master.uri
        environment.update(more)
        return environment

    def master(self, port=None):
        master = Master(self.environment(), port)
        self._masters.append(master)
        return master

    def masters(self, count):
        """So many, started all at once."""
        masters = [Master(self.environment(), wait=False) for _ in range(count)]
        self._masters += masters
        for master in masters:
            master.wait_until_there()
        return masters

    def start(self, command, master, **environment):
        process = Process(command, self.environment(master, **environment), master)
        self._processes.append(process)
        if master is not None and master not in self._masters:
            self._foreign_masters.add(master)
        return process

    def write(self, name, text):
        """A file of the test's own; its path."""
        path = os.path.join(self.folder.name, name)
        with open(path, 'w') as file:
            file.write(text)
        return path

    def stop_all(self):
        for process in reversed(self._processes):
            process.end()
        for master in self._foreign_masters:
            master.forget_the_gone()
        for master in self._masters:
            master.process.end()
        self.folder.cleanup()


def _is_below(pid, ancestor):
    """Whether a process is the ancestor or was started by it, through however many others."""
    while pid > 1 and pid != ancestor:
        try:
            with open('/proc/%d/stat' % pid) as file:
                pid = int(file.read().rsplit(')', 1)[1].split()[1])
        except OSError:
            return False
    return pid == ancestor


def processes_with(variable, value):
    """{pid: command line} of the living processes that have variable=value in their environment."""
    wanted = ('%s=%s' % (variable, value)).encode()
    found = {}
    for entry in os.listdir('/proc'):
        if not entry.isdigit():
            continue
        try:
            with open('/proc/%s/environ' % entry, 'rb') as file:
                if wanted not in file.read().split(b'\0'):
                    continue
            with open('/proc/%s/cmdline' % entry, 'rb') as file:
                command = file.read().replace(b'\0', b' ').decode(errors='replace').strip()
            with open('/proc/%s/stat' % entry) as file:
                state = file.read().rsplit(')', 1)[1].split()[0]
        except (OSError, IndexError):
            continue  # it ended meanwhile, or is somebody else's
        if state not in 'ZX':
            found[int(entry)] = command
    return found
