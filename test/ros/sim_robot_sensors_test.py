#!/usr/bin/env python3
"""The cameras and lasers of the simulated robot that other programs look through: cloud, pictures, heat
and scans agree with each other, with tf and with what there is; nothing is drawn for nobody. Run alone,
or by `rostest hires sim_robot_sensors.test`."""

import os
import sys
import threading
import unittest

import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from robot_system import RobotSystem  # noqa: E402
from ros_processes import LIMIT  # noqa: E402
from test_run import run_test  # noqa: E402

MUG = (7.60, 11.30)   # [m] on table1, radius 0.04 m
TABLE_TOP = 0.73      # [m]
HOT = 33815           # [centikelvin]
ROOM = 29315
SCENARIO = '''task: serve_coffee_to_guest guest1
knowledge: []
robot: {pose: [7.6, 9.6, 1.5707963], torso: torsodownposture}
objects:
  - {name: mug1, pose: [%.2f, %.2f, %.2f, 0.0], temperature: 338.15}
''' % (*MUG, TABLE_TOP)


class Gathered:
    """The newest message of each of some topics; `tf` keeps transforms by stamp and child."""

    def __init__(self, rospy, topics):
        from tf2_msgs.msg import TFMessage
        self._changed = threading.Condition()
        self._by_stamp = {topic: {} for topic in topics}
        self._transforms = {}
        self._subscribers = [
            rospy.Subscriber(topic, kind, lambda m, t=topic: self._note(t, m), queue_size=100)
            for topic, kind in topics.items()]
        self._subscribers.append(rospy.Subscriber('/tf', TFMessage, self._on_tf, queue_size=1000,
                                                  tcp_nodelay=True))

    def _note(self, topic, message):
        with self._changed:
            self._by_stamp[topic][message.header.stamp.to_nsec()] = message
            self._changed.notify_all()

    def _on_tf(self, message):
        with self._changed:
            for transform in message.transforms:
                stamp = transform.header.stamp.to_nsec()
                self._transforms.setdefault(stamp, {})[transform.child_frame_id] = transform
            self._changed.notify_all()

    def _common_stamp(self, frame):
        stamps = [set(messages) for messages in self._by_stamp.values()]
        whole = [s for s in set.intersection(*stamps)
                 if {frame, 'map'} & set(self._transforms.get(s, {})) and
                 'odom_combined' in self._transforms[s]]
        return max(whole, default=None)

    def together(self, frame):
        """{topic: message} of one stamp, at which tf knows `frame`, and that stamp."""
        with self._changed:
            assert self._changed.wait_for(lambda: self._common_stamp(frame) is not None, LIMIT), \
                'no moment with all of %s; there are %s' % (
                    list(self._by_stamp), {t: len(m) for t, m in self._by_stamp.items()})
            stamp = self._common_stamp(frame)
            return {topic: messages[stamp] for topic, messages in self._by_stamp.items()}, stamp

    def to_map(self, frame, stamp):
        """4 x 4: points of `frame` to points of the map."""
        pose = numpy.eye(4)
        while frame != 'map':
            transform = self._transforms[stamp][frame]
            pose = matrix_of(transform.transform) @ pose
            frame = transform.header.frame_id
        return pose

    def wait(self, topic, count):
        """Messages of the topic in order of time, once there are `count`."""
        with self._changed:
            assert self._changed.wait_for(lambda: len(self._by_stamp[topic]) >= count, LIMIT), \
                'only %d messages on %s' % (len(self._by_stamp[topic]), topic)
            return [message for _, message in sorted(self._by_stamp[topic].items())]

    def close(self):
        for subscriber in self._subscribers:
            subscriber.unregister()


def matrix_of(transform):
    q, p = transform.rotation, transform.translation
    x, y, z, w = q.x, q.y, q.z, q.w
    pose = numpy.eye(4)
    pose[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                    [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                    [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    pose[:3, 3] = p.x, p.y, p.z
    return pose


def points_of(cloud):
    """height x width x fields"""
    fields = [field.name for field in cloud.fields]
    kinds = {name: '<u4' if name == 'rgb' else '<f4' for name in fields}
    kind = numpy.dtype({'names': fields, 'formats': [kinds[name] for name in fields],
                        'offsets': [field.offset for field in cloud.fields],
                        'itemsize': cloud.point_step})
    return numpy.frombuffer(cloud.data, dtype=kind).reshape(cloud.height, cloud.width)


def pixels_of(image, kind, channels=1):
    return numpy.frombuffer(image.data, dtype=kind).reshape(image.height, image.width, channels)


def period_of(scans):
    """[ns] of which all stamps are multiples: a listener that is slow may miss some."""
    return numpy.gcd.reduce([scan.header.stamp.to_nsec() for scan in scans])


class SimRobotSensorsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.system = RobotSystem(uncertainty='none', pace=0.0)
        cls.addClassCleanup(cls.system.stop)
        cls.system.connect('sim_robot_sensors_test')
        path = os.path.join(cls.system.processes.folder.name, 'warm.yaml')
        with open(path, 'w', encoding='utf-8') as file:
            file.write(SCENARIO)
        cls.system.arguments['scenario'] = path

    def setUp(self):
        self.robot = self.system.start_robot()
        self.addCleanup(self.system.end_processes)

    def gather(self, topics):
        gathered = Gathered(self.system.rospy, topics)
        self.addCleanup(gathered.close)
        return gathered

    def test_cloud_and_pictures_agree_with_each_other_and_with_tf(self):
        from sensor_msgs.msg import CameraInfo, Image, PointCloud2
        camera = 'head_mount_kinect/'
        frame = 'head_mount_kinect_ir_optical_frame'
        gathered = self.gather({camera + 'depth_registered/points': PointCloud2,
                                camera + 'depth_registered/image_raw': Image,
                                camera + 'depth_registered/camera_info': CameraInfo,
                                camera + 'rgb/image_rect_color': Image,
                                camera + 'rgb/camera_info': CameraInfo})
        messages, stamp = gathered.together(frame)
        self.assertEqual({message.header.frame_id for message in messages.values()}, {frame})
        cloud, depth, info, colours, _ = messages.values()
        self.assertEqual((depth.encoding, colours.encoding), ('16UC1', 'rgb8'))
        self.assertEqual((cloud.width, cloud.height), (640, 480))
        points = points_of(cloud)
        is_there = numpy.isfinite(points['z'])
        self.assertGreater(is_there.sum(), 10000)

        millimetres = pixels_of(depth, '<u2')[:, :, 0]
        numpy.testing.assert_array_equal(millimetres > 0, is_there)
        off = numpy.abs(1000.0 * points['z'][is_there] - millimetres[is_there])
        self.assertLessEqual(off.max(), 0.501)
        rgb = pixels_of(colours, 'u1', 3).astype('u4')
        numpy.testing.assert_array_equal(points['rgb'],
                                         rgb[:, :, 0] << 16 | rgb[:, :, 1] << 8 | rgb[:, :, 2])
        columns = numpy.arange(640)[numpy.newaxis, :]
        by_info = (columns - info.K[2]) / info.K[0] * points['z']
        numpy.testing.assert_allclose(points['x'][is_there], by_info[is_there], atol=1e-4)

        in_frame = numpy.stack([points[axis][is_there] for axis in 'xyz'] +
                               [numpy.ones(is_there.sum())])
        x, y, z, _ = gathered.to_map(frame, stamp) @ in_frame
        distances = numpy.hypot(x - MUG[0], y - MUG[1])
        at_mug = (distances < 0.06) & (z > TABLE_TOP + 0.005)
        self.assertGreater(at_mug.sum(), 100)
        side = distances[at_mug & (z < TABLE_TOP + 0.095)]  # without its top
        self.assertLess(numpy.abs(side - 0.04).max(), 0.005, 'its surface, leaning included')
        self.assertGreater(z.min(), -0.02, 'nothing lies below the floor')
        colour = rgb[is_there][at_mug]
        self.assertLess(colour.std(axis=0).max(), 60, 'a mug has one colour, in light and shade')

    def test_a_hot_mug_is_hot_where_tf_says_that_it_is(self):
        from sensor_msgs.msg import CameraInfo, Image
        frame = 'thermal_cam_optical_frame'
        gathered = self.gather({'thermal_cam/image_raw': Image, 'thermal_cam/image_color': Image,
                                'thermal_cam/camera_info': CameraInfo})
        messages, stamp = gathered.together(frame)
        heat, colours, info = messages.values()
        self.assertEqual((heat.encoding, colours.encoding), ('mono16', 'rgb8'))
        centikelvin = pixels_of(heat, '<u2')[:, :, 0]
        self.assertEqual(set(numpy.unique(centikelvin)), {ROOM, HOT})
        middle = numpy.linalg.inv(gathered.to_map(frame, stamp)) @ (*MUG, TABLE_TOP + 0.04, 1.0)
        column, row, _ = numpy.array(info.K).reshape(3, 3) @ (middle[:3] / middle[2])
        self.assertEqual(centikelvin[round(row), round(column)], HOT)
        red, green, _ = pixels_of(colours, 'u1', 3)[round(row), round(column)]
        self.assertGreater(int(red), int(green), 'hot is red')

    def test_the_tilting_laser_sweeps_and_its_cloud_lies_on_the_floor(self):
        from sensor_msgs.msg import LaserScan, PointCloud2
        gathered = self.gather({'tilt_scan': LaserScan, 'tilt_scan_cloud': PointCloud2})
        scans = gathered.wait('tilt_scan', 40)
        self.assertEqual(period_of(scans), 25000000)
        self.assertEqual({(scan.header.frame_id, len(scan.ranges)) for scan in scans},
                         {('laser_tilt_link', 640)})
        cloud = gathered.wait('tilt_scan_cloud', 1)[0]
        self.assertEqual(cloud.header.frame_id, 'odom_combined')
        heights = points_of(cloud)['z'].ravel()
        self.assertGreater(heights.size, 20000)
        self.assertGreater((numpy.abs(heights) < 0.02).sum(), 2000)
        self.assertGreater(heights.min(), -0.02)

    def test_the_trays_laser_comes_with_every_tick(self):
        from sensor_msgs.msg import LaserScan
        scans = self.gather({'tray_laser_scan': LaserScan}).wait('tray_laser_scan', 10)
        self.assertEqual(period_of(scans), 50000000)
        self.assertEqual(scans[0].header.frame_id, 'base_tray_laser_link')

    def test_nothing_is_drawn_for_nobody(self):
        from diagnostic_msgs.msg import DiagnosticArray
        from sensor_msgs.msg import Image
        changed = threading.Condition()
        told = []

        def note(message):
            for status in message.status:
                values = {pair.key: float(pair.value) for pair in status.values
                          if pair.key in ('simulated [s]', 'pictures drawn')}
                if status.name == 'sim_robot: simulation' and values:  # none while it starts up
                    with changed:
                        told.append(values)
                        changed.notify_all()
        diagnostics = self.system.rospy.Subscriber('/diagnostics', DiagnosticArray, note)
        self.addCleanup(diagnostics.unregister)

        def wait(condition):
            with changed:
                assert changed.wait_for(lambda: told and condition(told[-1]), LIMIT), told
                return told[-1]
        self.assertEqual(wait(lambda t: t['simulated [s]'] > 3.0)['pictures drawn'], 0)
        gathered = self.gather({'head_mount_kinect/rgb/image_rect_color': Image})
        gathered.wait('head_mount_kinect/rgb/image_rect_color', 1)
        wait(lambda t: t['pictures drawn'] > 0)


if __name__ == '__main__':
    run_test('sim_robot_sensors', SimRobotSensorsTest)
