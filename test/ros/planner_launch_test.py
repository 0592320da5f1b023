#!/usr/bin/env python3
"""launch/planner.launch as a user starts it knows the restaurant: run by `rostest hires
planner_launch.test`."""

import os
import subprocess
import sys
import unittest

import actionlib
import rospy

from hires.msg import Atom, PlanAction, PlanGoal, PlanResult

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from action_goal import ActionGoal  # noqa: E402
from ros_processes import LIMIT, executable  # noqa: E402
from test_run import run_test  # noqa: E402

DOMAINS = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..',
                                       'config', 'domains'))


def planned_here(*arguments):
    """The steps that `hires plan` prints."""
    return subprocess.run(
        [executable('hires'), 'plan', '--domain', os.path.join(DOMAINS, 'restaurant.lisp'),
         '--problem', os.path.join(DOMAINS, 'problems', 'serve_coffee.lisp'), '--format', 'shop2',
         *arguments], check=True, capture_output=True, text=True).stdout.splitlines()


class PlannerLaunchTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('planner_launch_test')
        cls.client = actionlib.ActionClient('plan', PlanAction)
        assert cls.client.wait_for_server(rospy.Duration(LIMIT))

    def ask(self, **fields):
        result = ActionGoal(self.client, PlanGoal(**fields)).result()
        self.assertEqual(result.outcome, PlanResult.FOUND, result.why)
        return [step.task for step in result.plans[0].steps]

    def test_coffee_is_served_as_the_command_line_plans_it(self):
        steps = self.ask(task='serve_coffee_to_guest guest1')
        self.assertEqual(len(steps), 16)
        self.assertEqual(steps, planned_here())

    def test_the_initial_facts_are_those_of_the_first_problem(self):
        self.assertEqual(self.ask(task='serve_coffee_to_guest guest1'),
                         self.ask(problem='serve_coffee'))

    def test_an_excluded_place_is_not_used(self):
        usual = self.ask(task='serve_coffee_to_guest guest1')
        places = [step for step in usual if step.startswith('(!place_object ')]
        failure = Atom('imagined_failure', places[0].strip('()').split())
        other = self.ask(task='serve_coffee_to_guest guest1', more_facts=[failure])
        self.assertNotIn(places[0], other)
        self.assertEqual(len([step for step in other if step.startswith('(!place_object ')]), 1)


if __name__ == '__main__':
    run_test('planner_launch', PlannerLaunchTest)
