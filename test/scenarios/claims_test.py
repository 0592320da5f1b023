#!/usr/bin/env python3
"""Which effect a failed step misses, told by what its failure names and by its action."""

import os
import sys
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.join(HERE, folder) for folder in ('support', '../ros/support')]

from hires.msg import ActionCall, Failure, StepStatus  # noqa: E402

from claims import condition_of, effect_of  # noqa: E402


def missing(subjects, name, *arguments):
    return effect_of(StepStatus(action=ActionCall(name=name, arguments=list(arguments)),
                                failure=Failure(code=Failure.EFFECT_MISSING, subjects=subjects)))


class EffectOfTest(unittest.TestCase):

    def test_a_hand_that_picked_holds_the_thing_and_no_longer_nothing(self):
        for subjects, effect in ((['leftarm1', 'mug1'], ('holding', True)),
                                 (['leftarm1', 'nothing'], ('holding', False)),
                                 (['mug1', 'counter1'], ('on', False))):
            self.assertEqual(missing(subjects, 'pick_up_object', 'mug1', 'leftarm1'), effect)

    def test_a_hand_that_placed_holds_nothing_and_the_thing_is_on_the_area(self):
        for subjects, effect in ((['leftarm1', 'mug1'], ('holding', False)),
                                 (['leftarm1', 'nothing'], ('holding', True)),
                                 (['mug1', 'trayarea1'], ('on', True))):
            self.assertEqual(missing(subjects, 'place_on_tray', 'leftarm1', 'mug1'), effect)

    def test_a_robot_is_where_it_went_and_not_where_it_was(self):
        self.assertEqual(missing(['home'], 'move_base', 'home'), ('robotat', True))
        self.assertEqual(missing(['home'], 'move_base', 'nearStartArea1'), ('robotat', False))

    def test_postures_of_arms_are_not_told_by_truth(self):
        for name in ('tuck_arms', 'move_arm_to_side'):
            self.assertIsNone(missing(['leftarm1', 'armcarryposture'], name, 'leftarm1'))


class ConditionOfTest(unittest.TestCase):

    def test_what_a_step_rests_on_is_told_by_its_arguments(self):
        for subjects, predicate in ((['mug1', 'trayarea1'], 'on'), (['leftarm1', 'mug1'], 'holding'),
                                    (['home'], 'robotat'), (['torsoupposture'], None), ([], None)):
            self.assertEqual(condition_of(subjects), predicate)


if __name__ == '__main__':
    unittest.main()
