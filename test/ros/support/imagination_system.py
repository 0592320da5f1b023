"""The imagination client and its workers as real processes under a main master of their own.

    system = ImaginationSystem(workers=2)
    system.start()
    answer = system.ask(rollouts=40).answer()
    system.destroy()

Every process carries a mark in its environment, which its children inherit: so a test can say what
is left of it, and nothing of it is left in any case.
"""

import json
import os
import re
import signal
import time
import uuid

import yaml

from ros_processes import (LIMIT, Processes, executable, free_port_block, processes_with,
                           wait_until)

CONFIG_FOLDER = os.path.abspath(
    os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', '..', 'config'))
MARK = 'HIRES_TEST_MARK'

# Two ways that differ: the mill stays up on some of them, and a rollout takes little time.
ACTION = ['--action', 'move_base_blind', '--from', 'preManipulationAreaEastCounter1', '--object',
          'peppermill1', '--arg', 'preManipulationAreaSouthTable1,preManipulationAreaNorthTable1']


def read_yaml(name):
    with open(os.path.join(CONFIG_FOLDER, name)) as file:
        return yaml.safe_load(file)


class Answer:
    """What a run of `hires imagine` came to."""

    def __init__(self, code, output, report):
        self.code = code
        self.output = output
        self.report = report  # None if there was none

    def content(self):
        """The report without how it was asked for and what the clock had a hand in."""
        return {key: value for key, value in self.report.items()
                if key not in ('report', 'wall_seconds', 'real_time_factor', 'rollouts_kept')}

    def rollouts(self):
        return [prediction['rollouts'] for prediction in self.report['ranking']]


class Question:
    """A running `hires imagine`."""

    def __init__(self, process, path):
        self.process = process
        self._path = path

    def answer(self, limit=3 * LIMIT):
        """Waits for its end."""
        code = self.process.wait(limit)
        report = None
        if os.path.exists(self._path):
            with open(self._path) as file:
                report = json.load(file)
        return Answer(code, self.process.output(), report)


class ImaginationSystem:
    def __init__(self, workers=2):
        self.processes = self.make_processes()
        self.workers = workers
        self.mark = uuid.uuid4().hex
        self.base_port = self.first_port()
        self.main = self.processes.master()
        self.client = None
        self.hosts = {}
        self._num_files = 0

    # Where it runs; others put it elsewhere.

    def make_processes(self):
        return Processes()

    def first_port(self):
        return free_port_block(self.workers + 1) - 1

    # Parts.

    def marked(self, environment):
        return {MARK: self.mark, **environment}

    def run(self, command, **environment):
        return self.processes.start(command, self.main, **self.marked(environment))

    def start(self, **scheduler):
        """Client and all workers; returns when each worker has joined."""
        self.start_client(**scheduler)
        for k in range(1, self.workers + 1):
            self.start_host(k)
        for k in self.hosts:
            self.wait_until_joined(k)
        return self

    def client_config(self, kept=0, **scheduler):
        """Without rollouts of earlier requests, which would make every second answer equal."""
        config = read_yaml('imagination_client.yaml')
        for key in ('scene', 'prices', 'validated'):
            config[key] = os.path.join(CONFIG_FOLDER, key + '.yaml')
        config['kept_rollouts'] = kept
        config['scheduler'].update(scheduler)
        return self.write('imagination_client.yaml', yaml.safe_dump(config))

    def start_client(self, client_environment=None, arguments=(), **scheduler):
        self.client = self.run([
            executable('imagination_client'), '_config:=' + self.client_config(**scheduler),
            '_workers:=%d' % self.workers,
            '_rollout_folder:=' + os.path.join(self.processes.folder.name, 'rollouts'),
            *arguments], **(client_environment or {}))
        return self.client

    def start_host(self, k, worker_arguments=''):
        self.hosts[k] = self.run([
            executable('worker_host'), '__name:=worker_host_%d' % k,
            '_config:=' + os.path.join(CONFIG_FOLDER, 'worker_host.yaml'), '_index:=%d' % k,
            '_base_port:=%d' % self.base_port, '_worker_arguments:=' + worker_arguments])
        return self.hosts[k]

    def watch(self):
        """A process that tells about feedback, results and workers; it is connected."""
        watcher = self.run([executable('imagination_watcher'), str(self.workers)])
        watcher.wait_for('^watching')
        return watcher

    def ask(self, *more, action=None, rollouts=40, seed=7, early_stop=False):
        """Starts `hires imagine`."""
        path = self.file('answer.json')
        if not early_stop:
            more += ('--no-early-stop',)
        process = self.run([executable('hires'), 'imagine', *(action or ACTION), '--rollouts',
                            str(rollouts), '--seed', str(seed), '--json', path, *more])
        return Question(process, path)

    def file(self, name):
        """Path of a file of its own that is not there yet."""
        self._num_files += 1
        return os.path.join(self.processes.folder.name, '%d_%s' % (self._num_files, name))

    def write(self, name, text):
        path = self.file(name)
        with open(path, 'w') as file:
            file.write(text)
        return path

    # What is there.

    def worker_port(self, k):
        return self.base_port + k

    def wait_until_joined(self, k, times=1):
        """Until the client has said so many times that worker k joined."""
        wait_until(lambda: len(re.findall(r'worker=%d joined' % k, self.client.output())) >= times
                   or not self.client.is_running(), 'worker %d to join' % k)
        if not self.client.is_running():
            raise AssertionError('the imagination client ended:\n' + self.client.output())

    def times_joined(self, k):
        return len(re.findall(r'worker=%d joined' % k, self.client.output()))

    def alive(self):
        """{pid: command line}"""
        return processes_with(MARK, self.mark)

    def pids_of_worker(self, k):
        """{sim_worker, rosmaster, relay: pid} of what lives of worker k's children."""
        signs = {'sim_worker': '__name:=sim_worker_%d' % k, 'relay': '__name:=relay_%d' % k,
                 'rosmaster': '-p %d' % self.worker_port(k)}
        return {kind: pid for pid, command in self.alive().items()
                for kind, sign in signs.items() if ' %s ' % sign in ' %s ' % command}

    # The end.

    def shut_down(self):
        """Stops everything as a user would; [s] it took."""
        begin = time.monotonic()
        for process in [*self.hosts.values(), self.client]:
            process.signal(signal.SIGINT)
        for pid, command in self.alive().items():
            if 'imagination_watcher' in command:
                os.kill(pid, signal.SIGTERM)
        wait_until(lambda: not self.alive(), 'all processes to end, but there are still %s' %
                   self.alive(), 20.0)
        return time.monotonic() - begin

    def destroy(self):
        """Kills what is left; fit for addCleanup."""
        self.processes.stop_all()
        for pid in self.alive():
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
