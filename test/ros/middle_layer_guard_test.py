#!/usr/bin/env python3
"""The middle layer with a guard between it and the base, with halted motors, with a joystick, and in
a dry run. Time goes on whatever it does. The guard is the test's own: it hands velocities on, stops
them when it is told to, and remembers what it was asked. Run alone, or by
`rostest hires middle_layer_guard.test`."""

import math
import os
import sys
import threading
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from failures import failure, text_of  # noqa: E402
from robot_system import RobotSystem  # noqa: E402
from ros_processes import wait_until  # noqa: E402
from test_run import run_test  # noqa: E402

CONTROLLERS = ('navigation/cmd_vel', 'base_controller/command', 'base_guard/cmd_vel',
               'l_arm_controller/command', 'r_arm_controller/command', 'torso_controller/command',
               'head_traj_controller/command', 'l_gripper_controller/command',
               'r_gripper_controller/command')
CONFIG = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..',
                                       'config'))
FAR = 'preManipulationAreaEastCounter1'


def speed(state):
    return math.hypot(state.twist.linear.x, state.twist.linear.y)


class Guard:
    """Between the middle layer and the simulated base."""

    def __init__(self, system):
        from geometry_msgs.msg import Twist
        self._system, self._twist = system, Twist
        self._lock = threading.Lock()
        self.requests, self.commands = [], []
        self.instead = None  # velocities that somebody with a joystick sends
        self.is_passing = True
        rospy, msg = system.rospy, system.msg
        self._base = rospy.Publisher('base_controller/command', Twist, queue_size=10)
        self._state = rospy.Publisher('base_guard/state', msg.BaseGuardState, queue_size=10,
                                      latch=True)
        self._subscribers = [
            rospy.Subscriber('base_guard/request', msg.BaseRequest, self._on_request,
                             queue_size=100),
            rospy.Subscriber('base_guard/cmd_vel', Twist, self._on_command, queue_size=100,
                             tcp_nodelay=True)]

    def _on_request(self, request):
        with self._lock:
            self.requests.append(request)

    def _on_command(self, command):
        with self._lock:
            self.commands.append(command)
            if self.is_passing:
                self._base.publish(self.instead or command)

    def joystick(self, vx):
        self.instead = self._twist()
        self.instead.linear.x = vx

    def ids(self):
        """Of requests to drive, each once, in order."""
        with self._lock:
            return list(dict.fromkeys(request.id for request in self.requests if request.id))

    def last(self):
        with self._lock:
            return self.requests[-1]

    def say(self, state, request, reason=''):
        self.is_passing = state == self._system.msg.BaseGuardState.PASSING
        self._state.publish(state=state, request=request, failure=failure(reason))

    def stop(self, reason):
        """The base, for whoever asked last."""
        self.say(self._system.msg.BaseGuardState.BRAKING, self.ids()[-1], reason)

    def close(self):
        for endpoint in (*self._subscribers, self._base, self._state):
            endpoint.unregister()


class MiddleLayerGuardTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.system = RobotSystem(pace=1.0, seed=5, uncertainty='none')
        cls.addClassCleanup(cls.system.stop)
        cls.system.connect('middle_layer_guard_test')
        cls.codes = cls.system.codes

    def begin(self, with_guard=True, **middle_layer):
        if with_guard:
            self.guard = Guard(self.system)
            self.addCleanup(self.guard.close)
        self.system.start_robot()
        self.addCleanup(self.system.end_processes)
        self.start_middle_layer(**middle_layer)

    def start_middle_layer(self, **arguments):
        arguments.setdefault('guard', True)
        self.system.start_middle_layer(**arguments)
        self.system.require_server()

    def impatient(self):
        """A configuration that does not wait long for what is missing."""
        with open(os.path.join(CONFIG, 'middle_layer.yaml')) as file:
            text = file.read()
        for name in ('scene: ', 'config: '):
            text = text.replace(name, name + CONFIG + '/')
        return self.system.processes.write(
            'middle_layer.yaml', text.replace('start_patience: 5.0', 'start_patience: 0.2'))

    def require(self, goal, code, reason=''):
        result = goal.result()
        self.assertEqual((result.code, text_of(result.failure)), (code, reason), self.system.output())

    def drive(self):
        """On the way, and fast."""
        goal = self.system.execute('move_base', FAR)
        self.system.wait_during(goal, lambda s: speed(s) > 0.3, 'the robot to be fast')
        return goal

    def require_stand(self):
        self.system.wait_for_truth(lambda s: speed(s) < 0.02, 'the robot to stand')

    # Leave to drive.

    def test_leave_is_asked_for_with_the_limits_of_the_set(self):
        self.begin()
        goal = self.system.execute('move_base_param', 'preManipulationAreaEastTable2', 'slow')
        self.require(goal, self.codes.SUCCEEDED)
        wait_until(lambda: self.guard.last().id == 0, 'the end of the request')
        self.assertEqual(len(self.guard.ids()), 1)
        asked = [request for request in self.guard.requests if request.id]
        self.assertEqual({request.set_name for request in asked}, {'slow'})
        last = asked[-1]
        self.assertEqual((last.max_linear_velocity, last.max_angular_velocity,
                          last.max_linear_acceleration, last.max_angular_acceleration),
                         (0.30, 1.0, 1.4, 2.0))
        self.assertGreater(last.max_braking, 0.0)
        self.assertGreater(last.max_braking_jerk, 0.0)
        self.assertFalse(last.header.stamp.is_zero())
        self.assertGreater(len(self.guard.commands), 0)
        self.assertLessEqual(max(abs(c.linear.x) for c in self.guard.commands), 0.30 + 1e-9)

    def test_arms_ask_for_no_leave(self):
        self.begin()
        self.require(self.system.execute('move_torso', 'torsoMiddlePosture'), self.codes.SUCCEEDED)
        self.assertEqual(self.guard.requests, [])

    def test_each_goal_asks_with_a_new_id_also_after_a_sudden_end(self):
        self.begin()
        for _ in range(2):
            goal = self.drive().cancel()
            self.assertEqual(goal.result().code, self.codes.PREEMPTED)
            self.require_stand()
        self.drive()
        self.system.middle_layer.kill()
        asked = len(self.guard.requests)
        self.require_stand()
        self.assertLessEqual(len(self.guard.requests), asked + 1, 'the dead ask for nothing')
        self.start_middle_layer()
        self.drive()
        ids = self.guard.ids()
        self.assertEqual(len(ids), 4)
        self.assertEqual(ids, sorted(ids))

    # What the guard says.

    def test_a_stop_by_the_guard_ends_everything_that_runs(self):
        self.begin()
        torso = self.system.execute('move_torso', 'torsoMiddlePosture').wait_for_active()
        drive = self.drive()
        self.guard.stop('stale_scan: 0.41 s')
        for goal in (drive, torso):
            self.require(goal, self.codes.FAILED, 'stale_scan: 0.41 s')
        self.require_stand()
        # Nothing is lost for good: the next goal has leave of its own.
        self.guard.say(self.system.msg.BaseGuardState.PASSING, 0)
        self.drive()
        self.assertEqual(len(self.guard.ids()), 2)

    def test_what_the_guard_says_to_others_is_not_meant_for_us(self):
        self.begin()
        goal = self.drive()
        state = self.system.msg.BaseGuardState
        self.guard.say(state.PASSING, self.guard.ids()[-1])
        self.guard._state.publish(state=state.STANDING, request=self.guard.ids()[-1] - 1,
                                  failure=failure('motors_halted'))
        self.guard._state.publish(state=state.STANDING, request=0, failure=failure('no_request'))
        goal.cancel()
        self.assertEqual(goal.result().code, self.codes.PREEMPTED)

    def test_without_a_guard_nothing_drives(self):
        self.begin(with_guard=False, config=self.impatient())
        self.require(self.system.execute('move_base', FAR), self.codes.FAILED,
                     'no_controller: /base_guard/cmd_vel')

    def test_a_guard_that_goes_away_ends_the_drive(self):
        self.begin()
        goal = self.drive()
        self.guard.close()
        self.require(goal, self.codes.FAILED, 'no_controller: /base_guard/cmd_vel')
        self.require_stand()

    # Motors and joystick.

    def test_halted_motors_end_everything_and_let_nothing_begin(self):
        from std_msgs.msg import Bool
        self.begin()
        halted = self.system.rospy.Publisher('pr2_ethercat/motors_halted', Bool, queue_size=1,
                                             latch=True)
        self.addCleanup(halted.unregister)
        halted.publish(False)
        torso = self.system.execute('move_torso', 'torsoMiddlePosture').wait_for_active()
        drive = self.drive()
        halted.publish(True)
        for goal in (drive, torso):
            self.require(goal, self.codes.FAILED, 'motors_halted')
        self.require(self.system.execute('move_torso', 'torsoUpPosture'), self.codes.FAILED,
                     'motors_halted')
        halted.publish(False)
        wait_until(lambda: self.system.execute('move_torso', 'torsoMiddlePosture').result().code ==
                   self.codes.SUCCEEDED, 'the torso to move again')

    def test_a_drive_that_somebody_overrides_says_so_and_goes_on(self):
        self.begin()
        goal = self.drive()
        self.guard.joystick(-0.2)
        goal.wait_for_feedback(lambda f: f.phase == 'overridden', 'word of the joystick')
        self.guard.instead = None
        self.require(goal, self.codes.SUCCEEDED)

    # Names.

    def test_another_robots_names_are_used(self):
        self.start_with_names('l_arm_controller/command', 'left/command')
        self.system.require_server()
        publishers = self.system.main.publishers()
        self.assertIn('/middle_layer', publishers.get('/left/command', []))
        self.assertNotIn('/middle_layer', publishers.get('/l_arm_controller/command', []))

    def test_bad_names_stop_the_node_with_file_and_line(self):
        node = self.start_with_names('base_scan: base_scan', 'base_scan: /scan')
        self.assertEqual(node.wait(), 1)
        self.assertRegex(node.output(), "names.yaml: base_scan is '/scan', .*relative.*; line 1[0-9]")

    def start_with_names(self, word, by):
        with open(os.path.join(CONFIG, 'robots', 'pr2_names.yaml')) as file:
            text = file.read()
        self.assertIn(word, text)
        self.system.start_robot()
        self.addCleanup(self.system.end_processes)
        return self.system.start_middle_layer(
            names=self.system.processes.write('names.yaml', text.replace(word, by)))

    # Dry run.

    def test_in_a_dry_run_no_controller_can_be_told_anything(self):
        for guard in (False, True):
            self.begin(dry_run=True, guard=guard)
            for action in (('move_base', FAR), ('tuck_arms', 'armTuckedPosture', 'armTuckedPosture'),
                           ('move_torso', 'torsoUpPosture')):
                self.require(self.system.execute(*action), self.codes.FAILED, 'dry_run')
            publishers = self.system.main.publishers()
            for topic in CONTROLLERS:
                self.assertNotIn('/middle_layer', publishers.get('/' + topic, []), topic)
            self.assertEqual(self.guard.requests, [])
            self.assertEqual(self.guard.commands, [])
            self.doCleanups()


if __name__ == '__main__':
    run_test('middle_layer_guard', MiddleLayerGuardTest)
