#!/usr/bin/env python3
"""launch/odometry_filter.launch and launch/localisation.launch as the user of a robot starts them that has
neither: wheels, inertial unit and laser go in, where the robot is comes out. Run by
`rostest hires localisation_launch.test`."""

import glob
import math
import os
import sys
import unittest

import roslaunch.config
import roslaunch.xmlloader
import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import OccupancyGrid, Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Imu, LaserScan
from tf2_msgs.msg import TFMessage

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from ros_processes import wait_until  # noqa: E402
from scanned_room import (BASE, Laser, Robot, after, laser_transform, map_message, odometry_message,  # noqa: E402
                          pose_message, quaternion_of, scan_message, transform_message, wrapped, yaw_of)
from test_run import run_test  # noqa: E402

NODES = {'localisation', 'odometry_filter'}
LAUNCH = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'launch')
PERIOD = 0.2  # [s]
UNIT = 'imu_link'


def loaded(file, *arguments):
    """What roslaunch reads there."""
    config = roslaunch.config.ROSLaunchConfig()
    roslaunch.xmlloader.XmlLoader().load(os.path.join(LAUNCH, file), config, argv=list(arguments), verbose=False)
    return config


class LocalisationLaunchTest(unittest.TestCase):
    def test_wheels_unit_and_laser_tell_where_the_robot_is(self):
        rospy.init_node('localisation_launch_test')
        topics = {'/clock': Clock, '/tf_static': TFMessage, 'map': OccupancyGrid, 'base_scan': LaserScan,
                  'initialpose': PoseWithCovarianceStamped, 'base_odometry/odom': Odometry,
                  'torso_lift_imu/data': Imu}
        out = {topic: rospy.Publisher(topic, kind, queue_size=1000, latch=topic in ('/tf_static', 'map'))
               for topic, kind in topics.items()}
        transforms, poses = {}, []

        def take(message):
            for transform in message.transforms:
                transforms[transform.child_frame_id, transform.header.stamp.to_nsec()] = transform.transform
        rospy.Subscriber('/tf', TFMessage, take, queue_size=1000)
        rospy.Subscriber('amcl_pose', PoseWithCovarianceStamped, poses.append, queue_size=1000)
        out['/tf_static'].publish(TFMessage([laser_transform(),
                                             transform_message(BASE, UNIT, (0.0, 0.0, 0.3), 0.0)]))
        out['map'].publish(map_message())
        shared = {'/clock': 2, '/tf_static': 2}  # the nodes that hear it
        wait_until(lambda: all(publisher.get_num_connections() >= shared.get(topic, 1)
                               for topic, publisher in out.items()), 'both nodes to listen')
        robot, laser, now = Robot(), Laser(), 1000.0

        def hear():
            """All that the robot measures at one time."""
            nonlocal now
            now = round(now + PERIOD, 3)
            out['/clock'].publish(rospy.Time.from_sec(now))
            unit = Imu(orientation=quaternion_of(robot.pose[2] + 0.3 - 1.0))
            unit.header.frame_id, unit.header.stamp = UNIT, rospy.Time.from_sec(now)
            out['torso_lift_imu/data'].publish(unit)
            out['base_odometry/odom'].publish(odometry_message(robot.odometry, now))
            out['base_scan'].publish(scan_message(laser, robot.pose, now))

        def placed():
            """Where they say it is now; nothing: they did not say it yet."""
            stamp = rospy.Time.from_sec(now)
            X_OB = transforms.get((BASE, stamp.to_nsec()))
            X_MO = transforms.get(('odom_combined', (stamp + rospy.Duration.from_sec(0.1)).to_nsec()))
            return X_OB and X_MO and after(*((t.translation.x, t.translation.y, yaw_of(t.rotation))
                                             for t in (X_MO, X_OB)))

        def is_placed():
            if placed():
                return True
            hear()
            out['initialpose'].publish(pose_message(Robot.START, now))
            return False
        wait_until(is_placed, 'the first pose')
        for _ in range(60):
            robot.drive()
            hear()
            pose = wait_until(placed, 'an answer to a scan')
            last = math.dist(pose[:2], robot.pose[:2]), abs(wrapped(pose[2] - robot.pose[2]))
        print('off by %.3f m, %.4f rad' % last)
        self.assertLess(last[0], 0.15)
        self.assertLess(last[1], 0.06)
        self.assertGreater(len(poses), 20)

    def test_no_other_launch_file_starts_them_but_the_closed_loop_when_told(self):
        """A PR2 runs its own, and the simulated robot tells where it is, unless it is told not to."""
        for path in glob.glob(os.path.join(LAUNCH, '*.launch')):
            for node in NODES:
                with open(path) as file:
                    text = file.read()
                if os.path.basename(path) != node + '.launch':
                    self.assertNotIn('type="%s"' % node, text, path)
                    if os.path.basename(path) != 'closed_loop.launch':
                        self.assertNotIn('%s.launch' % node, text, path)

    def test_the_closed_loop_starts_them_for_a_robot_that_does_not_tell_its_place(self):
        for localisation, started in (('robot', set()), ('nodes', NODES)):
            for file, arguments in (('topple.launch', []),
                                    ('closed_loop.launch', ['scenario:=topple', 'task:=none', 'knowledge:=none'])):
                config = loaded(file, 'localisation:=' + localisation, *arguments)
                nodes = {node.type: node for node in config.nodes}
                self.assertEqual(NODES & set(nodes), started, (file, localisation))
                self.assertTrue(all(nodes[name].respawn for name in started))
                self.assertEqual(config.params['/sim_robot/tells_place'].value, localisation == 'robot')


if __name__ == '__main__':
    run_test('localisation_launch', LocalisationLaunchTest)
