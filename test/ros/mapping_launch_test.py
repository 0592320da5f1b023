#!/usr/bin/env python3
"""launch/odometry_filter.launch and launch/mapping.launch as the user of a robot starts them that has neither:
wheels, inertial unit and laser go in, a map and where the robot is in it come out. Run by
`rostest hires mapping_launch.test`."""

import glob
import math
import os
import sys
import unittest

import rospy
from nav_msgs.msg import OccupancyGrid, Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Imu, LaserScan
from tf2_msgs.msg import TFMessage

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from ros_processes import wait_until  # noqa: E402
from scanned_room import (BASE, Laser, Robot, after, laser_transform, odometry_message, quaternion_of,  # noqa: E402
                          scan_message, transform_message, wrapped, yaw_of)
from test_run import run_test  # noqa: E402

LAUNCH = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'launch')
PERIOD = 0.2  # [s]
UNIT = 'imu_link'


class MappingLaunchTest(unittest.TestCase):
    def test_wheels_unit_and_laser_make_a_map(self):
        rospy.init_node('mapping_launch_test')
        topics = {'/clock': Clock, '/tf_static': TFMessage, 'base_scan': LaserScan, 'base_odometry/odom': Odometry,
                  'torso_lift_imu/data': Imu}
        out = {topic: rospy.Publisher(topic, kind, queue_size=1000, latch=topic == '/tf_static')
               for topic, kind in topics.items()}
        transforms, maps = {}, []

        def take(message):
            for transform in message.transforms:
                transforms[transform.child_frame_id, transform.header.stamp.to_nsec()] = transform.transform
        rospy.Subscriber('/tf', TFMessage, take, queue_size=1000)
        rospy.Subscriber('map', OccupancyGrid, maps.append, queue_size=100)
        out['/tf_static'].publish(TFMessage([laser_transform(),
                                             transform_message(BASE, UNIT, (0.0, 0.0, 0.3), 0.0)]))
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
            """Where they say it is now, as the room has it; nothing: they did not say it yet."""
            stamp = rospy.Time.from_sec(now)
            X_OB = transforms.get((BASE, stamp.to_nsec()))
            X_MO = transforms.get(('odom_combined', (stamp + rospy.Duration.from_sec(0.1)).to_nsec()))
            return X_OB and X_MO and after(Robot.START, after(*((t.translation.x, t.translation.y, yaw_of(t.rotation))
                                                                for t in (X_MO, X_OB))))

        def is_placed():
            if placed():
                return True
            hear()
            return False
        wait_until(is_placed, 'the first pose')
        for _ in range(60):
            robot.drive()
            hear()
            pose = wait_until(placed, 'an answer to a scan')
            last = math.dist(pose[:2], robot.pose[:2]), abs(wrapped(pose[2] - robot.pose[2]))
        print('off by %.3f m, %.4f rad' % last)
        self.assertLess(last[0], 0.1)
        self.assertLess(last[1], 0.05)
        wait_until(lambda: len(maps) >= 3, 'three maps in 12 s')

    def test_no_other_launch_file_starts_it(self):
        """It would fight with a map server, and with whatever else says where the robot is."""
        for path in glob.glob(os.path.join(LAUNCH, '*.launch')):
            if os.path.basename(path) == 'mapping.launch':
                continue
            with open(path) as file:
                text = file.read()
            self.assertNotIn('mapping.launch', text, path)
            self.assertNotIn('type="mapping"', text, path)


if __name__ == '__main__':
    run_test('mapping_launch', MappingLaunchTest)
