#!/usr/bin/env python3
"""The middle layer without lockstep, as on a real robot: time goes on whatever it does, sensors are
noisy, and some fall silent. Run alone, or by `rostest hires middle_layer_free.test`."""

import math
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from diagnostics import diagnostics  # noqa: E402
from failures import text_of  # noqa: E402
from robot_system import RobotSystem  # noqa: E402
from ros_processes import wait_until  # noqa: E402
from test_run import run_test  # noqa: E402

EAST_TABLE_2 = (11.78, 11.49)
TOLERANCE = 0.2 + 0.08 + 3 * 0.03  # [m] goal tolerance, rolling on, error of the localisation


def speed(state):
    return math.hypot(state.twist.linear.x, state.twist.linear.y)


class Gate:
    """Hands messages on until it is closed."""

    def __init__(self, rospy, topic, kind, onto):
        self.is_open = True
        self._publisher = rospy.Publisher(onto, kind, queue_size=100, tcp_nodelay=True)
        self._subscriber = rospy.Subscriber(topic, kind, self._on_message, queue_size=100,
                                            tcp_nodelay=True)

    def _on_message(self, message):
        if self.is_open:
            self._publisher.publish(message)

    def close(self):
        self._subscriber.unregister()
        self._publisher.unregister()


class MiddleLayerFreeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.system = RobotSystem(pace=1.0, seed=5)
        cls.addClassCleanup(cls.system.stop)
        cls.system.connect('middle_layer_free_test')
        cls.codes = cls.system.codes

    def begin(self, *remaps):
        self.system.start_robot()
        self.system.start_middle_layer(*remaps)
        self.addCleanup(self.system.end_processes)
        self.system.require_server()

    def test_drives_with_noise_at_the_pace_of_time(self):
        self.begin()
        result = self.system.execute('move_base', 'preManipulationAreaEastTable2').result()
        self.assertEqual((result.code, text_of(result.failure)), (self.codes.SUCCEEDED, ''),
                         self.system.output())
        self.system.wait_for_truth(
            lambda s: speed(s) < 0.02 and math.hypot(
                s.pose.position.x - EAST_TABLE_2[0],
                s.pose.position.y - EAST_TABLE_2[1]) < TOLERANCE, 'the robot to arrive')

    def require_stop_when_silent(self, topic, kind):
        gate = Gate(self.system.rospy, topic, kind, topic + '_gated')
        self.addCleanup(gate.close)
        self.begin('%s:=%s_gated' % (topic, topic))
        goal = self.system.execute('move_base', 'preManipulationAreaEastCounter1')
        self.system.wait_during(goal, lambda s: speed(s) > 0.3, 'the robot to be fast')
        gate.is_open = False
        result = goal.result()
        self.assertEqual((result.code, text_of(result.failure).split(':')[0]),
                         (self.codes.FAILED, 'stale_observation'), self.system.output())
        self.system.wait_for_truth(lambda s: speed(s) < 0.02, 'the robot to stand')

    def test_a_robot_without_odometry_stops(self):
        from nav_msgs.msg import Odometry
        self.require_stop_when_silent('base_odometry/odom', Odometry)

    def test_a_robot_that_does_not_feel_its_joints_stops(self):
        from sensor_msgs.msg import JointState
        self.require_stop_when_silent('joint_states', JointState)

    def test_a_robot_that_is_lost_stops(self):
        from tf2_msgs.msg import TFMessage
        self.require_stop_when_silent('/tf', TFMessage)

    def impatient(self):
        """A configuration that does not wait long for what is missing."""
        config = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'config')
        with open(os.path.join(config, 'middle_layer.yaml')) as file:
            text = file.read()
        text = text.replace('scene: scene.yaml', 'scene: ' + os.path.join(config, 'scene.yaml'))
        text = text.replace('start_patience: 5.0', 'start_patience: 0.2')
        return self.system.processes.write('middle_layer.yaml', text)

    def begin_without(self, remap):
        self.system.start_robot()
        self.addCleanup(self.system.end_processes)
        self.system.start_middle_layer(remap, config=self.impatient())
        self.system.require_server()

    def test_without_sensors_an_action_fails(self):
        self.begin_without('base_odometry/odom:=nowhere')
        diagnostics(self.system.rospy, 'middle_layer', lambda v: v['controller without a listener'] == '')
        result = self.system.execute('move_torso', 'torsoUpPosture').result()
        self.assertEqual((result.code, text_of(result.failure).split(':')[0]),
                         (self.codes.FAILED, 'stale_observation'))
        self.assertIn('base_odometry/odom', text_of(result.failure))

    def test_without_controllers_an_action_fails_with_their_topic(self):
        self.begin_without('navigation/cmd_vel:=nobody/command')
        result = self.system.execute('move_base', 'home').result()
        self.assertEqual((result.code, text_of(result.failure)),
                         (self.codes.FAILED, 'no_controller: /nobody/command'))

    def test_a_missing_sensor_is_in_the_diagnostics(self):
        from diagnostic_msgs.msg import DiagnosticArray
        seen = []
        subscriber = self.system.rospy.Subscriber('/diagnostics', DiagnosticArray, seen.append)
        self.addCleanup(subscriber.unregister)
        self.begin('joint_states:=nowhere')
        wait_until(lambda: any('joint_states' in status.message for array in list(seen)
                               for status in array.status), 'the warning')


if __name__ == '__main__':
    run_test('middle_layer_free', MiddleLayerFreeTest)
