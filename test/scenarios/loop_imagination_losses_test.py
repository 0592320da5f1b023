#!/usr/bin/env python3
"""Whoever imagines is dead, slow or lost: the run completes as the domain says, and a warning says
so. Run alone, or by `rostest hires loop_imagination_losses.test`."""

import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from loop_case import AT_COUNTER, MUG, LoopCase, names  # noqa: E402
from test_run import run_test  # noqa: E402

THERE = 'carry_object_on_tray mug1 counter1 table1'
BACK = 'carry_object_on_tray mug1 table1 counter1'


class ImaginationLossesTest(LoopCase):
    def drive_of(self, result):
        drives = self.steps_of(result, 'move_base_param')
        self.assertEqual(len(drives), 1, [names(d.action) for d in drives])
        return drives[0]

    def assert_default_was_driven(self, task, result, *words):
        drive = self.drive_of(result)
        self.assertEqual(drive.action.arguments[-1], 'slow')
        self.assertTrue(drive.note.startswith('not imagined'), drive.note)
        self.warned(task, names(drive.action), 'without imagination', *words)

    def test_the_default_is_driven_without_client_with_one_that_hangs_and_without_workers(self):
        self.begin(AT_COUNTER, MUG)
        with self.subTest('the client is killed while it imagines'):
            task = self.achieve(THERE)
            self.wait_for_imagination(task)
            self.loop.kill('imagination_client')
            result = self.require(task, self.codes.SUCCEEDED)
            self.assertIn('unavailable', [i.outcome for i in result.imaginations])
            self.assert_default_was_driven(task, result, 'imagination is not available')
            self.assert_on_table1('mug1')
        self.loop.start_node('imagination_client')
        with self.subTest('the client hangs while it imagines'):
            task = self.achieve(BACK)
            self.wait_for_imagination(task)
            self.loop.pause('imagination_client')
            result = self.require(task, self.codes.SUCCEEDED)
            self.assert_default_was_driven(task, result)
            self.assert_on_counter('mug1')
        self.loop.unpause('imagination_client')
        with self.subTest('all workers are lost while they imagine'):
            task = self.achieve(THERE)
            self.wait_for_imagination(task)
            self.loop.kill_workers()
            result = self.require(task, self.codes.SUCCEEDED)
            self.assert_default_was_driven(task, result)
            self.assertNotIn('ranked', [i.outcome for i in result.imaginations])
            self.assert_on_table1('mug1')

    def test_where_the_domain_says_wait_the_robot_waits_for_a_worker(self):
        self.begin(AT_COUNTER, MUG, on_late='wait')
        self.loop.wait_for_worker(1)
        self.loop.kill_workers()
        task = self.achieve(THERE)
        self.wait_for_step(task, 'move_base_param', self.phases.READY)
        self.wait_until_it_stands()
        self.loop.start_worker(1)
        result = self.require(task, self.codes.SUCCEEDED)
        drive, answer = self.drive_of(result), result.imaginations[-1]
        self.assertTrue(drive.note.startswith('imagined'), drive.note)
        self.assertIn('no_worker', [i.outcome for i in result.imaginations])
        self.assertEqual(answer.outcome, 'ranked')
        self.assertGreaterEqual(drive.started, answer.answered)
        self.assert_on_table1('mug1')


if __name__ == '__main__':
    run_test('loop_imagination_losses', ImaginationLossesTest)
