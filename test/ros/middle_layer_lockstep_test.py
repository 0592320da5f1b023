#!/usr/bin/env python3
"""Load on the machine changes nothing: in lockstep the same action gives the same true path bit by
bit, whatever else runs. And the same code: a skill through topics and controllers takes the path
that it takes in a rollout. Run alone, or by `rostest hires middle_layer_lockstep.test`."""

import multiprocessing
import os
import subprocess
import sys
import unittest

import rosunit

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from robot_system import RobotSystem  # noqa: E402
from ros_processes import executable  # noqa: E402

CONFIG = os.path.abspath(
    os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'config'))
SCENE = os.path.join(CONFIG, 'scene.yaml')
TICK = 50000000  # [ns]
POSITION, ANGLE = 0.02, 0.02  # [m], [rad]: how far the two ways may differ


def burn():
    while True:
        pass


class Hogs:
    """More busy processes than there are processors."""

    def __enter__(self):
        self._hogs = [multiprocessing.Process(target=burn, daemon=True)
                      for _ in range(2 * os.cpu_count())]
        for hog in self._hogs:
            hog.start()

    def __exit__(self, *_):
        for hog in self._hogs:
            hog.kill()
            hog.join()


def values_of(state):
    """Everything about the robot that can differ, as exact numbers."""
    return (state.pose.position.x, state.pose.position.y, state.yaw, state.twist.linear.x,
            state.twist.linear.y, state.twist.angular.z, tuple(state.joints.name),
            tuple(state.joints.position))


def wrapped(angle):
    import math
    return math.remainder(angle, 2.0 * math.pi)


class MiddleLayerLockstepTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.system = RobotSystem(lockstep=True, pace=0.0, hold=True)
        cls.addClassCleanup(cls.system.stop)
        cls.system.connect('middle_layer_lockstep_test')

    def run_action(self, action, **robot):
        """Result, and {stamp: true state} from the action's begin to its end."""
        self.system.start_robot(**robot)
        self.system.start_middle_layer()
        self.system.require_server()
        self.system.wait_for_truth(lambda s: True, 'the truth')
        goal = self.system.execute(*action).wait_for_active()
        self.system.hold(False)
        result = goal.result()
        begin = self.system.truth[0][0] + TICK  # it was held at the first one
        self.system.wait_for_truth(
            lambda s: s.joints.header.stamp.to_nsec() >= begin + result.duration * 1e9,
            'the truth to come to the end')
        self.system.end_processes()
        end = begin + round(result.duration * 1e9)
        path = {stamp: state for stamp, state in self.system.truth if begin <= stamp <= end}
        return result, path

    def test_load_changes_nothing(self):
        action = ('move_base_param', 'preManipulationAreaEastTable2', 'fast')
        scenario = os.path.join(CONFIG, 'scenarios', 'topple.yaml')
        runs = []
        for with_hogs in (False, True, False, True):
            if with_hogs:
                with Hogs():
                    runs.append(self.run_action(action, seed=3, scenario=scenario))
            else:
                runs.append(self.run_action(action, seed=3, scenario=scenario))
        result, path = runs[0]
        self.assertEqual(result.code, self.system.codes.SUCCEEDED, result.reason)
        self.assertGreater(len(path), 50)
        exact = {stamp: values_of(state) for stamp, state in path.items()}
        for other_result, other_path in runs[1:]:
            self.assertEqual((other_result.code, other_result.reason, other_result.duration),
                             (result.code, result.reason, result.duration))
            self.assertEqual({stamp: values_of(state) for stamp, state in other_path.items()},
                             exact)

    def test_another_seed_is_another_truth(self):
        action = ('move_base_blind', 'home')
        paths = [self.run_action(action, seed=seed)[1] for seed in (1, 2)]
        last = [values_of(path[max(path)]) for path in paths]
        self.assertNotEqual(last[0], last[1])

    # The same code

    def rollout(self, where, action):
        """How the skill ended in a rollout, and its path: [(x, y, yaw, {joint: position})]."""
        output = subprocess.run([executable('skill_trace'), SCENE, where, *action], check=True,
                                stdout=subprocess.PIPE, text=True).stdout.splitlines()
        path = []
        for line in output[:-1]:
            words = line.split()
            path.append((*map(float, words[1:4]),
                         {name: float(value) for name, value in
                          (word.split('=') for word in words[4:])}))
        return output[-1].split(' ', 1)[1], path

    def require_same(self, where, *action):
        start = {'scenario': where} if where.endswith('.yaml') else {'area': where}
        end, imagined = self.rollout(where, action)
        result, real = self.run_action(action, uncertainty='none', **start)
        outcome = 'succeeded' if result.code == self.system.codes.SUCCEEDED else result.reason
        self.assertEqual(outcome, end, self.system.output())
        states = [real[stamp] for stamp in sorted(real)]
        # One that fails goes on until the robot stands.
        self.assertGreaterEqual(len(states), len(imagined))
        if outcome == 'succeeded':
            self.assertEqual(len(states), len(imagined))
        for state, (x, y, yaw, joints) in zip(states, imagined):
            self.assertLessEqual(abs(state.pose.position.x - x), POSITION)
            self.assertLessEqual(abs(state.pose.position.y - y), POSITION)
            self.assertLessEqual(abs(wrapped(state.yaw - yaw)), ANGLE)
            positions = dict(zip(state.joints.name, state.joints.position))
            self.assertEqual(positions.keys(), joints.keys())
            for name, position in joints.items():
                self.assertLessEqual(abs(wrapped(positions[name] - position)), ANGLE, name)

    def test_driving_is_the_same_as_in_a_rollout(self):
        for action in (('move_base', 'preManipulationAreaEastTable2'),
                       ('move_base_param', 'preManipulationAreaWestTable2', 'slow'),
                       ('move_base_param', 'preManipulationAreaWestTable2', 'fast'),
                       ('move_base_blind', 'home')):
            with self.subTest(action=action):
                self.require_same('nearStartArea1', *action)


if __name__ == '__main__':
    rosunit.unitrun('hires', 'middle_layer_lockstep', MiddleLayerLockstepTest)
