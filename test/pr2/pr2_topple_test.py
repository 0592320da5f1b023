#!/usr/bin/env python3
"""The topple scenario whole on the fake PR2, through launch/pr2.launch: run by `rostest hires
pr2_topple.test`, with navigation:=move_base for the robot's own navigation. The robot's map lies
elsewhere than the world's frame, and turned, as every laboratory's does."""

import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from fake.scene import Pose2  # noqa: E402
from lab import Lab  # noqa: E402
from test_run import run_test  # noqa: E402

TASK = 'carry_object_on_tray peppermill1 counter1 table1'
TABLE_1 = (7.73, 11.49)  # [m] its middle
REACH = 0.75             # [m] from its middle to its farthest corner
TOP = 0.73               # [m]
X_MW = Pose2(1.4, -0.7, 0.3)  # the world's frame in the robot's map
X_WM = X_MW.inverse()


class Pr2ToppleTest(unittest.TestCase):
    navigation = 'own'

    @classmethod
    def setUpClass(cls):
        # Near the counter and with its torso up, which takes a PR2 20 s: the rest is whole.
        cls.lab = Lab(fake=dict(pose=[8.5, 9.8, 3.0], torso=0.295,
                                world_in_map=[X_MW.x, X_MW.y, X_MW.yaw]),
                      map_to_world='%.6f %.6f %.6f 1' % (X_WM.x, X_WM.y, X_WM.yaw),
                      navigation=cls.navigation, workers=1)
        cls.addClassCleanup(cls.lab.stop)
        cls.lab.start()
        cls.lab.connect('pr2_topple')
        cls.objects = []
        cls.lab.rospy.Subscriber('fake_pr2/objects', cls.lab.msg.WorldState, cls.objects.append)

    def test_the_mill_stands_on_table_1(self):
        task = self.lab.achieve(TASK)
        result = task.result()
        self.assertEqual(result.code, self.lab.msg.AchieveResult.SUCCEEDED,
                         '%s\n%s' % (result.reason, self.lab.output()[-6000:]))
        mill = self.objects[-1].objects[0]
        at = mill.pose.position
        x, y = X_WM.apply(at.x, at.y)
        self.assertLess(max(abs(x - TABLE_1[0]), abs(y - TABLE_1[1])), REACH)
        self.assertAlmostEqual(at.z, TOP, delta=0.01)
        self.assertEqual(mill.attached_to, '')
        on_the_way = {o.objects[0].attached_to for o in self.objects}
        self.assertIn('base_footprint', on_the_way, 'it was on the tray')
        imagined = [i for i in result.imaginations if i.outcome]
        self.assertTrue(imagined, 'something was imagined')
        print('topple, %s: %d steps, %d replans, %.0f s, imagined %s' % (
            self.navigation, len(result.steps), result.replans,
            self.lab.truth.samples[-1][0] - self.lab.truth.samples[0][0],
            [(i.action.name, i.outcome, i.recommended) for i in imagined]))


class Pr2ToppleMoveBaseTest(Pr2ToppleTest):
    navigation = 'move_base'


if __name__ == '__main__':
    run_test('pr2_topple',
             Pr2ToppleMoveBaseTest if '--move_base' in sys.argv else Pr2ToppleTest)
