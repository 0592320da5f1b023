#!/usr/bin/env python3
"""The node that recognises what stands on tables, as a real process with clouds made here: what it says
of a box on a table, of two tables and of none, and of clouds and transforms that are wrong, late or old. Run alone, or
by `rostest hires tabletop_recogniser.test`."""

import math
import os
import sys
import threading
import time
import unittest

import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from diagnostics import diagnostics  # noqa: E402
from ros_processes import LIMIT, Processes, executable, wait_until  # noqa: E402
from test_run import long_case, run_test  # noqa: E402

CLOUD = 'head_mount_kinect/depth_registered/points'
CAMERA = 'camera_optical'
BODY = 'camera_body'     # x forward, y left, z up
EYE = (0.0, 0.0, 1.3)    # [m] above the floor
DOWN = 0.8               # [rad] that it looks down
TABLE_TOP = 0.7          # [m]
TABLE = ((0.35, 1.1), (-0.5, 0.5), (TABLE_TOP - 0.03, TABLE_TOP))  # [m] x, y, z from .. to
BOX = ((0.66, 0.80), (-0.05, 0.13), (TABLE_TOP, TABLE_TOP + 0.21))
FLOOR = ((-9.0, 9.0), (-9.0, 9.0), (-0.1, 0.0))
# Two tables side by side, a box on each; the left one is a little higher and larger.
LEFT_TABLE = ((0.45, 1.1), (0.06, 0.55), (0.72, 0.75))
RIGHT_TABLE = ((0.45, 1.1), (-0.51, -0.06), (0.67, 0.70))
LEFT_BOX = ((0.70, 0.80), (0.24, 0.36), (0.75, 0.91))
RIGHT_BOX = ((0.70, 0.80), (-0.36, -0.24), (0.70, 0.86))
WALL = ((1.2, 1.3), (-9.0, 9.0), (0.0, 9.0))
MAX_RANGE = 3.5          # [m]
OK, WARN = 0, 1          # of diagnostic_msgs/DiagnosticStatus
MAX_AGE = 3.0            # [s] as config/recogniser.yaml has it


def camera_rotation():
    """Axes of the optical frame (x right, y down, z forward) in the base."""
    forward = numpy.array([math.cos(DOWN), 0.0, -math.sin(DOWN)])
    right = numpy.array([0.0, -1.0, 0.0])
    return numpy.stack([right, numpy.cross(forward, right), forward], axis=1)


def points_of(boxes, width=320, height=240):
    """height x width x 3 [m] in the camera's frame; NaN where nothing is met. Boxes along the axes."""
    focal = 0.5 * width / math.tan(0.5 * math.radians(58.0))
    columns, rows = numpy.meshgrid(numpy.arange(width) + 0.5, numpy.arange(height) + 0.5)
    rays = numpy.stack([(columns - 0.5 * width) / focal, (rows - 0.5 * height) / focal,
                        numpy.ones_like(columns)], axis=-1)
    directions = rays @ camera_rotation().T
    depth = numpy.full(columns.shape, numpy.inf)
    for box in boxes:
        low, high = numpy.array(box, dtype=float).T
        with numpy.errstate(divide='ignore'):
            first, second = (low - EYE) / directions, (high - EYE) / directions
        near = numpy.minimum(first, second).max(axis=-1)
        far = numpy.maximum(first, second).min(axis=-1)
        depth = numpy.where((near <= far) & (near > 0.0), numpy.minimum(depth, near), depth)
    points = rays * depth[..., numpy.newaxis]
    points[~(numpy.linalg.norm(points, axis=-1) < MAX_RANGE)] = numpy.nan
    return points.astype('<f4')


class TabletopRecogniserTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.processes = Processes()
        cls.addClassCleanup(cls.processes.stop_all)
        cls.main = cls.processes.master()
        os.environ.update(ROS_MASTER_URI=cls.main.uri, ROS_IP='127.0.0.1')
        os.environ.pop('ROS_HOSTNAME', None)
        import rospy
        from geometry_msgs.msg import Quaternion
        from hires.msg import Detections
        from sensor_msgs.msg import PointCloud2
        from tf2_msgs.msg import TFMessage
        cls.rospy = rospy
        rospy.init_node('tabletop_recogniser_test', disable_signals=True)
        cls.node = cls.processes.start([executable('tabletop_recogniser')], cls.main)
        cls.changed = threading.Condition()
        cls.answers = []
        # Before anybody listens to what it says it does not ask for clouds.
        wait_until(lambda: '/tabletop_recogniser' in cls.main.publishers('/detections'),
                   lambda: 'the node\n' + cls.node.output())
        cls.listeners_at_rest = cls.main.subscribers('/' + CLOUD)
        cls.clouds = rospy.Publisher(CLOUD, PointCloud2, queue_size=10)
        cls.fixed = rospy.Publisher('/tf_static', TFMessage, queue_size=10, latch=True)
        cls.moving = rospy.Publisher('/tf', TFMessage, queue_size=100)
        rospy.Subscriber('detections', Detections, cls._note, queue_size=100)
        body = cls.transform(BODY, 0.0)
        body.transform.rotation = Quaternion(0.0, math.sin(0.5 * DOWN), 0.0, math.cos(0.5 * DOWN))
        cls.fixed.publish(TFMessage([cls.transform(CAMERA, 0.0), body]))
        wait_until(lambda: cls.clouds.get_num_connections() > 0 and
                   cls.moving.get_num_connections() > 0 and cls.fixed.get_num_connections() > 0,
                   lambda: 'the node to listen\n' + cls.node.output())

    @classmethod
    def _note(cls, message):
        with cls.changed:
            cls.answers.append(message)
            cls.changed.notify_all()

    @classmethod
    def transform(cls, child, stamp):
        from geometry_msgs.msg import TransformStamped
        message = TransformStamped()
        message.header.stamp = cls.rospy.Time.from_sec(stamp)
        message.header.frame_id = 'base_footprint'
        message.child_frame_id = child
        where = message.transform.translation
        where.x, where.y, where.z = EYE
        # Optical axes for a camera that looks ahead, then down about the base's y axis.
        turn = message.transform.rotation
        half = 0.5 * DOWN
        ahead = (-0.5, 0.5, -0.5, 0.5)  # x, y, z, w
        c, s = math.cos(half), math.sin(half)
        turn.x = c * ahead[0] + s * ahead[2]
        turn.y = c * ahead[1] + s * ahead[3]
        turn.z = c * ahead[2] - s * ahead[0]
        turn.w = c * ahead[3] - s * ahead[1]
        return message

    def cloud(self, points, stamp, frame=CAMERA):
        from sensor_msgs.msg import PointCloud2, PointField
        message = PointCloud2()
        message.header.stamp = self.rospy.Time.from_sec(stamp)
        message.header.frame_id = frame
        message.height, message.width = points.shape[:2]
        message.fields = [PointField(name, 4 * i, PointField.FLOAT32, 1) for i, name in enumerate('xyz')]
        message.point_step = 12
        message.row_step = 12 * message.width
        message.data = points.tobytes()
        return message

    stamp = 0.0  # [s] of the newest cloud

    def next_stamp(self):
        """Now; later than all before."""
        TabletopRecogniserTest.stamp = max(time.time(), self.stamp + 0.001)
        return self.stamp

    def answer_to(self, message):
        self.clouds.publish(message)
        with self.changed:
            def mine():
                return [a for a in self.answers if a.header.stamp == message.header.stamp]
            self.assertTrue(self.changed.wait_for(mine, LIMIT), self.node.output())
            return mine()[-1]

    def look(self, boxes, **size):
        return self.answer_to(self.cloud(points_of(boxes, **size), self.next_stamp()))

    def require_box(self, seen):
        """One thing that none of the catalogue is, where the box is and as large."""
        self.assertFalse(seen.is_blind)
        self.assertEqual([d.label for d in seen.detections], ['unknown'])
        thing = seen.detections[0]
        p = thing.pose.position
        in_base = camera_rotation() @ (p.x, p.y, p.z) + EYE
        middle = [0.5 * (low + high) for low, high in BOX[:2]] + [TABLE_TOP]
        numpy.testing.assert_allclose(in_base, middle, atol=0.02)
        sides = sorted([thing.size.x, thing.size.y])
        numpy.testing.assert_allclose(sides + [thing.size.z], [0.14, 0.18, 0.21], atol=0.02)

    def say(self, words):
        """The node's diagnostics, once their message has those words."""
        return diagnostics(self.rospy, 'tabletop_recogniser', lambda v: words in v['message'])

    def refuse(self, message, words):
        """That it is dropped for that reason, and the next good one is recognised all the same."""
        before = len(self.answers)
        self.clouds.publish(message)
        self.say(words)
        self.assertEqual(len(self.answers), before, 'nothing is said of it')
        self.require_box(self.look([FLOOR, TABLE, BOX]))

    # What there is.

    def test_a_box_on_a_table_is_unknown_where_it_stands(self):
        seen = self.look([FLOOR, TABLE, BOX])
        self.assertEqual(seen.header.frame_id, CAMERA)
        self.require_box(seen)
        corners = numpy.array([(c.x, c.y, c.z) for c in seen.table]) @ camera_rotation().T + EYE
        numpy.testing.assert_allclose(corners[:, 2], TABLE_TOP, atol=0.01)
        self.assertLess(abs(corners[:, 1].max() - 0.5), 0.03)
        self.assertIn('tf does not know', self.say('recognises')['message'])  # no robot is there

    def test_a_cloud_that_comes_again_gets_the_same_answer(self):
        from io import BytesIO
        message = self.cloud(points_of([FLOOR, TABLE, BOX]), self.next_stamp())
        first = self.answer_to(message)
        num_before = len(self.answers)
        self.clouds.publish(message)
        with self.changed:
            self.assertTrue(self.changed.wait_for(lambda: len(self.answers) > num_before, LIMIT))
            again = self.answers[-1]
        texts = [BytesIO(), BytesIO()]
        first.serialize(texts[0])
        again.serialize(texts[1])
        self.assertEqual(texts[0].getvalue()[16:], texts[1].getvalue()[16:])

    def test_points_in_no_order_are_recognised_too(self):
        points = points_of([FLOOR, TABLE, BOX])
        measured = points[numpy.isfinite(points).all(axis=-1)][numpy.newaxis]
        self.require_box(self.answer_to(self.cloud(measured, self.next_stamp())))

    def test_a_million_points(self):
        self.require_box(self.look([FLOOR, TABLE, BOX], width=1200, height=900))

    def test_a_table_without_things(self):
        seen = self.look([FLOOR, TABLE])
        self.assertEqual((seen.is_blind, len(seen.detections)), (False, 0))
        self.assertGreaterEqual(len(seen.table), 3)

    def test_of_two_tables_the_larger_ones_things_are_told_and_no_others(self):
        seen = self.look([FLOOR, LEFT_TABLE, RIGHT_TABLE, LEFT_BOX, RIGHT_BOX])
        self.assertEqual([d.label for d in seen.detections], ['unknown'])
        p = seen.detections[0].pose.position
        in_base = camera_rotation() @ (p.x, p.y, p.z) + EYE
        numpy.testing.assert_allclose(in_base, (0.75, 0.30, 0.75), atol=0.02)
        corners = numpy.array([(c.x, c.y, c.z) for c in seen.table]) @ camera_rotation().T + EYE
        numpy.testing.assert_allclose(corners[:, 2], 0.75, atol=0.01)
        self.assertGreater(corners[:, 1].min(), 0.0)

    def require_nothing(self, points, words, level, frame=CAMERA):
        """That no table and no thing is told of, and what the node says of that cloud."""
        self.look([FLOOR, TABLE, BOX])
        seen = self.answer_to(self.cloud(points, self.next_stamp(), frame))
        self.assertEqual((seen.is_blind, len(seen.detections), len(seen.table)), (True, 0, 0))
        self.assertEqual(self.say(words)['level'], level)

    def test_where_no_table_is_seen_nothing_is_said(self):
        for name, boxes in {'floor': [FLOOR], 'floor and wall': [FLOOR, WALL]}.items():
            with self.subTest(cloud=name):
                self.require_nothing(points_of(boxes), 'sees no table', OK)

    def test_a_cloud_in_which_nothing_was_measured_is_warned_of(self):
        self.require_nothing(numpy.full((240, 320, 3), numpy.nan, '<f4'),
                             'no point of the cloud was measured', WARN)

    def test_a_cloud_without_points_is_warned_of(self):
        self.require_nothing(numpy.zeros((0, 0, 3), '<f4'), 'the cloud has no points', WARN)

    # What is wrong.

    @long_case
    def test_clouds_that_are_wrong_are_dropped_with_the_reason(self):
        def good():
            return self.cloud(points_of([FLOOR, TABLE, BOX]), self.next_stamp())
        without_stamp = good()
        without_stamp.header.stamp = self.rospy.Time(0)
        self.refuse(without_stamp, 'header.stamp is 0')
        nowhere = good()
        nowhere.header.frame_id = ''
        self.refuse(nowhere, 'header.frame_id is empty')
        doubles = good()
        doubles.fields[1].datatype = 8
        self.refuse(doubles, "field 'y' has datatype 8")
        flat = good()
        del flat.fields[2]
        self.refuse(flat, "field 'z' is missing")
        other_end = good()
        other_end.is_bigendian = True
        self.refuse(other_end, 'big-endian')
        short = good()
        short.data = short.data[:-4]
        self.refuse(short, 'data to hold height * row_step')

    def test_a_frame_that_tf_does_not_know_is_waited_for(self):
        message = self.cloud(points_of([FLOOR, TABLE, BOX]), self.next_stamp(), 'nobodys_camera')
        self.clouds.publish(message)
        values = self.say('waits for the transform')
        self.assertIn('nobodys_camera', values['message'])
        self.assertIn('base_footprint', values['message'])
        self.require_box(self.look([FLOOR, TABLE, BOX]))

    def test_a_transform_that_comes_late_is_made_use_of(self):
        from tf2_msgs.msg import TFMessage
        stamp = self.next_stamp()
        self.clouds.publish(self.cloud(points_of([FLOOR, TABLE, BOX]), stamp, 'moving_camera'))
        self.say('waits for the transform')
        self.moving.publish(TFMessage([self.transform('moving_camera', stamp - 0.01)]))
        self.moving.publish(TFMessage([self.transform('moving_camera', stamp + 0.01)]))
        with self.changed:
            self.assertTrue(self.changed.wait_for(
                lambda: self.answers and self.answers[-1].header.frame_id == 'moving_camera', LIMIT))
            self.require_box(self.answers[-1])

    def test_a_cloud_older_than_what_is_kept_of_tf_is_dropped(self):
        from tf2_msgs.msg import TFMessage
        now = time.time()
        for back in (0.2, 0.1, 0.0):
            self.moving.publish(TFMessage([self.transform('old_camera', now - back)]))
        message = self.cloud(points_of([FLOOR, TABLE, BOX]), now - 1.0, 'old_camera')
        self.refuse(message, 'older than what is kept of tf')

    def test_a_cloud_that_is_old_is_dropped_though_its_frame_is_known(self):
        message = self.cloud(points_of([FLOOR, TABLE, BOX]), time.time() - 300.0)
        self.refuse(message, 's old, wanted 3 at most')
        self.assertGreaterEqual(int(self.say('recognises')['dropped, too old']), 1)

    @long_case
    def test_a_cloud_that_comes_again_when_it_is_old_is_dropped(self):
        message = self.cloud(points_of([FLOOR, TABLE, BOX]), self.next_stamp())
        self.answer_to(message)
        wait_until(lambda: time.time() > message.header.stamp.to_sec() + MAX_AGE, 'it to be old')
        self.refuse(message, 's old, wanted 3 at most')

    @long_case
    def test_clouds_of_the_future_are_dropped(self):
        for ahead in (5.0, 2.4e9):
            with self.subTest(ahead=ahead):
                message = self.cloud(points_of([FLOOR, TABLE, BOX]), time.time() + ahead)
                self.refuse(message, 's in the future, wanted 0.5 at most')
        self.assertGreaterEqual(int(self.say('recognises')['dropped, ahead of time']), 2)

    @long_case
    def test_a_cloud_whose_transform_does_not_come_is_dropped_in_the_end(self):
        message = self.cloud(points_of([FLOOR, TABLE, BOX]), self.next_stamp(), 'never_told_camera')
        self.refuse(message, 's old for the transform of \'never_told_camera\'')
        self.assertGreaterEqual(int(self.say('recognises')['dropped, without transform']), 1)

    # A camera's body has its x axis forward; clouds are to be in its optical frame.

    def test_of_a_cloud_labelled_with_the_cameras_body_nothing_is_invented(self):
        self.require_nothing(points_of([FLOOR, TABLE, BOX]), 'sees no table', OK, BODY)

    def test_a_cloud_with_x_forward_is_dropped(self):
        optical = points_of([FLOOR, TABLE, BOX])
        forward = numpy.stack([optical[..., 2], -optical[..., 0], -optical[..., 1]], axis=-1)
        message = self.cloud(forward.astype('<f4'), self.next_stamp(), BODY)
        self.refuse(message, 'points lie behind the camera; wanted an optical frame')

    def test_who_is_not_heard_does_not_ask_for_clouds(self):
        self.assertEqual(self.listeners_at_rest, [])


if __name__ == '__main__':
    run_test('tabletop_recogniser', TabletopRecogniserTest)
