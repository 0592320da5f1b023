#!/usr/bin/env python3
"""The Python module hires against a running imagination, and the examples that drive by it: run alone, or
by `rostest hires ask_before_driving.test`."""

import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from imagination_system import ImaginationSystem  # noqa: E402
from move_base_system import ROOT, MoveBaseSystem  # noqa: E402
from ros_processes import LIMIT, executable, wait_until  # noqa: E402
from test_run import run_test  # noqa: E402

EXAMPLE = os.path.join(ROOT, 'examples', 'ask_before_driving.py')
HOME, AREA = 'preManipulationAreaEastCounter1', 'preManipulationAreaNorthTable1'
SLOW, FAST = 0.30, 0.55  # [m/s] max_vel_x


class AskBeforeDrivingTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.system = ImaginationSystem(workers=1)
        cls.addClassCleanup(cls.system.destroy)
        cls.system.start()
        os.environ.update(ROS_MASTER_URI=cls.system.main.uri, ROS_IP='127.0.0.1',
                          ROS_LOG_DIR=cls.system.processes.folder.name)
        os.environ.pop('ROS_HOSTNAME', None)
        import hires
        import rospy
        cls.hires = hires
        rospy.init_node('ask_before_driving_test', disable_signals=True)
        cls.navigation = MoveBaseSystem(cls.system.processes, cls.system.main, rospy)
        # Who waits for it uses rospy's simple client, which misses an answer that comes at once.
        cls.navigation.start_move_base(duration=0.5)

    def run_example(self, *more):
        process = self.system.run([sys.executable, EXAMPLE, AREA, '7.0', '12.2', '-1.57', '--from',
                                   HOME, '--planner', 'move_base_node/DWAPlannerROS', *more])
        return process.wait(3 * LIMIT), process.output()

    def run_cpp_example(self, *more):
        process = self.system.run([executable('ask_before_driving'), AREA, '7.0', '12.2', '-1.57', HOME, *more,
                                   '_planner:=move_base_node/DWAPlannerROS'])
        return process.wait(3 * LIMIT), process.output()

    def await_max_vel_x(self, wanted, output):
        def is_so():
            values = self.navigation.values()
            return values is not None and values[0] == wanted
        wait_until(is_so, lambda: 'max_vel_x %s, it is %s; %s' % (
            wanted, self.navigation.values(), output))

    def test_the_example_drives_as_imagination_recommends(self):
        code, output = self.run_example('--object', 'race_flowers1')
        self.assertEqual(code, 0, output)
        self.assertIn('slow): 9', output)
        self.await_max_vel_x(SLOW, output)
        code, output = self.run_example()  # nothing can fall: the faster one is as good, and faster
        self.assertEqual(code, 0, output)
        self.await_max_vel_x(FAST, output)

    def test_the_example_in_cpp_does_the_same(self):
        code, output = self.run_cpp_example('race_flowers1')
        self.assertEqual(code, 0, output)
        self.assertIn('slow): 6', output)
        self.await_max_vel_x(SLOW, output)
        code, output = self.run_cpp_example('nothing_known')
        self.assertEqual(code, 2, output)
        self.assertIn('nothing_known', output)

    def test_the_answer_is_that_of_the_command_line(self):
        from imagination_system import ACTION
        told = self.system.ask('--min-success', '0.5', rollouts=16, early_stop=True).answer().report
        imagination = self.hires.Imagination()
        answer = imagination.ask(
            'move_base_blind', ACTION[-1].split(','), robot_at=HOME, on_tray='peppermill1',
            rollouts=16, seed=7)
        self.assertEqual(answer.outcome, told['outcome'])
        self.assertEqual(answer.why, told['why'])
        self.assertEqual([(a.success, a.rollouts, a.interval[0]) for a in answer.ranking],
                         [(p['success']['share'], p['rollouts'], p['success']['lower'])
                          for p in told['ranking']])
        saved = imagination.save_rollout('median')
        self.assertTrue(os.path.exists(saved.path), saved)
        self.assertEqual(saved.seed, 7)
        self.assertLess(saved.index, 16)
        self.assertIn('goal reached', [text for _, text in saved.events])
        with self.assertRaisesRegex(self.hires.ImaginationError, "'wurst'.*first_fall"):
            imagination.save_rollout('wurst')

    def test_bad_requests_say_what_is_wrong(self):
        imagination = self.hires.Imagination()
        with self.assertRaisesRegex(ValueError, "'RobotAt home' is no fact"):
            imagination.ask('move_base', AREA, facts=['RobotAt home'])
        for wrong, what in (({'robot_at': (0.8, 0.8)}, 'robot_at is .*0.8'), ({'rollouts': '4'}, 'rollouts'),
                            ({'seed': 2**64}, 'seed is'), ({'deadline': float('nan')}, 'deadline is nan'),
                            ({'min_success': None}, 'min_success'), ({'on_tray': [7]}, 'on_tray is 7'),
                            ({'uncertainty': {}}, 'uncertainty'), ({'facts': 3}, 'facts'),
                            ({'ranking': '\udc80'}, 'udc80')):
            with self.assertRaisesRegex((TypeError, ValueError), what):
                imagination.ask('move_base', AREA, **wrong)
        with self.assertRaisesRegex(TypeError, 'argument 1 is 7'):
            imagination.ask('move_base', 7, robot_at=HOME)
        # None of them got onto the way to the client, which the next one takes.
        with self.assertRaisesRegex(self.hires.ImaginationError, 'nowhere'):
            imagination.ask('move_base', 'nowhere', robot_at=HOME)
        with self.assertRaisesRegex(self.hires.ImaginationError, "'/elsewhere'.*imagination.launch"):
            self.hires.Imagination('elsewhere', wait=0.2).ask('move_base', AREA, robot_at=HOME)
        with self.assertRaisesRegex(self.hires.ImaginationError, '/some/where/imagined_rollout'):
            self.hires.Imagination('/some/where/imagine').save_rollout()


if __name__ == '__main__':
    run_test('ask_before_driving', AskBeforeDrivingTest)
