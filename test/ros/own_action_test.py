#!/usr/bin/env python3
"""`hires achieve greet guest1`: the library's action is planned, imagined and done, and then the
simulated robot really faces the guest. Run by `rostest hires own_action.test actions:=.../libown_action.so`."""

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

SEAT = (7.05, 11.43)  # [m] sittingAreaWestTable1, where guest1 sits
FACING = 0.06         # [rad] the skill's own tolerance of 0.03, and what localisation errs


class OwnActionTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = TrueRobot()

    def away(self):
        """[rad] by which the robot does not face the guest."""
        pose = self.robot.state.pose.position
        return abs(math.remainder(
            math.atan2(SEAT[1] - pose.y, SEAT[0] - pose.x) - self.robot.state.yaw, 2.0 * math.pi))

    def test_the_robot_turns_towards_the_guest(self):
        self.assertTrue(self.robot.wait(60.0), 'no simulated robot')
        self.assertGreater(self.away(), 0.3)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'answer.json')
            run = subprocess.run(
                ['rosrun', 'hires', 'hires', 'achieve', 'greet', 'guest1', '--wait', '120',
                 '--json', path], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                timeout=240.0, check=False)
            self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
            with open(path, encoding='utf-8') as file:
                told = json.load(file)
        self.assertIn('turn_towards', json.dumps(told))
        self.assertRegex(run.stdout, 'ranked|close')
        self.assertLess(self.away(), FACING, run.stdout)


if __name__ == '__main__':
    rospy.init_node('own_action_test', disable_signals=True)
    run_test('own_action', OwnActionTest)
