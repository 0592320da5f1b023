#!/usr/bin/env python3
"""A dry run of the execution monitor, with the real planner and Blackboard: what it says, and that it
asks the robot for nothing. Run alone, or by `rostest hires execution_dry_run.test`."""

import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from diagnostics import diagnostics  # noqa: E402
from execution_system import CARRY, ExecutionSystem  # noqa: E402
from ros_processes import executable, wait_until  # noqa: E402
from test_run import run_test  # noqa: E402

NORTH = 'premanipulationareanorthtable1'


class ExecutionDryRunTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.system = system = ExecutionSystem()
        cls.addClassCleanup(system.destroy)
        system.start_blackboard()
        system.start_planner()
        for role in ('imagination', 'translator'):  # nobody could move anything
            system.start_fake(role)
        system.start_monitor('_dry_run:=true')
        system.connect()
        diagnostics(system.rospy, 'execution_monitor', lambda values: all(
            values[server] == 'there' for server in ('planner', 'imagination_client', 'translator')))
        cls.codes = system.msg.AchieveResult
        cls.phases = system.msg.StepStatus

    def setUp(self):
        self.asked = []
        self.watch = self.system.rospy.Subscriber(
            'execute_action/goal', self.system.msg.ExecuteActionActionGoal, self.asked.append)
        self.addCleanup(self.watch.unregister)
        wait_until(lambda: self.watch.get_num_connections() > 0, 'word of what the robot is asked')
        self.system.reset()

    def require(self, task, code):
        result = task.result()
        self.assertEqual(result.code, code, result.reason)
        self.assertEqual(self.asked, [])
        return result

    def test_the_plan_is_told_with_what_is_imagined_and_nothing_is_begun(self):
        result = self.require(self.system.achieve(CARRY), self.codes.DRY_RUN)
        self.assertIn('nothing was begun', result.reason)
        drive = [s for s in result.steps if s.action.name == 'move_base_param'][0]
        self.assertEqual(drive.action.arguments, [NORTH, 'slow'])
        self.assertIn('imagined', drive.note)
        actions = [s for s in result.steps if s.action.name != 'imagine']
        self.assertEqual({s.phase for s in actions}, {self.phases.WAITING})
        asked = [(i.action.name, i.outcome) for i in result.imaginations]
        self.assertEqual(asked, [('move_base_param', 'ranked'), ('move_base', 'ranked')])

    def test_a_drive_from_anywhere_lasts_as_long_as_imagined(self):
        result = self.require(self.system.achieve(CARRY), self.codes.DRY_RUN)
        first = [s for s in result.steps if s.action.name == 'move_base'][0]
        self.assertAlmostEqual(first.expected_finish - first.expected_start, 20.0)
        self.assertEqual(first.note, 'lasts 20.0 s as imagined')

    def test_where_everything_is_imagined_to_fail_there_is_no_plan(self):
        self.system.behave('imagine', answer='all_failed')
        self.require(self.system.achieve(CARRY), self.codes.NO_PLAN)

    def test_without_imagination_the_plan_is_told_alone(self):
        result = self.require(self.system.achieve(CARRY, imagination='off'), self.codes.DRY_RUN)
        self.assertEqual(list(result.imaginations), [])

    def test_the_command_line_prints_the_plan_and_ends_well(self):
        achieve = self.system.processes.start(
            [executable('hires'), 'achieve', *CARRY.split(), '--wait', '60'], self.system.main)
        self.assertEqual(achieve.wait(), 0, achieve.output())
        self.assertIn('would begin', achieve.output())
        self.assertIn('move_base_param(%s, slow)' % NORTH, achieve.output())
        self.assertIn('dry_run: planned and imagined; nothing was begun', achieve.output())
        self.assertEqual(self.asked, [])

    def test_no_controller_has_a_publisher(self):
        for topic, nodes in self.system.main.publishers().items():
            self.assertFalse(topic.endswith(('cmd_vel', '_controller/command')), (topic, nodes))


if __name__ == '__main__':
    run_test('execution_dry_run', ExecutionDryRunTest)
