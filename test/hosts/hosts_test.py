#!/usr/bin/env python3
"""Workers on another computer, a network namespace of its own: they imagine as one process does, also
when the cable is pulled meanwhile, and when a launch file's machine tag put them there. Run alone, as
root, or by `rostest hires hosts.test`."""

import importlib.util
import os
import sys
import threading
import unittest


HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)

from host_processes import (HERE_IN_SOURCE, HostProcesses, MAIN_PORT, TwoHostSystem,  # noqa: E402
                            executable, wait_until)
from network import Network, skip_unless_possible  # noqa: E402
from test_run import long_case, run_test  # noqa: E402

ROLLOUTS = 24
FEW = 8
# [s] More than a worker's 1.5 s of silence that count as its loss, less than the 10 s of silence
# after which a worker gives up its robot.
CUT = 5.0


def setUpModule():
    skip_unless_possible()


class HostsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.network = Network('robot', 'imaginer')
        cls.addClassCleanup(cls.network.destroy)
        cls.robot, cls.imaginer = cls.network.hosts.values()
        cls.addClassCleanup(cls.robot.enter())

    def system(self, workers=2):
        system = TwoHostSystem(self.network, workers)
        self.addCleanup(system.destroy)
        return system

    def require_as_local(self, system, *answers, rollouts=ROLLOUTS):
        local = system.ask('--local', rollouts=rollouts).answer()
        for answer in answers:
            self.assertEqual(answer.code, 0, answer.output)
            self.assertEqual(answer.rollouts(), [rollouts, rollouts])
            self.assertEqual(answer.content(), local.content())

    @long_case
    def test_another_host_answers_as_one_process_also_when_it_is_cut_off_meanwhile(self):
        system = self.system().start()
        undisturbed = system.ask(rollouts=ROLLOUTS).answer()
        disturbed = self.ask_with_a_cut(system)
        self.require_as_local(system, undisturbed, disturbed)
        log = system.client.output()
        for k in (1, 2):
            self.assertIn('worker=%d lost' % k, log)
            system.wait_until_joined(k, log.count('worker=%d lost' % k) + 1)

    def ask_with_a_cut(self, system):
        watcher = system.watch()
        question = system.ask(rollouts=ROLLOUTS)
        watcher.wait_for(r'feedback done=[1-9]')
        self.network.cut()
        self.addCleanup(self.network.mend)
        threading.Event().wait(CUT)  # how long it lasts is what is tested
        self.network.mend()
        return question.answer()

    @unittest.skipIf(importlib.util.find_spec('paramiko') is None,
                     'roslaunch needs python3-paramiko to start nodes elsewhere')
    def test_a_machine_tag_puts_workers_there_and_takes_them_away(self):
        system = self.system(workers=1)
        ssh = self.start_ssh(system)
        launch = system.run(['roslaunch', '-p', str(MAIN_PORT), 'hires', 'imagination.launch',
                             'workers:=0', 'remote_workers:=1',
                             'machines:=' + self.write_machines(system)],
                            HOME=system.processes.folder.name)
        launch.wait_for('worker=1 joined')
        self.require_as_local(system, system.ask(rollouts=FEW).answer(), rollouts=FEW)
        self.assertIn('http://%s:' % self.imaginer.address, system.main.node_uri('/worker_host_1'))
        launch.signal(2)  # as Ctrl-C
        launch.wait()
        ssh.wait_for('ended with ')
        wait_until(lambda: not self.left_there(), 'the other host to be empty')

    def left_there(self):
        """Programs of the package that still run on the other host."""
        found = []
        for pid in self.imaginer.pids():
            try:
                with open('/proc/%d/cmdline' % pid) as file:
                    command = file.read()
            except OSError:
                continue  # it ended meanwhile
            if any(name in command for name in ('sim_worker', 'rosmaster', 'relay', 'worker_host')):
                found.append(command)
        return found

    def start_ssh(self, system):
        """A server on the other host that lets this user in, and a home here that knows it."""
        import paramiko
        processes = HostProcesses(self.imaginer)
        self.addCleanup(processes.stop_all)
        home = os.path.join(system.processes.folder.name, '.ssh')
        os.mkdir(home, mode=0o700)
        keys = {}
        for name in ('id_rsa', 'host_key'):
            keys[name] = paramiko.RSAKey.generate(2048)
            keys[name].write_private_key_file(os.path.join(home, name))
        with open(os.path.join(home, 'known_hosts'), 'w') as file:
            file.write('%s ssh-rsa %s\n' % (self.imaginer.address, keys['host_key'].get_base64()))
        server = processes.start(['/usr/bin/python3', os.path.join(HERE, 'ssh_server.py'),
                                  self.imaginer.address, '22', os.path.join(home, 'host_key'),
                                  os.path.join(home, 'id_rsa')], None,
                                 HOME=processes.folder.name)
        server.wait_for('^listening')
        return server

    def write_machines(self, system):
        """config/machines_example.launch with this network's host, and with this build."""
        with open(os.path.join(HERE_IN_SOURCE, 'config', 'machines_example.launch')) as file:
            text = file.read()
        loader = system.write('on_host', '#!/bin/sh\nHIRES_ENTER=%s exec %s "$@"\n' % (
            workspace_entrance(), os.path.join(HERE_IN_SOURCE, 'scripts', 'on_host')))
        os.chmod(loader, 0o755)
        for there, here in (('192.168.1.20', self.imaginer.address), ('user="robot"', ''),
                            ('/home/robot/hires/scripts/on_host', loader),
                            ('name="workers" value="4"', 'name="workers" value="1"')):
            self.assertIn(there, text)
            text = text.replace(there, here)
        return system.write('machines.launch', text)


def workspace_entrance():
    """<workspace>/lib/hires/worker_host -> <workspace>/env.sh"""
    lib = os.path.dirname(os.path.dirname(executable('worker_host')))
    return os.path.join(os.path.dirname(lib), 'env.sh')


if __name__ == '__main__':
    run_test('hosts', HostsTest)
