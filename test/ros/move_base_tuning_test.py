#!/usr/bin/env python3
"""Motion sets at the local planner of a move_base, brought there and put back by the guard of the
base, as real processes: planners with names old and new, that clamp, ignore, refuse, hang or are not
there; a guard that is killed; a journal that cannot be read. Run alone, or by
`rostest hires move_base_tuning.test`."""

import itertools
import os
import re
import signal
import sys
import threading
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from failures import text_of  # noqa: E402
from move_base_system import FAST, NOETIC, OLD, PLANNER, SLOW, MoveBaseSystem  # noqa: E402
from ros_processes import Processes, wait_until  # noqa: E402
from test_run import run_test  # noqa: E402

class Robot:
    """All that the guard wants to know of a robot that stands, and somebody who wants to drive it."""

    def __init__(self, rospy):
        from geometry_msgs.msg import PoseWithCovarianceStamped, Twist
        from hires.msg import BaseGuardState, BaseRequest
        from nav_msgs.msg import Odometry
        from sensor_msgs.msg import LaserScan
        from std_msgs.msg import Bool
        from tf2_msgs.msg import TFMessage
        self._rospy, self._request_type = rospy, BaseRequest
        self._odometry_type, self._scan_type = Odometry, LaserScan
        self.state_type = BaseGuardState
        self.states, self.commands = [], []
        self.request = BaseRequest()
        self.is_sending = True
        self._odometry = rospy.Publisher('base_odometry/odom', Odometry, queue_size=10)
        self._tf = rospy.Publisher('/tf', TFMessage, queue_size=10)
        self._scan = rospy.Publisher('base_scan', LaserScan, queue_size=10)
        self._requests = rospy.Publisher('base_guard/request', BaseRequest, queue_size=10)
        self._velocity = rospy.Publisher('base_guard/cmd_vel', Twist, queue_size=10)
        localisation = PoseWithCovarianceStamped()
        localisation.pose.covariance[0] = localisation.pose.covariance[7] = 0.01
        localisation.pose.covariance[35] = 0.001
        self._latched = [rospy.Publisher('amcl_pose', PoseWithCovarianceStamped, latch=True,
                                         queue_size=1),
                         rospy.Publisher('pr2_ethercat/motors_halted', Bool, latch=True,
                                         queue_size=1)]
        self._latched[0].publish(localisation)
        self._latched[1].publish(False)
        rospy.Subscriber('base_guard/state', BaseGuardState, self.states.append, queue_size=1000)
        rospy.Subscriber('navigation/cmd_vel', Twist, self.commands.append, queue_size=1000)
        self.creep = Twist()
        self.creep.linear.x = 0.1
        self._end = threading.Event()
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self):
        while not self._end.wait(0.02):
            stamp = self._rospy.Time.now()
            odometry = self._odometry_type()
            scan = self._scan_type()
            odometry.header.stamp = scan.header.stamp = stamp
            self._odometry.publish(odometry)
            self._scan.publish(scan)
            self._tf.publish([self._transform('map', 'odom_combined', stamp),
                              self._transform('odom_combined', 'base_footprint', stamp)])
            if self.is_sending:
                self.request.header.stamp = stamp
                self._requests.publish(self.request)
                self._velocity.publish(self.creep)

    @staticmethod
    def _transform(parent, child, stamp):
        from geometry_msgs.msg import TransformStamped
        transform = TransformStamped()
        transform.header.frame_id, transform.header.stamp = parent, stamp
        transform.child_frame_id = child
        transform.transform.rotation.w = 1.0
        return transform

    def ask(self, number, name, values):
        request = self._request_type(id=number, set_name=name, max_braking=1.0,
                                     max_braking_jerk=2.5)
        (request.max_linear_velocity, _, request.max_angular_velocity,
         request.max_linear_acceleration, _, request.max_angular_acceleration) = values
        self.request = request

    def is_said(self, state, number, pattern=''):
        return any(s.state == state and s.request == number and re.search(pattern, text_of(s.failure))
                   for s in list(self.states))

    def close(self):
        self._end.set()


class MoveBaseTuningTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.processes = Processes()
        cls.addClassCleanup(cls.processes.stop_all)
        cls.main = cls.processes.master()
        os.environ.update(ROS_MASTER_URI=cls.main.uri, ROS_IP='127.0.0.1')
        os.environ.pop('ROS_HOSTNAME', None)
        import rospy
        cls.rospy = rospy
        rospy.init_node('move_base_tuning_test', disable_signals=True)
        cls.robot = Robot(rospy)
        cls.addClassCleanup(cls.robot.close)
        cls.system = MoveBaseSystem(cls.processes, cls.main, rospy)
        cls.numbers = itertools.count(1)

    def setUp(self):
        self.planner = self.guard = None
        self.journal = os.path.join(self.processes.folder.name, 'journal_%s.yaml' % self.id())
        self.robot.ask(0, '', FAST)
        self.robot.is_sending = True

    def tearDown(self):
        for process in (self.guard, self.planner):
            if process is not None:
                process.signal(signal.SIGCONT)
                process.destroy()

    # What is started.

    def start_planner(self, **parameters):
        self.planner = self.system.start_move_base(**parameters)
        self.system.await_values(FAST, OLD if parameters.get('old_names') else NOETIC)

    def start_guard(self):
        self.robot.states.clear()
        self.robot.commands.clear()
        self.guard = self.system.start_guard(self.journal)
        self.guard_says(self.robot.state_type.STANDING, 0)
        return self.guard

    def begin(self, **planner):
        self.start_planner(**planner)
        self.start_guard()

    # What is seen.

    def guard_says(self, state, number, pattern=''):
        try:
            wait_until(lambda: self.robot.is_said(state, number, pattern), '')
        except AssertionError:
            self.fail('the guard does not say %d, %d, "%s" but %s\n%s' % (
                state, number, pattern, self.robot.states[-3:], self.guard.output()))

    def ask(self, name='slow', values=SLOW):
        number = next(self.numbers)
        self.robot.ask(number, name, values)
        return number

    def require_passing(self, name='slow', values=SLOW):
        number = self.ask(name, values)
        self.guard_says(self.robot.state_type.PASSING, number)
        return number

    def require_refusal(self, pattern):
        """A request that is answered by a stand, with a reason; nothing has moved."""
        number = self.ask()
        self.guard_says(self.robot.state_type.STANDING, number, pattern)
        self.assertFalse(self.robot.is_said(self.robot.state_type.PASSING, number))
        self.assertEqual([c.linear.x for c in self.robot.commands if c.linear.x], [])
        return number

    def has_journal(self):
        return os.path.exists(self.journal)

    # Tests.

    def check_set_comes_and_goes(self, names):
        self.require_passing()
        self.assertEqual(self.system.values(names), SLOW)  # at once: passing comes after
        self.assertTrue(self.has_journal())
        wait_until(lambda: any(c.linear.x for c in self.robot.commands), 'a velocity that passes')
        self.robot.ask(0, '', FAST)
        self.system.await_values(FAST, names)
        wait_until(lambda: not self.has_journal(), 'the journal to go')

    def test_a_set_is_there_before_anything_moves_and_gone_after_the_request(self):
        self.begin()
        self.check_set_comes_and_goes(NOETIC)

    def test_a_planner_from_before_noetic_has_other_names(self):
        self.begin(old_names=True)
        self.check_set_comes_and_goes(OLD)

    def test_the_next_request_brings_its_own_set(self):
        self.begin()
        self.require_passing()
        self.require_passing('crawl', (0.2, 0.2, 0.5, 0.7, 0.7, 1.0))
        self.assertEqual(self.system.values(), (0.2, 0.2, 0.5, 0.7, 0.7, 1.0))
        self.robot.ask(0, '', FAST)
        self.system.await_values(FAST)

    def test_a_sender_that_falls_silent_leaves_nothing_behind(self):
        self.begin()
        number = self.require_passing()
        self.robot.is_sending = False
        self.guard_says(self.robot.state_type.STANDING, number, 'silent')
        self.system.await_values(FAST)
        wait_until(lambda: not self.has_journal(), 'the journal to go')

    def test_a_killed_guard_leaves_a_journal_that_its_successor_goes_by(self):
        self.begin()
        self.require_passing()
        self.guard.kill()
        self.assertEqual(self.system.values(), SLOW)
        self.assertTrue(self.has_journal())
        self.robot.ask(0, '', FAST)
        self.start_guard()
        self.system.await_values(FAST)
        wait_until(lambda: not self.has_journal(), 'the journal to go')

    def test_a_guard_that_is_told_to_end_puts_back_first(self):
        self.begin()
        self.require_passing()
        self.guard.signal(signal.SIGINT)
        self.assertEqual(self.guard.wait(), 0, self.guard.output())
        self.assertEqual(self.system.values(), FAST)
        self.assertFalse(self.has_journal())

    def test_a_planner_that_clamps_lets_nobody_drive(self):
        self.begin(lower={'max_vel_x': 0.4})
        self.require_refusal(r'motion_set_refused: .*max_vel_x is 0\.4, wanted 0\.3')
        self.system.await_values(FAST)
        wait_until(lambda: not self.has_journal(), 'the journal to go')

    def test_a_planner_that_ignores_a_limit_lets_nobody_drive(self):
        self.begin(ignored=['acc_lim_theta'])
        self.require_refusal(r'acc_lim_theta is 3\.2, wanted 2')
        self.system.await_values(FAST)

    def test_a_planner_that_refuses_lets_nobody_drive(self):
        self.begin(refuses=True)
        self.require_refusal('refused')
        self.assertEqual(self.system.values(), FAST)

    def test_without_a_planner_nobody_drives(self):
        self.start_guard()
        self.require_refusal('there is no service ' + PLANNER + '/set_parameters')

    def test_a_planner_that_hangs_lets_nobody_drive_and_has_its_own_values_later(self):
        self.begin()
        self.planner.signal(signal.SIGSTOP)
        self.require_refusal('does not answer')
        self.robot.ask(0, '', FAST)
        self.planner.signal(signal.SIGCONT)
        self.system.await_values(FAST)
        wait_until(lambda: not self.has_journal(), 'the journal to go')
        self.require_passing()

    def test_limits_that_somebody_else_changes_end_the_drive(self):
        from dynamic_reconfigure.client import Client
        self.begin()
        number = self.require_passing()
        client = Client(PLANNER, timeout=30)
        self.addCleanup(client.close)
        client.update_configuration({'max_vel_x': 0.5})
        self.guard_says(self.robot.state_type.STANDING, number,
                        r'another program: max_vel_x is 0\.5, wanted 0\.3')
        self.robot.ask(0, '', FAST)
        self.system.await_values((0.5,) + FAST[1:])  # his wish stays

    def test_a_journal_that_cannot_be_read_forbids_to_drive_and_says_what_to_do(self):
        text = ('server: %s\nmotion_set: slow\nparameters:\n'
                '  acc_lim_x: {original: 2.5, in_force: 1.4}\n  max_vel_x: {orig' % PLANNER)
        with open(self.journal, 'w') as file:
            file.write(text)
        self.begin()
        self.require_refusal(r'journal.* line 5.*acc_lim_x: \{original: 2\.5, .*remove the file')
        self.assertEqual(self.system.values(), FAST)
        with open(self.journal) as file:
            self.assertEqual(file.read(), text)
        os.remove(self.journal)
        self.require_passing()

    def test_a_journal_without_a_place_forbids_to_drive(self):
        self.journal = os.path.join(self.system.guard_config, 'journal.yaml')  # below a file
        self.begin()
        self.require_refusal('cannot be written')
        self.assertEqual(self.system.values(), FAST)


if __name__ == '__main__':
    run_test('move_base_tuning', MoveBaseTuningTest)
