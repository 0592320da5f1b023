#!/usr/bin/env python3
"""The middle layer and the simulated robot as real processes: driving, breaking off, a robot that is
pushed, goals that make no sense, goals side by side, the end of the node. In lockstep, as fast as it
goes. Run alone, or by `rostest hires middle_layer.test`."""

import math
import os
import signal
import sys
import unittest

import rosunit

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from robot_system import RobotSystem  # noqa: E402
from ros_processes import wait_until  # noqa: E402

# Poses of areas in worlds/restaurant.world: x, y [m], yaw [rad].
EAST_TABLE_2 = (11.78, 11.49, 3.14)
START = (12.5, 11.8, 3.14)
XY_TOLERANCE, YAW_TOLERANCE = 0.2, 0.17  # config/scene.yaml
STOPPING = 0.08  # [m] the base rolls on a little after it counts as arrived


def distance(state, pose):
    return math.hypot(state.pose.position.x - pose[0], state.pose.position.y - pose[1])


def speed(state):
    return math.hypot(state.twist.linear.x, state.twist.linear.y)


class MiddleLayerTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.system = RobotSystem(uncertainty='none', lockstep=True, pace=0.0)
        cls.addClassCleanup(cls.system.stop)
        cls.system.connect('middle_layer_test')
        cls.codes = cls.system.codes

    def setUp(self):
        self.system.start_robot()
        self.system.start_middle_layer()
        self.system.require_server()

    def tearDown(self):
        self.assertTrue(self.system.robot.is_running(), self.system.robot.output())
        self.system.end_processes()

    def require(self, result, code, reason=''):
        self.assertEqual((result.code, result.reason), (code, reason), self.system.output())
        return result

    def require_arrival(self, pose, tolerance):
        self.system.wait_for_truth(
            lambda s: speed(s) < 0.02 and distance(s, pose) < tolerance,
            'the robot to stand within %g m of %s' % (tolerance, pose))

    def path_from(self, first):
        return [state for _, state in self.system.truth[first:]]

    # Driving

    def test_drives_to_an_area_round_obstacles(self):
        goal = self.system.execute('move_base', 'preManipulationAreaEastTable2')
        result = self.require(goal.result(), self.codes.SUCCEEDED)
        self.require_arrival(EAST_TABLE_2, XY_TOLERANCE + STOPPING)
        self.assertGreater(result.duration, 1.0)

    def test_motion_sets_bound_the_speed(self):
        fastest = {}
        for motion_set, area in (('slow', 'preManipulationAreaWestTable2'),
                                 ('fast', 'nearStartArea1')):
            first = len(self.system.truth)
            goal = self.system.execute('move_base_param', area, motion_set)
            self.require(goal.result(), self.codes.SUCCEEDED)
            fastest[motion_set] = max(map(speed, self.path_from(first)))
        self.assertLess(fastest['slow'], 0.33)
        self.assertGreater(fastest['fast'], 0.45)

    def test_drives_blindly(self):
        goal = self.system.execute('move_base_blind', 'home')
        self.require(goal.result(), self.codes.SUCCEEDED)
        self.require_arrival((13.0, 11.3), 0.05)

    def test_a_pushed_robot_plans_anew_and_arrives(self):
        goal = self.system.execute('move_base', 'preManipulationAreaWestTable2')
        self.system.wait_for_truth(lambda s: distance(s, START) > 0.5, 'the robot to be on its way')
        answer = self.system.call('push', self.system.srv.PushRobot,
                                  offset=self.pose_2d(-0.2, 0.4, 0.5))
        self.assertTrue(answer.success, answer.message)
        self.require(goal.result(), self.codes.SUCCEEDED)
        self.require_arrival((9.0, 11.49), XY_TOLERANCE + STOPPING)

    def pose_2d(self, x, y, theta):
        from geometry_msgs.msg import Pose2D
        return Pose2D(x=x, y=y, theta=theta)

    # Breaking off

    def test_preempting_a_drive_leaves_the_robot_standing(self):
        goal = self.system.execute('move_base', 'preManipulationAreaEastCounter1')
        self.system.wait_for_truth(lambda s: speed(s) > 0.4, 'the robot to be fast')
        first = len(self.system.truth)
        self.require(goal.cancel().result(), self.codes.PREEMPTED)
        self.system.wait_for_truth(lambda s: speed(s) < 0.02, 'the robot to stand')
        after = self.path_from(first)
        braking = [(a, b) for a, b in zip(after, after[1:]) if speed(b) < speed(a)]
        # 1 m/s^2 as configured, in steps of 0.05 s; the base's velocity loop swings a little.
        self.assertLess(max(speed(a) - speed(b) for a, b in braking), 2.0 * 0.05)

    def test_preempting_a_blind_drive_leaves_the_robot_standing(self):
        goal = self.system.execute('move_base_blind', 'preManipulationAreaEastTable2')
        self.system.wait_for_truth(lambda s: speed(s) > 0.1, 'the robot to move')
        self.require(goal.cancel().result(), self.codes.PREEMPTED)
        self.system.wait_for_truth(lambda s: speed(s) < 0.02, 'the robot to stand')

    def test_the_time_limit_ends_a_drive(self):
        goal = self.system.execute('move_base', 'preManipulationAreaEastCounter1', limit=2.0)
        result = self.require(goal.result(), self.codes.FAILED, 'timed_out')
        self.assertGreater(result.duration, 2.0)
        self.system.wait_for_truth(lambda s: speed(s) < 0.02, 'the robot to stand')

    def test_the_robot_stands_when_the_node_ends(self):
        for number in (signal.SIGINT, signal.SIGKILL):
            with self.subTest(signal=number):
                self.system.execute('move_base', 'preManipulationAreaEastCounter1')
                self.system.wait_for_truth(lambda s: speed(s) > 0.3, 'the robot to be fast')
                self.system.middle_layer.signal(number)
                self.system.middle_layer.wait()
                self.system.wait_for_truth(lambda s: speed(s) < 0.02, 'the robot to stand')
                self.system.start_middle_layer()
                self.system.require_server()

    # Goals

    def test_goals_that_make_no_sense_are_refused_with_the_reason(self):
        bad = [
            (('juggle', 'mug1'), 'juggle'),
            (('move_base',), '1 (area)'),
            (('move_base', 'a', 'b'), '1 (area)'),
            (('move_base', 'preManipulationAreaNorthCounter1'), 'preManipulationAreaNorthCounter1'),
            (('move_base_param', 'home', 'sideways'), 'sideways'),
            (('', ), "action ''"),
        ]
        for words, expected in bad:
            with self.subTest(goal=words):
                result = self.system.execute(*words).result()
                self.assertEqual(result.code, self.codes.INVALID, result.reason)
                self.assertIn(expected.lower(), result.reason.lower())
        result = self.system.execute('move_base', 'home', limit=-1.0).result()
        self.assertEqual(result.code, self.codes.INVALID)
        self.assertIn('time_limit', result.reason)

    def test_a_conflicting_goal_is_refused_and_disturbs_nobody(self):
        first = self.system.execute('move_base', 'preManipulationAreaEastTable2').wait_for_active()
        second = self.system.execute('move_base_blind', 'home').result()
        self.assertEqual(second.code, self.codes.INVALID)
        self.assertEqual(second.reason,
                         'busy: move_base(preManipulationAreaEastTable2) needs base')
        self.require(first.result(), self.codes.SUCCEEDED)

    def test_feedback_tells_how_long_it_runs(self):
        goal = self.system.execute('move_base', 'preManipulationAreaEastTable2')
        result = self.require(goal.result(), self.codes.SUCCEEDED)
        elapsed = [feedback.elapsed for feedback in goal.feedback]
        self.assertEqual(elapsed, sorted(elapsed))
        self.assertGreater(len(elapsed), 5)
        self.assertLessEqual(elapsed[-1], result.duration)

    def test_diagnostics_say_what_runs(self):
        from diagnostic_msgs.msg import DiagnosticArray
        seen = []
        subscriber = self.system.rospy.Subscriber('/diagnostics', DiagnosticArray, seen.append)
        self.addCleanup(subscriber.unregister)
        goal = self.system.execute('move_base', 'preManipulationAreaEastCounter1')

        def is_told():
            return any(value.key == 'running' and 'move_base' in value.value
                       for array in list(seen) for status in array.status
                       for value in status.values)
        self.system.hold(True)
        wait_until(is_told, 'the diagnostics to name the action')
        self.system.hold(False)
        goal.cancel().result()


if __name__ == '__main__':
    rosunit.unitrun('hires', 'middle_layer', MiddleLayerTest)
