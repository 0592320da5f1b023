#!/usr/bin/env python3
"""The node that tells how warm known objects are, as a real process with pictures made here: of two mugs on
the counter, and of pictures, cameras, objects and transforms that are wrong, late or old. Run alone, or by
`rostest hires heat_reader.test`."""

import os
import sys
import threading
import unittest

import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from diagnostics import diagnostics  # noqa: E402
from ros_processes import LIMIT, Processes, executable, wait_until  # noqa: E402
from test_run import long_case, run_test  # noqa: E402

IMAGE, INFO = 'thermal_cam/image_raw', 'thermal_cam/camera_info'
CONFIG = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'config')
CAMERA = 'thermal_optical'
EYE = (6.4, 9.94, 1.15)            # [m] in front of the counter, looking west, level
WEST = (-0.5, -0.5, 0.5, 0.5)      # x, y, z, w of its optical axes
MUGS = {'mug1': (5.37, 10.26, 0.75), 'mug2': (5.37, 9.94, 0.75)}
WIDTH, HEIGHT, FOCAL = 640, 480, 320.0
ROOM, HOT = 29315, 33565           # [0.01 K]


def picture(*hot):
    """Room temperature, and a hot patch about each of these mugs."""
    heat = numpy.full((HEIGHT, WIDTH), ROOM, '<u2')
    for name in hot:
        x, y, z = MUGS[name]
        column = int(0.5 * WIDTH + FOCAL * (y - EYE[1]) / (EYE[0] - x))
        row = int(0.5 * HEIGHT + FOCAL * (EYE[2] - z - 0.05) / (EYE[0] - x))
        heat[row - 35:row + 35, column - 35:column + 35] = HOT
    return heat


class HeatReaderTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.processes = Processes()
        cls.addClassCleanup(cls.processes.stop_all)
        cls.main = cls.processes.master()
        os.environ.update(ROS_MASTER_URI=cls.main.uri, ROS_IP='127.0.0.1')
        os.environ.pop('ROS_HOSTNAME', None)
        import rospy
        from hires.msg import ObjectTemperatures, WorldState
        from sensor_msgs.msg import CameraInfo, Image
        from tf2_msgs.msg import TFMessage
        cls.rospy = rospy
        rospy.init_node('heat_reader_test', disable_signals=True)
        with open(os.path.join(CONFIG, 'heat_reader.yaml')) as file:
            text = file.read().replace('period: 1.0', 'period: 0.05')
        cls.node = cls.processes.start([executable('heat_reader'), '_config:=' + cls.processes.write(
            'heat_reader.yaml', text)], cls.main)
        cls.changed = threading.Condition()
        cls.answers = []
        # Before anybody listens to what it says it does not ask for pictures.
        wait_until(lambda: '/heat_reader' in cls.main.publishers('/object_temperatures'),
                   lambda: 'the node\n' + cls.node.output())
        cls.listeners_at_rest = cls.main.subscribers('/' + IMAGE)
        cls.images = rospy.Publisher(IMAGE, Image, queue_size=10)
        cls.infos = rospy.Publisher(INFO, CameraInfo, queue_size=10)
        cls.known = rospy.Publisher('known_objects', WorldState, queue_size=10)
        cls.fixed = rospy.Publisher('/tf_static', TFMessage, queue_size=10, latch=True)
        cls.moving = rospy.Publisher('/tf', TFMessage, queue_size=100)
        rospy.Subscriber('object_temperatures', ObjectTemperatures, cls._note, queue_size=100)
        cls.fixed.publish(TFMessage([cls.transform(CAMERA, 0.0)]))
        wait_until(lambda: all(p.get_num_connections() > 0 for p in (
            cls.images, cls.infos, cls.known, cls.fixed, cls.moving)),
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
        message.header.frame_id = 'map'
        message.child_frame_id = child
        where, turn = message.transform.translation, message.transform.rotation
        where.x, where.y, where.z = EYE
        turn.x, turn.y, turn.z, turn.w = WEST
        return message

    stamp = 1000.0  # [s] of the newest picture

    def setUp(self):
        HeatReaderTest.stamp += 1.0
        self.infos.publish(self.info())
        self.know(MUGS)

    def info(self):
        from sensor_msgs.msg import CameraInfo
        message = CameraInfo(width=WIDTH, height=HEIGHT)
        message.P = [FOCAL, 0.0, 319.5, 0.0, 0.0, FOCAL, 239.5, 0.0, 0.0, 0.0, 1.0, 0.0]
        return message

    def know(self, mugs, age=0.0, model='coffee_cup'):
        from hires.msg import ObjectState, WorldState
        message = WorldState()
        message.header.frame_id = 'map'
        message.header.stamp = self.rospy.Time.from_sec(self.stamp - age)
        for name, (x, y, z) in mugs.items():
            one = ObjectState(name=name, model=model)
            one.pose.position.x, one.pose.position.y, one.pose.position.z = x, y, z
            one.pose.orientation.w = 1.0
            message.objects.append(one)
        self.known.publish(message)

    def image(self, heat, frame=CAMERA):
        from sensor_msgs.msg import Image
        HeatReaderTest.stamp += 0.1
        message = Image(height=heat.shape[0], width=heat.shape[1], encoding='mono16',
                        step=2 * heat.shape[1], data=heat.tobytes())
        message.header.stamp = self.rospy.Time.from_sec(self.stamp)
        message.header.frame_id = frame
        return message

    def answer_to(self, message):
        """{object: degrees Celsius}; the picture comes until camera and objects have come, too."""
        def mine():
            return [a for a in self.answers if a.header.stamp == message.header.stamp]

        def told():
            self.images.publish(message)
            with self.changed:
                return self.changed.wait_for(mine, 0.5)
        wait_until(told, lambda: 'an answer\n' + self.node.output())
        return {one.object: round(one.temperature, 1) for one in mine()[-1].objects}

    def say(self, words):
        """The node's diagnostics, once their message has those words."""
        return diagnostics(self.rospy, 'heat_reader', lambda v: words in v['message'])

    def refuse(self, message, words):
        """That it is dropped for that reason, and the next good one is read all the same."""
        before = len(self.answers)
        self.images.publish(message)
        self.say(words)
        self.assertEqual(len(self.answers), before, 'nothing is said of it')

    def require_good(self):
        self.infos.publish(self.info())
        self.know(MUGS)
        self.assertEqual(self.answer_to(self.image(picture('mug2'))), {'mug1': 20.0, 'mug2': 62.5})

    # What there is.

    def test_of_two_mugs_the_hot_one_is_told_whichever_it_is(self):
        self.assertEqual(self.answer_to(self.image(picture('mug2'))), {'mug1': 20.0, 'mug2': 62.5})
        self.assertEqual(self.answer_to(self.image(picture('mug1'))), {'mug1': 62.5, 'mug2': 20.0})
        self.assertIn('tf does not know', self.say('reads')['message'])  # no robot is there

    def test_a_picture_that_comes_too_early_is_left_out(self):
        self.assertEqual(self.answer_to(self.image(picture('mug2'))), {'mug1': 20.0, 'mug2': 62.5})
        early, late = self.image(picture('mug1')), self.image(picture('mug1'))
        early.header.stamp -= self.rospy.Duration.from_sec(0.07)  # 0.03 s after the other
        self.images.publish(early)
        self.answer_to(late)
        self.assertFalse([a for a in self.answers if a.header.stamp == early.header.stamp])

    def test_a_picture_without_known_objects_is_answered_by_none(self):
        self.know({'mug1': (9.0, 9.94, 0.75)})  # behind the camera
        wait_until(lambda: self.answer_to(self.image(picture('mug2'))) == {}, 'an empty answer')

    # What is wrong.

    @long_case
    def test_pictures_that_are_wrong_are_dropped_with_the_reason(self):
        self.require_good()
        def good():
            return self.image(picture('mug2'))
        without_stamp = good()
        without_stamp.header.stamp = self.rospy.Time(0)
        self.refuse(without_stamp, 'header.stamp is 0')
        nowhere = good()
        nowhere.header.frame_id = ''
        self.refuse(nowhere, 'header.frame_id is empty')
        in_colours = good()
        in_colours.encoding = 'rgb8'
        self.refuse(in_colours, "encoding is 'rgb8', wanted mono16")
        other_end = good()
        other_end.is_bigendian = 1
        self.refuse(other_end, 'big-endian')
        self.refuse(self.image(numpy.zeros((0, 0), '<u2')), '0 x 0 pixels')
        short = good()
        short.data = short.data[:-2]
        self.refuse(short, 'data to hold height * step')
        self.refuse(self.image(picture()[:240]), "640 x 240 pixels, its camera_info says 640 x 480")
        self.require_good()

    @long_case
    def test_a_camera_that_is_not_calibrated_is_said(self):
        self.require_good()
        uncalibrated = self.info()
        uncalibrated.P = [0.0] * 12
        self.infos.publish(uncalibrated)
        self.rospy.sleep(0.5)
        self.refuse(self.image(picture('mug2')), 'calibrate the camera')
        aside = self.info()
        aside.P[2] = 400.0
        self.infos.publish(aside)
        self.rospy.sleep(0.5)
        self.refuse(self.image(picture('mug2')), 'the axis in the middle')
        self.require_good()

    def test_objects_of_models_that_nobody_knows_are_said(self):
        self.require_good()
        self.know(MUGS, model='samovar')
        self.rospy.sleep(0.5)
        self.refuse(self.image(picture('mug2')), 'samovar')
        self.require_good()

    def test_old_words_about_objects_are_not_used(self):
        self.require_good()
        self.know(MUGS, age=20.0)
        self.rospy.sleep(0.5)
        before = len(self.answers)
        self.images.publish(self.image(picture('mug2')))
        self.say('older than the picture')
        self.assertEqual(len(self.answers), before)
        self.require_good()

    def test_a_frame_that_tf_does_not_know_is_waited_for(self):
        self.require_good()
        self.images.publish(self.image(picture('mug2'), 'nobodys_camera'))
        self.assertIn('nobodys_camera', self.say('waits for the transform')['message'])
        self.require_good()

    def test_a_picture_older_than_what_is_kept_of_tf_is_dropped(self):
        from tf2_msgs.msg import TFMessage
        self.require_good()
        for second in range(3):
            self.moving.publish(TFMessage([self.transform('old_camera', 5000.0 + second)]))
        self.refuse(self.image(picture('mug2'), 'old_camera'), 'older than what is kept of tf')
        self.require_good()

    def test_who_is_not_heard_does_not_ask_for_pictures(self):
        self.assertEqual(self.listeners_at_rest, [])

    def test_a_camera_info_that_does_not_come_is_waited_for(self):
        """By a node that has only just begun to listen."""
        from sensor_msgs.msg import Image
        node = self.processes.start([executable('heat_reader'), '__name:=second_reader'], self.main)
        self.addCleanup(node.destroy)
        other = self.rospy.Publisher(IMAGE, Image, queue_size=1)
        wait_until(lambda: '/second_reader' in self.main.subscribers('/' + IMAGE),
                   lambda: 'the node\n' + node.output())
        diagnostics(self.rospy, 'second_reader', lambda v: 'waits for' in v['message'])
        other.publish(self.image(picture()))
        diagnostics(self.rospy, 'second_reader', lambda v: INFO in v['message'])


if __name__ == '__main__':
    run_test('heat_reader', HeatReaderTest)
