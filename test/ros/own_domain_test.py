#!/usr/bin/env python3
"""The example of a domain of one's own: its task is done, its steps one after the other. Run by `rostest hires
own_domain.test`."""

import json
import os
import subprocess
import sys
import tempfile
import unittest

import rospy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from test_run import run_test  # noqa: E402


class OwnDomainTest(unittest.TestCase):
    def test_its_task_is_done_in_the_order_of_its_subtasks(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'answer.json')
            run = subprocess.run(
                ['rosrun', 'hires', 'hires', 'achieve', 'patrol', 'preManipulationAreaEastCounter1',
                 'preManipulationAreaNorthTable1', '--wait', '60', '--json', path],
                stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=160.0, check=False)
            self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
            with open(path, encoding='utf-8') as file:
                told = json.load(file)
        # How the robot errs depends on when it is asked; one drive in hundreds is stopped and begun again.
        steps = [step for step in told['steps'] if step['phase'] == 'done']
        self.assertEqual(len(steps), 3, run.stdout)
        for before, after in zip(steps, steps[1:]):
            self.assertGreaterEqual(after['started'], before['finished'])


if __name__ == '__main__':
    rospy.init_node('own_domain_test', disable_signals=True)
    run_test('own_domain', OwnDomainTest)
