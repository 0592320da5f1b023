#!/usr/bin/env python3
"""The node that joins wheel odometry and an inertial unit, as a real process: a robot whose wheels turn too
far, with a unit that is turned, upside down or silent; and readings that are wrong, late or of another clock.
Run alone, or by `rostest hires odometry_filter.test`."""

import math
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from diagnostics import diagnostics  # noqa: E402
from pr2_frames import quaternion, rotation  # noqa: E402
from ros_processes import Processes, executable, wait_until  # noqa: E402
from scanned_room import BASE, Robot, odometry_message, wrapped, yaw_of  # noqa: E402
from test_run import long_case, run_test  # noqa: E402

PERIOD = 0.02   # [s] of wheels and unit
UNIT, UPSIDE_DOWN = 'imu_link', 'imu_upside_down'
Z, MOUNTED = (0, 0, 1), {UNIT: rotation((0, 0, 1), 0.5), UPSIDE_DOWN: rotation((1, 0, 0), math.pi)}
NAN = float('nan')


class Node:
    """One process with what it says."""
    count = 0

    def __init__(self, test, *arguments):
        from geometry_msgs.msg import PoseWithCovarianceStamped
        from tf2_msgs.msg import TFMessage
        Node.count += 1
        self.space = '/n%d' % Node.count
        self.name = self.space + '/odometry_filter'
        self.poses, self.transforms = {}, {}
        listeners = [
            test.rospy.Subscriber(self.space + '/robot_pose_ekf/odom_combined', PoseWithCovarianceStamped,
                                  lambda m: self.poses.update({m.header.stamp.to_nsec(): m}), queue_size=1000),
            test.rospy.Subscriber('/tf', TFMessage, self._take, queue_size=1000)]
        self.process = test.processes.start(
            [executable('odometry_filter'), '__ns:=' + self.space, 'odom:=/odom', 'imu_data:=/imu_data'] +
            list(arguments), test.main)
        test.addCleanup(self.process.destroy)
        for listener in listeners:
            test.addCleanup(listener.unregister)
        for publisher in (test.wheels, test.units, test.fixed):
            wait_until(lambda: any(c.endpoint_id == self.name for c in publisher.impl.connections),
                       lambda: '%s to listen to %s\n%s' % (self.name, publisher.name, self.process.output()))
        wait_until(lambda: all(any(c.callerid_pub == self.name for c in listener.impl.connections)
                               for listener in listeners),
                   lambda: '%s to be heard\n%s' % (self.name, self.process.output()))

    def _take(self, message):
        if message._connection_header['callerid'] == self.name:
            self.transforms.update({t.header.stamp.to_nsec(): t for t in message.transforms})


class OdometryFilterTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.processes = Processes()
        cls.addClassCleanup(cls.processes.stop_all)
        cls.main = cls.processes.master()
        os.environ.update(ROS_MASTER_URI=cls.main.uri, ROS_IP='127.0.0.1')
        os.environ.pop('ROS_HOSTNAME', None)
        import rospy
        from geometry_msgs.msg import TransformStamped
        from nav_msgs.msg import Odometry
        from sensor_msgs.msg import Imu
        from tf2_msgs.msg import TFMessage
        cls.rospy = rospy
        rospy.init_node('odometry_filter_test', disable_signals=True)
        cls.wheels = rospy.Publisher('/odom', Odometry, queue_size=1000)
        cls.units = rospy.Publisher('/imu_data', Imu, queue_size=1000)
        cls.fixed = rospy.Publisher('/tf_static', TFMessage, queue_size=10, latch=True)
        mounts = TFMessage()
        for frame, R_BI in MOUNTED.items():
            mount = TransformStamped(child_frame_id=frame)
            mount.header.frame_id = BASE
            q = mount.transform.rotation
            q.x, q.y, q.z, q.w = quaternion(R_BI)
            mounts.transforms.append(mount)
        cls.fixed.publish(mounts)

    def setUp(self):
        self.now = 1000.0
        self.robot = Robot()
        self.robot.pose = (0.0, 0.0, 0.0)

    def odometry(self):
        return odometry_message(self.robot.odometry, self.now)

    def inertia(self, frame=UNIT):
        """Its zero is anywhere."""
        from sensor_msgs.msg import Imu
        message = Imu()
        message.header.stamp = self.rospy.Time.from_sec(self.now)
        message.header.frame_id = frame
        R_WI = rotation(Z, self.robot.pose[2] + 2.0) @ MOUNTED[frame]
        q = message.orientation
        q.x, q.y, q.z, q.w = quaternion(R_WI)
        return message

    def step(self, *nodes, frame=UNIT, with_unit=True):
        """Both say where they are; until the nodes have, too."""
        self.now = round(self.now + PERIOD, 3)
        wheels = self.odometry()
        if with_unit:
            self.units.publish(self.inertia(frame))
        self.wheels.publish(wheels)
        stamp = wheels.header.stamp.to_nsec()
        wait_until(lambda: all(stamp in node.poses and stamp in node.transforms for node in nodes),
                   lambda: 'an answer\n' + '\n'.join(node.process.output() for node in nodes))

    def drive(self, count, *nodes, **how):
        """Turns on the spot and drives by turns, 0.4 m/s and 0.5 rad/s; what each node says last."""
        for i in range(count):
            turns = i // 50 % 2 == 0
            self.robot.move(0.0 if turns else 0.008, 0.01 if turns else 0.0)
            self.step(*nodes, **how)
        return [self.said(node) for node in nodes]

    @staticmethod
    def said(node):
        pose = node.poses[max(node.poses)].pose.pose
        return (pose.position.x, pose.position.y, yaw_of(pose.orientation))

    def errors(self, pose):
        return (math.dist(pose[:2], self.robot.pose[:2]), abs(wrapped(pose[2] - self.robot.pose[2])))

    def say(self, node, condition):
        return diagnostics(self.rospy, node.name[1:], condition)

    # What it does.

    def test_the_unit_corrects_how_far_the_wheels_turn(self):
        node = Node(self)
        self.step(node)
        far, turned = self.errors(self.drive(600, node)[0])
        wheels = self.errors(self.robot.odometry)
        print('%.3f m, %.4f rad; wheels alone %.3f m, %.4f rad' % (far, turned, *wheels))
        self.assertGreater(wheels[1], 0.1)
        self.assertLess(turned, 0.01)
        self.assertLess(far, 0.1)
        self.assertEqual(self.say(node, lambda v: v['message'] == 'wheels and inertial unit')['level'], 0)
        stamp = max(node.poses)
        pose, transform = node.poses[stamp], node.transforms[stamp]
        self.assertEqual((pose.header.frame_id, transform.header.frame_id, transform.child_frame_id),
                         ('odom_combined', 'odom_combined', BASE))
        self.assertEqual((pose.pose.pose.position.x, pose.pose.pose.orientation.z),
                         (transform.transform.translation.x, transform.transform.rotation.z))
        for index in (0, 7, 35):
            self.assertTrue(0.0 < pose.pose.covariance[index] < 0.1, pose.pose.covariance)

    @long_case
    def test_a_unit_upside_down_corrects_as_well(self):
        node = Node(self)
        self.step(node, frame=UPSIDE_DOWN)
        self.assertLess(self.errors(self.drive(200, node, frame=UPSIDE_DOWN)[0])[1], 0.01)

    @long_case
    def test_a_unit_that_tells_rates_alone_corrects_as_well(self):
        plain, before = self.inertia, [0.0]

        def rates(frame):
            message = plain(frame)
            yaw = self.robot.pose[2]
            rate, before[0] = wrapped(yaw - before[0]) / PERIOD, yaw
            w, w_I = message.angular_velocity, MOUNTED[frame][:3, :3].T @ (0.0, 0.0, rate)
            w.x, w.y, w.z = w_I
            message.orientation = type(message.orientation)()
            message.orientation_covariance[0] = -1.0
            return message
        self.inertia = rates
        for frame in UNIT, UPSIDE_DOWN:
            node = Node(self)
            self.step(node, frame=frame)
            begun, turned = self.said(node), self.robot.pose[2]
            self.drive(200, node, frame=frame)
            self.assertGreater(wrapped(self.robot.pose[2] - turned), 0.9)
            error = wrapped(self.said(node)[2] - begun[2]) - wrapped(self.robot.pose[2] - turned)
            self.assertLess(abs(error), 0.01)
            self.say(node, lambda v: v['imu_data, taken'] == '201' and not v['dropped last'])

    def test_wheels_that_are_a_little_late_are_left_out(self):
        node = Node(self)
        self.step(node)
        for _ in range(50):
            late = self.odometry()
            self.drive(2, node)
            self.wheels.publish(late)
        self.drive(1, node)
        self.say(node, lambda v: v.get('odom, late') == '50')
        self.assertLess(self.errors(self.said(node))[0], 0.05)
        self.assertNotIn('time went back', node.process.output())

    def test_without_a_unit_the_wheels_are_followed(self):
        """Odometry waits for the unit until newer ones are there."""
        node = Node(self)
        for _ in range(60):
            self.robot.move(0.008, 0.01)
            self.step(with_unit=False)
        last = self.robot.odometry
        first = self.rospy.Time.from_sec(self.now).to_nsec()
        for _ in range(5):
            self.step(with_unit=False)
        wait_until(lambda: first in node.poses, lambda: 'odometry alone\n' + node.process.output())
        pose = node.poses[first].pose.pose
        self.assertAlmostEqual(pose.position.x, last[0], places=9)
        self.assertAlmostEqual(pose.position.y, last[1], places=9)
        self.say(node, lambda v: v['message'] == 'wheels alone: nothing comes on /imu_data'
                 or v['message'].startswith('nothing came on /odom'))

    def test_the_same_messages_give_the_same_bits_in_any_order(self):
        """One node hears the unit before the wheels and the other one after them."""
        def told(unit_first):
            node = Node(self)
            self.setUp()
            for i in range(100):
                self.now = round(self.now + PERIOD, 3)
                self.robot.move(0.008, 0.01)
                both = [(self.units, self.inertia()), (self.wheels, self.odometry())]
                for publisher, message in both if unit_first else reversed(both):
                    publisher.publish(message)
                stamp = self.rospy.Time.from_sec(self.now).to_nsec()
                wait_until(lambda: stamp in node.poses, lambda: 'an answer\n' + node.process.output())
            node.process.kill()
            return {stamp: m.pose for stamp, m in node.poses.items()}
        first = told(True)
        self.assertEqual(len(first), 100)
        self.assertEqual(first, told(False))

    # What is wrong.

    @long_case
    def test_readings_that_are_wrong_are_dropped_with_the_reason(self):
        node = Node(self)
        self.step(node)
        self.drive(20, node)

        def refuse(words, publisher, message, change):
            change(message)
            publisher.publish(message)
            self.step(node)  # a unit's frame may still become known until then
            self.say(node, lambda v: words in v['dropped last'])
        zero = self.rospy.Time(0)
        refuse('odom: header.stamp is 0', self.wheels, self.odometry(), lambda m: setattr(m.header, 'stamp', zero))
        refuse("child_frame_id is 'wheel', wanted 'base_footprint'", self.wheels, self.odometry(),
               lambda m: setattr(m, 'child_frame_id', 'wheel'))
        refuse('odom: pose.pose.orientation has length 0', self.wheels, self.odometry(),
               lambda m: setattr(m.pose.pose, 'orientation', type(m.pose.pose.orientation)()))
        refuse('imu_data: header.stamp is 0', self.units, self.inertia(),
               lambda m: setattr(m.header, 'stamp', zero))
        refuse("imu_data: header.frame_id is 'attic'", self.units, self.inertia(),
               lambda m: setattr(m.header, 'frame_id', 'attic'))
        nothing = [-1.0] + [0.0] * 8
        refuse('the unit tells neither', self.units, self.inertia(),
               lambda m: (setattr(m, 'orientation_covariance', nothing),
                          setattr(m, 'angular_velocity_covariance', nothing)))
        refuse('imu_data: orientation has length nan', self.units, self.inertia(),
               lambda m: setattr(m.orientation, 'x', NAN))
        nowhere = self.odometry()
        nowhere.header.stamp = self.rospy.Time.from_sec(self.now + 0.001)
        nowhere.pose.pose.position.x = NAN
        self.wheels.publish(nowhere)
        self.drive(20, node)
        self.say(node, lambda v: v.get('odom, not finite') == '1')
        self.assertLess(self.errors(self.said(node))[0], 0.05)

    def test_wheels_that_begin_again_at_zero_move_nothing(self):
        node = Node(self)
        self.step(node)
        before = self.drive(150, node)[0]
        self.robot.odometry = (-20.0, 7.0, 1.0)
        self.step(node)
        self.assertLess(math.dist(self.said(node)[:2], before[:2]), 0.01)
        self.say(node, lambda v: v.get('odom, jumped') == '1')
        self.drive(150, node)
        self.assertLess(self.errors(self.said(node))[0], 0.1)

    @long_case
    def test_a_clock_that_begins_again_is_gone_along_with(self):
        node = Node(self)
        self.step(node)
        self.drive(100, node)
        self.now = 10.0
        node.poses.clear()
        self.drive(100, node)
        self.say(node, lambda v: v.get('odom, time went back') == '1')
        self.assertLess(self.errors(self.said(node))[0], 0.05)

    def test_silence_of_the_wheels_is_told(self):
        node = Node(self)
        self.say(node, lambda v: v['message'] == 'waits for /odom')
        self.step(node)
        self.assertEqual(self.say(node, lambda v: v['message'].startswith('nothing came on /odom'))['level'], 2)

    def test_parameters_that_nobody_knows_end_it(self):
        node = self.processes.start([executable('odometry_filter'), '__name:=mistaken', '_freq:=30'], self.main)
        self.assertNotEqual(node.wait(), 0)
        self.assertIn("'freq'", node.output())


if __name__ == '__main__':
    run_test('odometry_filter', OdometryFilterTest)
