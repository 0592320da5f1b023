#!/usr/bin/env python3
"""A rollout that `hires imagine --save-rollout` wrote: topics, types and frames are complete, and its
numbers are those of the answer. No master is asked. Run alone, or by `rostest hires saved_rollout.test`."""

import json
import os
import subprocess
import sys
import tempfile
import threading
import unittest

import rosbag
import rospy
import yaml
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Float64
from std_msgs.msg import String

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from ros_processes import executable  # noqa: E402
from test_run import run_test  # noqa: E402

PACKAGE = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..')
REQUEST = ['imagine', '--local', '--action', 'move_base_param', '--from',
           'preManipulationAreaEastCounter1', '--object', 'peppermill1', '--arg',
           'preManipulationAreaNorthTable1', '--arg', 'fast', '--rollouts', '16', '--seed', '2',
           '--no-early-stop', '--quiet']
TOPICS = {'/tf': 'tf2_msgs/TFMessage', '/tf_static': 'tf2_msgs/TFMessage',
          '/joint_states': 'sensor_msgs/JointState', '/base_odometry/odom': 'nav_msgs/Odometry',
          '/world_markers': 'visualization_msgs/MarkerArray',
          '/rollout/markers': 'visualization_msgs/MarkerArray', '/rollout/speed': 'std_msgs/Float64',
          '/rollout/acceleration': 'std_msgs/Float64', '/rollout/jerk': 'std_msgs/Float64',
          '/rollout/tilt/peppermill1': 'std_msgs/Float64', '/rollout/events': 'std_msgs/String'}


def run(*more):
    return subprocess.run([executable('hires'), *REQUEST, *more], stdin=subprocess.DEVNULL,
                          capture_output=True, text=True, check=False, timeout=200)


class SavedRolloutTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name
        cls.bag, cls.csv, answer = (os.path.join(folder.name, name)
                                    for name in ('worst.bag', 'worst.csv', 'answer.json'))
        cls.strip = os.path.join(folder.name, 'worst.png')
        cls.done = run('--save-rollout', 'worst', '--bag', cls.bag, '--csv', cls.csv, '--json', answer,
                       '--strip', cls.strip, '--strip-pictures', '2')
        assert os.path.exists(cls.bag), cls.done.stdout + cls.done.stderr
        with open(answer, encoding='utf-8') as file:
            cls.prediction = json.load(file)['ranking'][0]
        with rosbag.Bag(cls.bag) as bag:
            cls.types = {topic: info.msg_type
                         for topic, info in bag.get_type_and_topic_info().topics.items()}
            cls.messages = [(topic, message, time.to_sec()) for topic, message, time in
                            bag.read_messages()]

    def of(self, topic):
        return [(message, time) for name, message, time in self.messages if name == topic]

    def test_every_topic_is_there_with_its_type(self):
        self.assertEqual(self.types, TOPICS)

    def test_every_link_hangs_on_the_map(self):
        parents = {transform.child_frame_id: transform.header.frame_id
                   for topic in ('/tf', '/tf_static') for message, _ in self.of(topic)
                   for transform in message.transforms}
        for child in parents:
            seen = set()
            while child in parents and child not in seen:
                seen.add(child)
                child = parents[child]
            self.assertEqual(child, 'map')
        for link in ('base_footprint', 'base_link', 'r_gripper_palm_link', 'head_tilt_link'):
            self.assertIn(link, parents)

    def test_markers_stand_in_frames_that_are_there(self):
        frames = {marker.header.frame_id for topic in ('/rollout/markers', '/world_markers')
                  for message, _ in self.of(topic) for marker in message.markers}
        self.assertEqual(frames, {'map'})

    def test_its_largest_tilt_and_its_failure_are_those_of_the_answer(self):
        tilts = [message.data for message, _ in self.of('/rollout/tilt/peppermill1')]
        self.assertIn('object_fell', [entry['failure'] for entry in self.prediction['failures']])
        self.assertGreater(max(tilts), 1.0)
        events = [message.data for message, _ in self.of('/rollout/events')]
        story = '; '.join(events)
        for happened in ('begins to tip', 'lifts off', 'falls', 'failed: object_fell'):
            self.assertIn('peppermill1 ' + happened if happened != 'failed: object_fell' else happened, story)
        for event in events:
            self.assertIn(event, self.done.stdout)

    def test_what_happens_stands_above_the_robot(self):
        shown = {marker.text for message, _ in self.of('/rollout/markers')
                 for marker in message.markers if marker.ns == 'events'}
        self.assertTrue(any('begins to tip' in text for text in shown), shown)

    def test_files_get_their_names_when_they_are_complete(self):
        self.assertEqual(sorted(os.listdir(self.folder)),
                         ['answer.json', 'worst.bag', 'worst.csv', 'worst.png'])
        with open(self.strip, 'rb') as file:
            self.assertEqual(file.read(8), b'\x89PNG\r\n\x1a\n')

    def test_the_table_has_the_same_samples_at_the_same_times(self):
        with open(self.csv, encoding='utf-8') as file:
            lines = file.read().splitlines()
        speeds = self.of('/rollout/speed')
        self.assertEqual(len(lines) - 1, len(speeds))
        for line, (message, time) in zip(lines[1:], speeds):
            self.assertAlmostEqual(float(line.split(',')[0]), time, places=3)
            self.assertAlmostEqual(float(line.split(',')[10]), message.data, places=4)

    def test_what_cannot_be_is_said_before_anything_is_imagined(self):
        for words, wanted in ((('--save-rollout', 'wurst', '--csv', self.csv), 'wurst'),
                              (('--save-rollout', 'worst'), '--csv FILE or --bag '),
                              (('--save-rollout', 'worst', '--bag', '/no/such/folder/x.bag'),
                               '/no/such/folder'),
                              (('--save-rollout', 'worst', '--gif', '/no/such/folder/x.gif'),
                               '/no/such/folder'),
                              (('--save-rollout', 'worst', '--gif', 'x.gif', '--beside', 'x'), "'x'"),
                              (('--strip', self.strip), '--save-rollout')):
            done = run(*words)
            self.assertEqual(done.returncode, 1, done.stdout)
            self.assertEqual(done.stdout, '')
            self.assertIn(wanted, done.stderr)

    def parents(self):
        return {transform.child_frame_id: transform.header.frame_id for topic in ('/tf', '/tf_static')
                for message, _ in self.of(topic) for transform in message.transforms}

    def test_what_the_configuration_of_rviz_shows_is_in_the_bag(self):
        with open(os.path.join(PACKAGE, 'config', 'rollout.rviz'), encoding='utf-8') as file:
            manager = yaml.safe_load(file)['Visualization Manager']
        types = {'rviz/MarkerArray': 'visualization_msgs/MarkerArray', 'rviz/Odometry': 'nav_msgs/Odometry'}
        shown = {display.get('Marker Topic', display.get('Topic')): types[display['Class']]
                 for display in manager['Displays'] if display['Class'] in types}
        self.assertIn('/rollout/markers', shown)
        for topic, name in shown.items():
            self.assertEqual(self.types.get(topic), name, topic)
        frames = set(self.parents()) | set(self.parents().values())
        self.assertIn(manager['Global Options']['Fixed Frame'], frames)
        self.assertIn(manager['Views']['Current']['Target Frame'], frames)

    def test_watch_refuses_what_is_no_rollout(self):
        other = os.path.join(self.folder, 'other.bag')
        self.addCleanup(os.remove, other)
        with rosbag.Bag(other, 'w') as bag:
            bag.write('/chatter', String('hello'), rospy.Time(1))
        for bag, wanted in ((other, '/rollout/markers'), ('no_such.bag', 'no_such.bag'),
                            (self.csv, 'is no ROS bag')):
            done = subprocess.run([executable('hires'), 'watch', bag, '--no-rviz'], check=False,
                                  stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60)
            self.assertEqual(done.returncode, 1, done.stdout)
            self.assertIn(wanted, done.stderr)

    def test_watch_shows_how_things_are_where_one_seeks(self):
        with subprocess.Popen([executable('hires'), 'watch', self.bag, '--no-rviz', '--paused'],
                              stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as watch:
            self.addCleanup(lambda: watch.poll() is None and watch.kill())
            line = watch.stdout.readline()
            self.assertTrue(line.startswith('ROS_MASTER_URI=http://localhost:'), line)
            os.environ['ROS_MASTER_URI'] = line.strip().split('=')[1]
            speeds = self.of('/rollout/speed')
            times = [time for _, _, time in self.messages]
            middle = times[0] + 0.5 * (times[-1] - times[0])
            self.expect_speed(watch, '', speeds[0][0].data, times[0])
            at_middle = [message.data for message, time in speeds if time <= middle][-1]
            self.expect_speed(watch, '5', at_middle, middle)
            self.expect_speed(watch, '0', speeds[0][0].data, times[0])
            watch.stdin.write('q')
            watch.stdin.flush()
            self.assertEqual(watch.wait(60), 0)

    def expect_speed(self, watch, key, speed, position):
        """Once the key is typed, the clock stands there, and the speed is what it was then."""
        if not rospy.core.is_initialized():
            rospy.init_node('looks_on', anonymous=True, disable_signals=True)
        seen = {}
        is_there = threading.Event()

        def on_message(message, topic):
            seen[topic] = message
            clock = seen.get('/clock')
            if (clock and abs(clock.clock.to_sec() - position) < 1e-6 and '/rollout/speed' in seen and
                    seen['/rollout/speed'].data == speed):
                is_there.set()

        subscribers = [rospy.Subscriber(topic, kind, on_message, callback_args=topic)
                       for topic, kind in (('/clock', Clock), ('/rollout/speed', Float64))]
        watch.stdin.write(key)
        watch.stdin.flush()
        self.assertTrue(is_there.wait(60), seen)
        for subscriber in subscribers:
            subscriber.unregister()


if __name__ == '__main__':
    run_test('saved_rollout', SavedRolloutTest)
