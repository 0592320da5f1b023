#!/usr/bin/env python3
"""The supervisor `worker_host` with real processes: run alone, or by `rostest hires
worker_host.test`."""

import os
import signal
import socket
import sys
import unittest
import uuid
from concurrent.futures import ThreadPoolExecutor

import yaml

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, 'support'))

from ros_processes import (Processes, executable, free_port_block, is_port_free,  # noqa: E402
                           processes_with, wait_until)
from test_run import long_case, run_test  # noqa: E402

CONFIG_FOLDER = os.path.join(HERE, '..', '..', 'config')
MARK = 'HIRES_TEST_MARK'


def kind_of(command):
    for kind in ('rosmaster', 'relay_test_peer', 'worker_host', 'relay'):
        if kind in command.split(' __')[0]:
            return kind
    return command


class Family:
    """A main master, and on demand a supervisor with its children."""

    def found(self):
        self.processes = Processes()
        self.main = self.processes.master()
        self.mark = uuid.uuid4().hex
        self.base_port = free_port_block(4)
        self.port = self.base_port + 1
        self.num_configs = 0

    def end(self):
        self.processes.stop_all()
        self.kill_marked()

    def kill_marked(self):
        for pid in processes_with(MARK, self.mark):
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass

    def write_config(self, **changes):
        with open(os.path.join(CONFIG_FOLDER, 'worker_host.yaml')) as file:
            config = yaml.safe_load(file)
        config['relay_config'] = os.path.abspath(os.path.join(CONFIG_FOLDER, 'relay.yaml'))
        config.update(changes)
        self.num_configs += 1
        return self.processes.write('worker_host_%d.yaml' % self.num_configs,
                                    yaml.safe_dump(config))

    def start_host(self, *arguments, command=None, name='worker_host_1', **changes):
        command = command or executable('relay_test_peer') + ' worker {ns} __name:=sim_{index}'
        return self.processes.start(
            [executable('worker_host'), '__name:=' + name,
             '_config:=' + self.write_config(**changes), '_base_port:=%d' % self.base_port,
             '_worker_command:=' + command, *arguments],
            self.main, **{MARK: self.mark})

    def marked(self):
        """{kind: pid} of the host's living family, itself included."""
        return {kind_of(command): pid
                for pid, command in processes_with(MARK, self.mark).items()}

    def children(self):
        return {kind: pid for kind, pid in self.marked().items() if kind != 'worker_host'}

    def wait_until_ready(self, host, times=1):
        wait_until(lambda: host.output().count('state=ready') >= times or not host.is_running(),
                   'the worker to be ready')
        assert host.is_running(), host.output()
        children = self.children()
        assert set(children) == {'rosmaster', 'relay_test_peer', 'relay'}, children

    def wait_until_crossed(self, host, times=1):
        """It is ready once anything of the worker has crossed, which its state need not be."""
        self.wait_until_ready(host, times)
        wait_until(self.mirrors, "the worker's state to cross")

    def wait_until_all_gone(self):
        wait_until(lambda: not processes_with(MARK, self.mark), 'all processes to end')

    def mirrors(self):
        return [node for node in self.main.publishers('/worker_1/state')
                if node.startswith('/mirrored/worker_1/')]

    def start_and_stop(self, number, is_half_way):
        """Stops a host by that signal in the middle of its start, or when it is ready."""
        host = self.start_host()
        if is_half_way:
            wait_until(lambda: 'rosmaster' in self.marked(), 'rosmaster')
        else:
            self.wait_until_ready(host)
        host.signal(number)
        code, left = host.wait(), processes_with(MARK, self.mark)
        assert code == 0, host.output()
        assert not left and not self.mirrors(), (left, self.mirrors())


class WorkerHostTest(Family, unittest.TestCase):
    def setUp(self):
        self.found()
        self.addCleanup(self.end)

    def test_a_worker_that_is_ready_plays_rollouts_for_the_main_master(self):
        host = self.start_host()
        self.wait_until_ready(host)
        client = self.processes.start(
            [executable('relay_test_peer'), 'goal', '/worker_1', '10', '-1'], self.main)
        client.wait_for('state=SUCCEEDED code=0 feedbacks=10')

    def test_the_death_of_any_child_brings_the_whole_worker_back(self):
        host = self.start_host()
        self.wait_until_ready(host)
        for times, kind in enumerate(('rosmaster', 'relay_test_peer', 'relay'), start=2):
            with self.subTest(killed=kind):
                before = self.children()
                os.kill(before[kind], signal.SIGKILL)
                self.wait_until_crossed(host, times)
                after = self.children()
                self.assertEqual(set(before.values()) & set(after.values()), set())
                self.assertEqual(len(self.mirrors()), 1)
        self.assertIn('restarts=3', host.output())

    def test_a_killed_host_leaves_no_child(self):
        host = self.start_host()
        self.wait_until_ready(host)
        host.kill()
        self.wait_until_all_gone()
        # The kernel closes what a killed process held a moment after it is gone from /proc.
        wait_until(lambda: is_port_free(self.port), 'the port to be free')

    def test_a_host_killed_at_any_moment_of_its_start_leaves_no_child(self):
        for wanted in ('worker_host', 'rosmaster', 'relay_test_peer', 'relay'):
            with self.subTest(killed_when_seen=wanted):
                host = self.start_host()
                wait_until(lambda: wanted in self.marked(), wanted)
                host.kill()
                self.wait_until_all_gone()

    def test_what_a_killed_host_left_at_the_main_master_is_purged_by_the_next(self):
        host = self.start_host()
        self.wait_until_crossed(host)
        first = self.mirrors()
        host.kill()
        self.wait_until_all_gone()
        self.assertEqual(self.mirrors(), first)
        self.wait_until_ready(self.start_host())
        wait_until(lambda: self.mirrors() and not set(first) & set(self.mirrors()), 'the purge')

    @long_case
    def test_twenty_starts_and_stops_leave_nothing(self):
        signals = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
        other = Family()  # two side by side, each with a main master of its own
        other.found()
        self.addCleanup(other.end)

        def play(lane, family):
            for cycle in range(lane, 20, 2):
                family.start_and_stop(signals[cycle % 3], is_half_way=cycle % 4 == 3)
        with ThreadPoolExecutor(2) as pool:
            for lane in [pool.submit(play, *lane) for lane in enumerate((self, other))]:
                lane.result()

    def test_a_port_taken_by_a_master_is_named_with_its_process(self):
        other = self.processes.master(self.port)
        host = self.start_host()
        self.assertEqual(host.wait(), 1)
        self.assertRegex(host.output(), 'port %d at 127.0.0.1 .* process id %d; end it, or choose'
                         % (self.port, other.process.pid))
        self.assertEqual(processes_with(MARK, self.mark), {})
        self.assertTrue(other.process.is_running())

    def test_a_port_taken_by_another_program_is_named(self):
        with socket.socket() as taken:
            taken.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            taken.bind(('127.0.0.1', self.port))
            taken.listen()
            host = self.start_host()
            self.assertEqual(host.wait(), 1)
        self.assertIn('port %d at 127.0.0.1' % self.port, host.output())
        self.assertIn('taken by another program', host.output())

    def test_children_are_nice_and_lead_groups_of_their_own(self):
        host = self.start_host()
        self.wait_until_ready(host)
        for kind, pid in self.children().items():
            self.assertEqual(os.getpriority(os.PRIO_PROCESS, pid), 10, kind)
            self.assertEqual(os.getpgid(pid), pid, kind)
        self.assertEqual(os.getpriority(os.PRIO_PROCESS, host.pid),
                         os.getpriority(os.PRIO_PROCESS, 0))

    def test_the_workers_master_listens_on_loopback_only(self):
        host = self.start_host()
        self.wait_until_ready(host)
        listening = []
        for table in ('/proc/net/tcp', '/proc/net/tcp6'):
            with open(table) as file:
                listening += [line.split()[1] for line in list(file)[1:] if line.split()[3] == '0A']
        mine = [entry for entry in listening if int(entry.split(':')[1], 16) == self.port]
        self.assertEqual(mine, ['0100007F:%04X' % self.port])

    def test_the_environment_and_more_arguments_reach_the_worker(self):
        host = self.start_host('_environment:=HIRES_TEST_WORKER={index} ROS_LANG_DISABLE',
                               '_worker_arguments:=__log:={ns}.log')
        self.wait_until_ready(host)
        pid = self.children()['relay_test_peer']
        with open('/proc/%d/environ' % pid) as file:
            variables = file.read().split('\0')
        self.assertIn('HIRES_TEST_WORKER=1', variables)
        self.assertIn('ROS_MASTER_URI=http://127.0.0.1:%d/' % self.port, variables)
        self.assertFalse([v for v in variables if v.startswith(('ROS_LANG_DISABLE', 'ROS_HOSTNAME'))])
        with open('/proc/%d/cmdline' % pid) as file:
            self.assertIn('__log:=/worker_1.log', file.read().split('\0'))

    def test_worker_and_relay_are_in_the_namespace_of_their_host_however_it_got_it(self):
        host = self.start_host('__ns:=hall')
        self.wait_until_ready(host)
        wait_until(lambda: self.main.publishers('/hall/worker_1/state'), "the worker's state to cross")
        for kind in ('relay_test_peer', 'relay'):
            with open('/proc/%d/environ' % self.children()[kind]) as file:
                self.assertIn('ROS_NAMESPACE=/hall', file.read().split('\0'))

    def test_a_worker_ends_when_the_main_master_is_gone_for_good(self):
        host = self.start_host(main_master_timeout=1.0)
        self.wait_until_ready(host)
        self.main.kill()
        self.assertEqual(host.wait(), 69, host.output())
        self.assertEqual(processes_with(MARK, self.mark), {})

    @long_case
    def test_a_worker_ends_when_the_main_master_hangs_for_good(self):
        host = self.start_host(main_master_timeout=1.0)
        self.wait_until_ready(host)
        self.main.process.signal(signal.SIGSTOP)
        self.assertEqual(host.wait(), 69, host.output())
        self.assertEqual(processes_with(MARK, self.mark), {})

    def test_a_worker_comes_back_to_a_new_main_master(self):
        host = self.start_host()
        self.wait_until_ready(host)
        self.main.kill()
        self.main.start()
        self.wait_until_crossed(host, 2)
        self.assertIsNotNone(self.main.node_uri('/worker_host_1'))
        self.assertEqual(len(self.mirrors()), 1)

    def test_a_worker_that_always_dies_is_given_up(self):
        limits = {'first_delay': 0.01, 'longest_delay': 0.02, 'stable_after': 30.0,
                  'most_in_a_row': 2}
        host = self.start_host(command='/bin/false', restart=limits)
        self.assertEqual(host.wait(), 1)
        self.assertEqual(host.output().count('state=restarting'), 2)
        self.assertRegex(host.output(), "state=given_up restarts=2: the worker's node .* exit code 1")
        self.assertEqual(processes_with(MARK, self.mark), {})

    def test_a_worker_from_which_nothing_crosses_is_a_failure(self):
        limits = {'first_delay': 0.01, 'longest_delay': 0.02, 'stable_after': 30.0,
                  'most_in_a_row': 0}
        host = self.start_host(command='/bin/sleep 1000', ready_timeout=0.5, restart=limits)
        self.assertEqual(host.wait(), 1)
        self.assertIn('nothing of the worker crossed to the main master within 0.5 s',
                      host.output())

    def test_mistakes_are_named(self):
        mistakes = (
            (['_index:=300'], {}, '~index is 300, wanted a whole number between 1 and 256'),
            (['_nice:=low'], {}, "~nice is 'low', wanted a whole number"),
            (['_address:=0.0.0.0'], {}, '~address is 0.0.0.0, wanted an address'),
            (['_indx:=1'], {}, "'indx' is unknown; did you mean 'index'"),
            ([], {'base_port': 80}, "base_port is '80', wanted a whole number between 1024"),
            ([], {'relay_config': '/nowhere.yaml'}, '/nowhere.yaml'),
            ([], {'master_command': ['rosmastr']}, "the program 'rosmastr' is in none of"),
            ([], {'master_command': ['x', '{prt}']}, '{prt} stands for nothing'),
            ([], {'environment': ['=x']}, 'wanted entries NAME=value'))
        hosts = [self.start_host(*arguments, name='mistaken_%d' % k, **changes)
                 for k, (arguments, changes, _) in enumerate(mistakes)]
        for host, (_, _, text) in zip(hosts, mistakes):
            with self.subTest(text=text):
                self.assertEqual(host.wait(), 1)
                self.assertIn(text, host.output())

    def test_a_host_that_waits_for_its_main_master_can_be_stopped(self):
        self.main.kill()
        host = self.start_host()
        wait_until(lambda: 'worker_host' in self.marked(), 'the host')
        host.signal(signal.SIGTERM)
        self.assertIn(host.wait(), (0, -signal.SIGTERM))


if __name__ == '__main__':
    run_test('worker_host', WorkerHostTest)
