#!/usr/bin/env python3
"""The guard of the base as a real process, between a driver, a base and sensors that are real
processes too: they fall silent, are killed, are suspended. Run alone, or by
`rostest hires base_guard.test`."""

import os
import signal
import sys
import unittest

import rospy
import yaml
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseWithCovarianceStamped, Twist
from hires.msg import BaseGuardState
from nav_msgs.msg import Odometry
from std_msgs.msg import Bool

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from diagnostics import wait_for_guard  # noqa: E402
from failures import text_of  # noqa: E402
from ros_processes import Processes, executable, wait_until  # noqa: E402
from test_run import long_case, run_test  # noqa: E402

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..')
CONFIG = os.path.join(ROOT, 'config', 'base_guard.yaml')
# What a busy computer may hold up is waited for longer here; test/navigation tests the times.
PATIENCE = {'pose_patience': 1.0, 'scan_patience': 1.0, 'request_patience': 0.6,
            'command_patience': 1.0, 'update_patience': 2.0}
FULL_SPEED = 0.4  # [m/s] of the requester; the commander asks for more


class BaseGuardTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.outer = Processes()
        cls.addClassCleanup(cls.outer.stop_all)
        cls.master = cls.outer.master()
        os.environ['ROS_MASTER_URI'] = cls.master.uri
        rospy.init_node('base_guard_test', disable_signals=True)
        cls.motors = rospy.Publisher('pr2_ethercat/motors_halted', Bool, queue_size=1, latch=True)
        cls.pose = rospy.Publisher('amcl_pose', PoseWithCovarianceStamped, queue_size=1, latch=True)
        cls.commands, cls.states, cls.diagnostics = [], [], []
        cls.odometry = Odometry()
        rospy.Subscriber('navigation/cmd_vel', Twist, cls.commands.append)
        rospy.Subscriber('base_guard/state', BaseGuardState, cls.states.append)
        rospy.Subscriber('base_odometry/odom', Odometry,
                         lambda msg: setattr(cls, 'odometry', msg))
        rospy.Subscriber('/diagnostics', DiagnosticArray,
                         lambda msg: cls.diagnostics.extend(msg.status))

    def setUp(self):
        self.processes = Processes()
        self.addCleanup(self.processes.stop_all)
        for log in (self.commands, self.states, self.diagnostics):
            log.clear()
        type(self).odometry = Odometry()
        self.localise(0.05)
        self.motors.publish(False)
        self.guard = self.start_guard()
        self.robot = self.peer('robot')
        self.localiser = self.peer('localiser')
        self.scanner = self.peer('scanner')

    def start_guard(self, *arguments):
        with open(CONFIG) as file:
            config = yaml.safe_load(file)
        config.update(PATIENCE)
        path = self.processes.write('base_guard.yaml', yaml.safe_dump(config))
        return self.processes.start(
            [executable('base_guard'), '_config:=' + path, '_diagnostic_period:=0.1', *arguments],
            self.master)

    def peer(self, *arguments):
        return self.processes.start([executable('base_guard_peer'), *arguments], self.master)

    def localise(self, deviation):
        pose = PoseWithCovarianceStamped()
        pose.header.frame_id = 'map'
        pose.header.stamp = rospy.Time.now()
        pose.pose.covariance[0] = pose.pose.covariance[7] = deviation ** 2
        pose.pose.covariance[35] = 0.05 ** 2
        self.pose.publish(pose)

    def drive(self, request=1):
        """A driver that wants 0.6 m/s, and the base at the speed that its request allows."""
        wait_for_guard(rospy)
        self.requester = self.peer('requester', str(request))
        self.commander = self.peer('commander', '0.6', '0.0')
        self.wait_for_state(BaseGuardState.PASSING, request=request)
        self.wait_for_speed(FULL_SPEED)

    def wait_for_speed(self, speed):
        wait_until(lambda: abs(self.odometry.twist.twist.linear.x - speed) < 0.01,
                   lambda: '%g m/s; the guard said:\n%s' % (speed, self.guard.output()))

    def wait_for_state(self, state, reason='', request=1):
        def reached():
            now = self.states[-1] if self.states else None
            return now if now and (now.state, now.request) == (state, request) else None
        now = wait_until(reached, lambda: 'state %d of request %d; states:\n%s\nthe guard said:\n%s' % (
            state, request, self.states, self.guard.output()))
        self.assertTrue(text_of(now.failure).startswith(reason), text_of(now.failure))
        return now

    def require_gentle_stop(self, reason, request=1):
        """It braked along a ramp, stands, and nothing makes it move."""
        self.wait_for_state(BaseGuardState.STANDING, reason, request)
        own = [state.state for state in self.states if state.request == request]
        self.assertEqual(own[own.index(BaseGuardState.PASSING):],
                         [BaseGuardState.PASSING, BaseGuardState.BRAKING, BaseGuardState.STANDING])
        self.wait_for_speed(0.0)
        self.wait_for_zero_command()
        speeds = [command.linear.x for command in self.commands]
        last = len(speeds) - 1 - speeds[::-1].index(max(speeds))
        ramp = speeds[last:]
        self.assertEqual(ramp, sorted(ramp, reverse=True))  # slower and slower
        self.assertEqual(ramp[-1], 0.0)
        self.assertGreater(len(set(ramp)), 5, ramp)  # in steps, not at once
        self.assertLessEqual(max(speeds), FULL_SPEED + 1e-9)

    def wait_for_zero_command(self):
        """Commands and states are different topics: the last step of a ramp may come behind the
        state in which the guard has sent its first zero."""
        wait_until(lambda: self.commands and self.commands[-1].linear.x == 0.0, 'the zero')

    def require_nothing_moves(self):
        """Whatever the driver, who still is there, says. Zeros end after a second."""
        self.wait_for_zero_command()
        seen = len(self.commands)
        start = self.odometry.header.stamp
        wait_until(lambda: (self.odometry.header.stamp - start).to_sec() > 1.5, 'odometry')
        moving = [command for command in self.commands[seen:] if command.linear.x != 0.0]
        self.assertEqual(moving, [])
        self.assertEqual(self.states[-1].state, BaseGuardState.STANDING)

    # What passes.

    def test_velocities_pass_within_the_limits_and_only_with_leave(self):
        self.commander = self.peer('commander', '0.6', '0.0')
        wait_until(lambda: self.odometry.header.stamp > rospy.Time(0), 'odometry')
        state = self.wait_for_state(BaseGuardState.STANDING, 'no_request', request=0)
        self.assertEqual(self.commands, [])
        self.requester = self.peer('requester', '1')
        self.wait_for_state(BaseGuardState.PASSING)
        self.wait_for_speed(FULL_SPEED)
        self.assertEqual(max(command.linear.x for command in self.commands), FULL_SPEED)
        self.assertEqual(text_of(state.failure), 'no_request')

    # What ends in a stop.

    def test_halted_motors(self):
        self.drive()
        self.motors.publish(True)
        self.require_gentle_stop('motors_halted')
        self.require_nothing_moves()
        self.motors.publish(False)
        self.require_nothing_moves()

    def test_a_killed_middle_layer(self):
        self.drive()
        self.commander.kill()
        self.requester.kill()
        self.require_gentle_stop('silent_middle_layer')

    @long_case
    def test_a_suspended_middle_layer(self):
        self.drive()
        self.requester.signal(signal.SIGSTOP)
        self.require_gentle_stop('silent_middle_layer')
        self.requester.signal(signal.SIGCONT)
        self.require_nothing_moves()

    def test_velocities_that_stop_coming(self):
        self.drive()
        self.commander.signal(signal.SIGSTOP)
        self.require_gentle_stop('silent_commands')
        self.commander.signal(signal.SIGCONT)
        self.require_nothing_moves()

    @long_case
    def test_a_localiser_that_hangs(self):
        self.drive()
        self.localiser.signal(signal.SIGSTOP)
        self.require_gentle_stop('stale_pose')
        self.assertIn('map_transform', text_of(self.states[-1].failure))
        self.localiser.signal(signal.SIGCONT)
        self.require_nothing_moves()

    def test_a_dead_laser(self):
        self.drive()
        self.scanner.kill()
        self.require_gentle_stop('stale_scan')

    @long_case
    def test_lost_localisation(self):
        self.drive()
        self.localise(0.62)
        self.require_gentle_stop('localisation_lost: sd 0.62 m')
        self.localise(0.05)
        self.require_nothing_moves()

    @long_case
    def test_odometry_that_stops_coming(self):
        self.drive()
        self.robot.signal(signal.SIGSTOP)
        self.wait_for_state(BaseGuardState.STANDING, 'stale_pose')
        self.robot.signal(signal.SIGCONT)
        self.wait_for_speed(0.0)
        self.require_nothing_moves()

    # And afterwards.

    @long_case
    def test_a_new_request_drives_again(self):
        self.drive()
        self.requester.kill()
        self.require_gentle_stop('silent_middle_layer')
        self.requester = self.peer('requester', '2')
        self.wait_for_state(BaseGuardState.PASSING, request=2)
        self.wait_for_speed(FULL_SPEED)

    @long_case
    def test_a_new_request_waits_for_motors(self):
        self.drive()
        self.motors.publish(True)
        self.require_gentle_stop('motors_halted')
        self.requester.kill()
        self.requester = self.peer('requester', '2')
        self.wait_for_state(BaseGuardState.STANDING, 'motors_halted', request=2)
        self.require_nothing_moves()
        self.motors.publish(False)
        self.wait_for_state(BaseGuardState.PASSING, request=2)
        self.wait_for_speed(FULL_SPEED)

    def test_the_guard_brings_the_base_to_a_stand_before_it_ends(self):
        self.drive()
        self.guard.signal(signal.SIGTERM)
        self.require_gentle_stop('guard_ends')
        self.assertEqual(self.guard.wait(), 0)

    def test_a_guard_that_is_killed_and_started_again_remembers_no_velocity(self):
        self.drive()
        self.guard.kill()
        self.commander.signal(signal.SIGSTOP)
        self.wait_for_speed(0.0)  # by the base's own time-out
        self.states.clear()
        self.commands.clear()
        self.guard = self.start_guard()
        self.wait_for_state(BaseGuardState.PASSING)  # the request lives, and nobody stopped it
        self.assertEqual(self.commands, [])  # but what was commanded is forgotten
        self.commander.signal(signal.SIGCONT)
        self.wait_for_speed(FULL_SPEED)

    def test_it_says_how_it_is(self):
        self.drive()
        def found(level, text):
            return [status for status in self.diagnostics
                    if status.level == level and text in status.message]
        wait_until(lambda: found(0, 'passing'), 'a diagnosis of passing')
        self.motors.publish(True)
        wait_until(lambda: found(1, 'standing: motors_halted'), 'a diagnosis of standing')

    def test_odometry_of_a_part_that_tf_does_not_know_is_said_once(self):
        self.drive()  # tf knows the base
        self.robot.kill()
        odometry = rospy.Publisher('base_odometry/odom', Odometry, queue_size=1)

        def is_told():
            msg = Odometry(child_frame_id='/measuring_wheel')
            msg.header.stamp = rospy.Time.now()
            odometry.publish(msg)
            return [status for status in self.diagnostics
                    if status.level == 1 and 'unknown frame measuring_wheel' in status.message]
        wait_until(is_told, lambda: 'a diagnosis; the guard said:\n' + self.guard.output())
        self.diagnostics.clear()
        wait_until(is_told, 'another diagnosis, after more of the same odometry')
        text = "child_frame_id is 'measuring_wheel', which tf does not connect with base_footprint"
        self.assertEqual(self.guard.output().count(text), 1, self.guard.output())

    # What it refuses.

    def require_refusal(self, *texts, **arguments):
        guard = self.processes.start(  # parameters of a name stay with the master
            [executable('base_guard'), '__name:=refused_for_' + '_'.join(arguments),
             *('_%s:=%s' % item for item in arguments.items())], self.master)
        self.assertEqual(guard.wait(), 1)
        for text in texts:
            self.assertIn(text, guard.output())

    def test_bad_parameters_stop_it_with_a_message(self):
        bad = self.processes.write('bad.yaml', 'pose_patience: 0.3\nscan_patiense: 0.3\n')
        self.require_refusal('scan_patience', 'bad.yaml', config=bad)
        self.require_refusal('navigation', "'sideways'", 'move_base', navigation='sideways')
        self.require_refusal('/nowhere.yaml', names='/nowhere.yaml')
        self.require_refusal('confg', confg='x')


if __name__ == '__main__':
    run_test('base_guard', BaseGuardTest)
