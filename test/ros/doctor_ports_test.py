#!/usr/bin/env python3
"""`hires doctor` beside a living master and node: run alone, or by `rostest hires
doctor_ports.test`."""

import os
import re
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from ros_processes import LIMIT, Processes, executable, wait_until  # noqa: E402
from test_run import run_test  # noqa: E402


class DoctorPortsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.processes = Processes()
        cls.addClassCleanup(cls.processes.stop_all)
        cls.main, alone = cls.processes.masters(2)
        cls.node = cls.processes.start(
            [executable('relay_test_peer'), 'latch', '/text', 'x'], cls.main)
        uri = wait_until(lambda: cls.main.node_uri('/relay_test_peer'), 'the node')
        cls.port = int(re.search(r':(\d+)/', uri).group(1))
        cls.beside_a_node = cls.ask(cls.main)
        cls.nowhere = cls.ask(alone, '--no-physics',
                              ROS_HOSTNAME='no-such-host.invalid')

    @classmethod
    def ask(cls, master, *options, **environment):
        return cls.processes.start([executable('hires'), 'doctor', *options], master, **environment)

    def test_master_and_open_port_of_a_node_are_named(self):
        code, output = self.beside_a_node.wait(2 * LIMIT), self.beside_a_node.output()
        self.assertEqual(code, 0, output)
        self.assertIn('ok      a master answers at %s (process id %d there)' % (
            self.main.uri, self.main.process.pid), output)
        self.assertIn("ok      ROS_IP is '127.0.0.1'", output)
        self.assertIn('0.0.0.0 port %d: relay_test_peer (process id %d)' % (
            self.port, self.node.pid), output)
        self.assertIn('sudo nft', output)
        self.assertNotIn('port %d: rosmaster' % self.main.port, output)
        self.assertIn('closed form', output)
        self.assertIn('ok      programs found: rosmaster', output)

    def test_a_name_that_leads_nowhere_fails(self):
        code, output = self.nowhere.wait(2 * LIMIT), self.nowhere.output()
        self.assertEqual(code, 1, output)
        self.assertIn("FAILED  ROS_HOSTNAME is 'no-such-host.invalid'", output)
        self.assertIn('warn    ROS_HOSTNAME ', output)
        self.assertNotIn('closed form', output)


if __name__ == '__main__':
    run_test('doctor_ports', DoctorPortsTest)
