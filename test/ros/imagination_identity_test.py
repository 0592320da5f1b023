#!/usr/bin/env python3
"""The same request and seed give the same answer, bit for bit, whoever plays the rollouts: run
alone, or by `rostest hires imagination_identity.test`."""

import os
import signal
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from imagination_system import ImaginationSystem  # noqa: E402
from test_run import run_test  # noqa: E402

ROLLOUTS = 24
SLOW_AND_FAST = ['--action', 'move_base_param', '--from', 'preManipulationAreaEastCounter1',
                 '--object', 'peppermill1', '--arg', 'preManipulationAreaNorthTable1', '--arg',
                 'slow,fast']
PLACE = ['--action', 'place_object', '--from', 'manipulationAreaSouthTable1', '--object-in-hand',
         'mug1:rightArm1', '--posture', 'torso1:TorsoUpPosture', '--posture',
         'leftArm1:ArmToSidePosture', '--arg', 'mug1', '--arg', 'rightArm1', '--arg',
         'placingAreaWestRightTable1']
OCCUPIED = ['--put', 'bowl1:7.539,11.241,0.73', '--put', 'book1:7.481,11.384,0.73', '--put',
            'book2:7.613,11.405,0.73']
FAR = ['--put', 'book1:2.9,3.1,0.01']  # on the floor, where nothing drives
NEAR = ['--put', 'book1:6.9,10.6,0.01']  # half a metre beside the robot's start


class ImaginationIdentityTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        local = ImaginationSystem(workers=1)
        cls.addClassCleanup(local.destroy)
        cls.local = local
        cls.expected = local.ask('--local', '--threads', '1', rollouts=ROLLOUTS).answer()
        cls.two = None

    @classmethod
    def with_two_workers(cls):
        """One system for all cases that need no more."""
        if cls.two is None:
            cls.two = ImaginationSystem(workers=2)
            cls.addClassCleanup(cls.two.destroy)
            cls.two.start()
        return cls.two

    def ask_with(self, workers):
        if workers == 2:
            return self.with_two_workers().ask(rollouts=ROLLOUTS).answer()
        system = ImaginationSystem(workers)
        self.addCleanup(system.destroy)
        answer = system.start().ask(rollouts=ROLLOUTS).answer()
        system.shut_down()
        return answer

    def require_expected(self, answer):
        self.assertEqual(answer.code, 0, answer.output)
        self.assertEqual(answer.rollouts(), [ROLLOUTS, ROLLOUTS])
        self.assertEqual(answer.content(), self.expected.content())

    def test_the_alternatives_differ_so_that_equality_says_something(self):
        first, second = self.expected.report['ranking']
        self.assertNotEqual(first['duration'], second['duration'])
        self.assertNotEqual(first['counts'], second['counts'])

    def test_two_threads_answer_as_one(self):
        self.require_expected(
            self.local.ask('--local', '--threads', '2', rollouts=ROLLOUTS).answer())

    def test_another_seed_gives_another_answer(self):
        other = self.local.ask('--local', rollouts=ROLLOUTS, seed=8).answer()
        self.assertNotEqual(other.content(), self.expected.content())

    def test_one_two_and_four_workers_answer_as_one_thread(self):
        for workers in (1, 2, 4):
            with self.subTest(workers=workers):
                self.require_expected(self.ask_with(workers))

    def test_a_worker_that_is_killed_half_way_changes_nothing(self):
        system = self.with_two_workers()
        watcher = system.watch()
        self.addCleanup(watcher.destroy)
        joined, told = system.times_joined(1), len(system.client.lines)
        question = system.ask(rollouts=ROLLOUTS)
        watcher.wait_for(r'feedback done=(2[4-9]|[34]\d) ')
        os.kill(system.pids_of_worker(1)['sim_worker'], signal.SIGKILL)
        self.require_expected(question.answer())
        system.client.wait_for('worker=1 lost', first=told)
        system.wait_until_joined(1, times=joined + 1)  # for the cases that follow

    def test_planned_driving_with_early_stop_is_identical_too(self):
        system = self.with_two_workers()
        arguments = {'action': SLOW_AND_FAST, 'rollouts': 32, 'early_stop': True}
        remote = system.ask(**arguments).answer()
        local = self.local.ask('--local', **arguments).answer()
        self.assertEqual(remote.code, local.code, remote.output)
        self.assertEqual(remote.content(), local.content())

    def test_what_a_change_cannot_have_touched_is_not_played_again(self):
        system = ImaginationSystem(workers=1)
        self.addCleanup(system.destroy)
        system.start(kept=100)
        for change, kept in ([], 0), ([], 8), (FAR, 8), (NEAR, 0), (FAR, 8):
            with self.subTest(change=change, kept=kept):
                answer = system.ask(*change, rollouts=4).answer()
                alone = self.local.ask('--local', *change, rollouts=4).answer()
                self.assertEqual(answer.report['rollouts_kept'], kept, answer.output)
                self.assertEqual(answer.content(), alone.content())
        system.shut_down()

    def test_arms_are_identical_too(self):
        system = self.with_two_workers()
        remote = system.ask(action=PLACE, rollouts=8).answer()
        local = self.local.ask('--local', action=PLACE, rollouts=8).answer()
        self.assertEqual(remote.code, 0, remote.output)
        self.assertEqual(remote.content(), local.content())
        self.assertGreater(remote.report['ranking'][0]['counts']['notopple'], 0)

    def test_what_stands_on_the_table_travels_to_the_workers(self):
        system = self.with_two_workers()
        remote = system.ask(action=PLACE + OCCUPIED, rollouts=8).answer()
        local = self.local.ask('--local', action=PLACE + OCCUPIED, rollouts=8).answer()
        self.assertEqual(remote.code, 2, remote.output)  # all fail
        self.assertEqual(remote.content(), local.content())
        self.assertIn('area_occupied: book1, book2, bowl1', remote.output)


if __name__ == '__main__':
    run_test('imagination_identity', ImaginationIdentityTest)
