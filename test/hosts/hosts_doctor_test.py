#!/usr/bin/env python3
"""`hires doctor --robot` asked from another computer than the robot's, a network namespace of its own:
names, addresses, clocks. And what the relay says of names that lead nowhere. Run alone, as root, or
by `rostest hires hosts_doctor.test`."""

import json
import os
import sys
import unittest


HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)

from host_processes import (HERE_IN_SOURCE, HostProcesses, TwoHostSystem, executable,  # noqa: E402
                            wait_until)
from network import Network, skip_unless_possible  # noqa: E402
from test_run import run_test  # noqa: E402

FAKE = os.path.join(HERE_IN_SOURCE, 'test', 'ros', 'support', 'doctor_robot.py')
AHEAD = 0.2  # [s]


def setUpModule():
    skip_unless_possible()


class HostsDoctorTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.network = Network('robot', 'station')
        cls.addClassCleanup(cls.network.destroy)
        cls.robot, cls.station = cls.network.hosts.values()
        cls.addClassCleanup(cls.robot.enter())

    def setUp(self):
        self.there = HostProcesses(self.robot)
        self.addCleanup(self.there.stop_all)
        self.here = HostProcesses(self.station)
        self.addCleanup(self.here.stop_all)
        self.addCleanup(self.station.know, {'robot': self.robot.address})

    def start_robot(self, clock=None, **environment):
        """Master, robot and move_base on the robot's computer, whose clock may be ahead."""
        self.main = self.there.master(**(clock or {}))
        for role in ('robot', 'move_base_node'):
            node = self.there.start(['/usr/bin/python3', FAKE, role, json.dumps(clock or {})],
                                    self.main, **environment)
            node.wait_for('^ready')

    def ask(self, **environment):
        """The doctor, asked on the station."""
        path = self.here.write('report.json', '')
        doctor = self.here.start([executable('hires'), 'doctor', '--robot', '--seconds', '1.5',
                                  '--json', path], self.main, **environment)
        code = doctor.wait()
        with open(path) as file:
            report = json.load(file)
        found = {(finding['code'], finding['subject']) for finding in report['findings']}
        return code, doctor.output(), report, found

    def test_a_clock_that_is_ahead_is_told_with_how_sure_that_is(self):
        self.start_robot({'clock': AHEAD})
        code, output, report, found = self.ask()
        self.assertIn(('clock_skew', 'clock of ' + self.robot.address), found, output)
        self.assertEqual(code, 1, output)
        clock = report['clocks'][self.robot.address]
        self.assertLessEqual(clock['ahead_at_least'], AHEAD)
        self.assertGreaterEqual(clock['ahead_at_most'], AHEAD)
        self.assertRegex(output, r'is 0\.\d+ s ahead of this computer\'s \(sure to \d+ ms, by \d+')

    def test_without_answers_that_tell_the_time_stamps_prove_a_clock_that_is_ahead(self):
        self.start_robot({'clock': AHEAD, 'tells_no_time': True})
        code, output, report, found = self.ask()
        self.assertIn(('clock_skew', 'clock of ' + self.robot.address), found, output)
        self.assertEqual((code, report['clocks']), (1, {}), output)
        self.assertRegex(output, r'is 0\.\d+ s or more ahead of .* comes before its stamp')

    def test_names_and_addresses_that_lead_nowhere_are_told(self):
        self.station.know({})
        self.start_robot(ROS_IP=None, ROS_HOSTNAME='robot')
        self.main.register_publisher('/near', '/x', 'std_msgs/String', 'http://127.0.0.1:40001/')
        self.main.register_publisher('/off', '/x', 'std_msgs/String', 'http://10.99.0.77:40001/')
        code, output, _, found = self.ask()
        self.assertEqual(code, 1, output)
        for wanted in (('unresolvable', 'host robot'), ('loopback', 'address 127.0.0.1'),
                       ('node_unreachable', 'host 10.99.0.77')):
            self.assertIn(wanted, found, output)
        self.assertIn("add a line 'ADDRESS robot' to /etc/hosts of this computer", output)
        self.assertIn(('topic_silent', 'topic /base_scan'), found, output)

    def test_only_an_address_that_the_robot_cannot_use_is_found_between_healthy_computers(self):
        self.start_robot()
        self.there.start(['rosrun', 'rosout', 'rosout'], self.main)
        wait_until(lambda: self.main.publishers('/rosout_agg'), 'rosout')
        code, output, report, found = self.ask()
        self.assertEqual((code, found), (0, set()), output)
        clock = report['clocks'][self.robot.address]
        self.assertLess(clock['ahead_at_least'], 0.05)
        self.assertGreater(clock['ahead_at_most'], -0.05)
        self.assertGreater(clock['answers'], 1)
        for name, wanted in (('localhost', 'own_loopback'), ('nobodys_name', 'not_heard')):
            code, output, _, found = self.ask(ROS_HOSTNAME=name, ROS_IP=None)
            self.assertEqual((code, found), (1, {(wanted, 'this computer')}), output)
            self.assertIn('export ROS_IP=' + self.station.address, output)


    def test_a_name_that_the_other_host_does_not_know_is_said_and_mended_without_a_restart(self):
        system = TwoHostSystem(self.network, workers=1)
        self.addCleanup(system.destroy)
        self.station.know({})
        system.start_client(client_environment={'ROS_IP': None, 'ROS_HOSTNAME': 'robot'},
                            worker_wait=0.5)
        host = system.start_host(1)
        refusal = host.wait_for('relay=worker_1 refused topic=/worker_1/rollout/goal')
        self.assertIn("add a line 'ADDRESS robot' to /etc/hosts here", refusal.string)
        self.assertEqual(system.ask().answer().code, 3, 'nobody who could be asked')
        self.station.know({'robot': self.robot.address})
        system.wait_until_joined(1)
        self.assertEqual(system.ask(rollouts=8).answer().code, 0)


if __name__ == '__main__':
    run_test('hosts_doctor', HostsDoctorTest)
