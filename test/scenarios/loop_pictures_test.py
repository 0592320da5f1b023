#!/usr/bin/env python3
"""The whole system sees by pictures alone: a node recognises objects in the camera's clouds, and nobody
tells it, or any other node that decides, what is true. Run alone, or by
`rostest hires loop_pictures.test`."""

import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from closed_loop import RECOGNISER  # noqa: E402
from loop_case import AT_COUNTER, TABLE_TOP, LoopCase  # noqa: E402
from test_run import run_test  # noqa: E402

MILL = {'peppermill1': (5.47, 10.16, 0.75, 0.0)}
CARRY = 'carry_object_on_tray peppermill1 counter1 table1'


class LoopPicturesTest(LoopCase):
    SETTINGS = dict(sensing='pictures')

    def test_the_mill_gets_to_the_table_and_nobody_looks_at_the_truth(self):
        self.begin(AT_COUNTER, MILL)
        task = self.achieve(CARRY)
        self.wait_for_step(task, 'pick_up_object')
        me = self.loop.rospy.get_name()
        truths = [topic for topic in self.loop.main.publishers() if 'ground_truth' in topic]
        self.assertEqual(len(truths), 3, truths)
        for topic in truths:
            self.assertEqual(self.loop.main.subscribers(topic), [me], topic)
        self.assertEqual(self.loop.main.publishers('/detections'), ['/' + RECOGNISER])
        self.require(task, self.codes.SUCCEEDED)
        self.wait_until_it_stands()
        self.assert_on_table1('peppermill1')
        self.assert_stands_upright('peppermill1', TABLE_TOP)


if __name__ == '__main__':
    run_test('loop_pictures', LoopPicturesTest)
