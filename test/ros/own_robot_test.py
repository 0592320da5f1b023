#!/usr/bin/env python3
"""The example of a robot, world, objects, domain and knowledge of one's own: its task is planned, imagined and
done, and then the robot really stands at the table with the soup on it. Run by `rostest hires own_robot.test`,
and with a robot that steers like a car by `own_robot_car.test`."""

import json
import math
import os
import subprocess
import sys
import tempfile
import unittest

import rospy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from test_run import run_test  # noqa: E402
from true_robot import TrueRobot  # noqa: E402

AT_LONG_TABLE = (2.2, 2.3)  # [m] as in hall.world; the nearer one, which is imagined sooner
NEAR = 0.35                 # [m] the drive's own tolerance of 0.2, and what localisation errs


class OwnRobotTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = TrueRobot()

    def away(self):
        """[m] from the table's area."""
        pose = self.robot.state.pose.position
        return math.hypot(AT_LONG_TABLE[0] - pose.x, AT_LONG_TABLE[1] - pose.y)

    def test_the_soup_is_delivered_after_imagining_how_fast(self):
        self.assertTrue(self.robot.wait(60.0), 'no simulated robot')
        self.assertGreater(self.away(), 1.5)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'answer.json')
            run = subprocess.run(
                ['rosrun', 'hires', 'hires', 'achieve', 'deliver', 'soup1', 'atLongTable', '--wait', '60',
                 '--json', path], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                timeout=160.0, check=False)
            self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
            with open(path, encoding='utf-8') as file:
                told = json.load(file)
        self.assertEqual(told['outcome'], 'succeeded')
        self.assertIn('ranked', run.stdout)
        self.assertLess(self.away(), NEAR, run.stdout)

    def test_the_tasks_of_its_domain_are_listed(self):
        run = subprocess.run(['rosrun', 'hires', 'hires', 'achieve', '--list'], stdin=subprocess.DEVNULL,
                             capture_output=True, text=True, timeout=30.0, check=False)
        self.assertIn('deliver', run.stdout + run.stderr)
        self.assertNotIn('serve_coffee', run.stdout)


if __name__ == '__main__':
    rospy.init_node('own_robot_test', disable_signals=True)
    run_test('own_robot', OwnRobotTest)
