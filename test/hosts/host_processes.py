"""Masters and processes on the hosts of a network, and the imagination client with workers on the
other host."""

import os
import sys
import xmlrpc.client

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', 'ros', 'support'))

from imagination_system import CONFIG_FOLDER, ImaginationSystem  # noqa: E402
from ros_processes import Master, Process, Processes, executable, wait_until  # noqa: E402

HERE_IN_SOURCE = os.path.abspath(
    os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..'))
MAIN_PORT = 11311
BASE_PORT = 11411
# A master of a computer whose clock is ahead by so many seconds, and that may keep it to itself.
LATER = """import http.server, time
now = time.time
time.time = lambda: now() + %f
if %r: http.server.BaseHTTPRequestHandler.date_time_string = lambda *_: ''
import rosmaster
rosmaster.rosmaster_main()"""


class HostMaster(Master):
    """A bare rosmaster of a host; the calling thread must be able to reach it."""

    def __init__(self, host, environment, port, clock=0.0, tells_no_time=False):
        self.host = host
        self.clock = clock
        self.tells_no_time = tells_no_time
        super().__init__(environment, port)

    def start(self):
        self.uri = 'http://%s:%d/' % (self.host.address, self.port)
        program = ['rosmaster'] if not self.clock else [
            '/usr/bin/python3', '-c', LATER % (self.clock, self.tells_no_time)]
        self.process = Process(self.host.command([*program, '--core', '-p', str(self.port)]),
                               self._environment)
        wait_until(lambda: self._call('getPid') == self.process.pid, 'master ' + self.uri)

    def register_publisher(self, node, topic, kind, uri):
        """As a node of that name and address would."""
        with xmlrpc.client.ServerProxy(self.uri) as proxy:
            code, text, _ = proxy.registerPublisher(node, topic, kind, uri)
        assert code == 1, text


class HostProcesses(Processes):
    """What a test starts on one host. Nodes there call themselves by its address."""

    def __init__(self, host):
        super().__init__()
        self.host = host

    def environment(self, master=None, **more):
        environment = super().environment(master)
        environment['ROS_IP'] = self.host.address
        environment.update(more)
        return {name: value for name, value in environment.items() if value is not None}

    def master(self, port=MAIN_PORT, **clock):
        master = HostMaster(self.host, self.environment(), port, **clock)
        self._masters.append(master)
        return master

    def start(self, command, master, **environment):
        return super().start(self.host.command(command), master, **environment)


class TwoHostSystem(ImaginationSystem):
    """Client and questions on the robot, workers on the other host."""

    def __init__(self, network, workers=2):
        self.network = network
        self.robot, self.other = network.hosts.values()
        super().__init__(workers)
        self.there = HostProcesses(self.other)

    def make_processes(self):
        return HostProcesses(self.robot)

    def first_port(self):
        return BASE_PORT

    def start_host(self, k, worker_arguments='', **environment):
        self.hosts[k] = self.there.start([
            executable('worker_host'), '__name:=worker_host_%d' % k,
            '_config:=' + os.path.join(CONFIG_FOLDER, 'worker_host.yaml'), '_index:=%d' % k,
            '_base_port:=%d' % self.base_port, '_address:=' + self.other.address,
            '_worker_arguments:=' + worker_arguments], self.main, **self.marked(environment))
        return self.hosts[k]

    def destroy(self):
        self.there.stop_all()
        super().destroy()
