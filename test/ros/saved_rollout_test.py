#!/usr/bin/env python3
"""A rollout that `hires imagine --save-rollout` wrote: topics, types and frames are complete, and its
numbers are those of the answer. No master is asked. Run alone, or by `rostest hires saved_rollout.test`."""

import json
import os
import subprocess
import sys
import tempfile
import unittest

import rosbag

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from ros_processes import executable  # noqa: E402
from test_run import run_test  # noqa: E402

REQUEST = ['imagine', '--local', '--action', 'move_base_param', '--from',
           'preManipulationAreaEastCounter1', '--object', 'peppermill1', '--arg',
           'preManipulationAreaEastTable2', '--arg', 'fast', '--rollouts', '16', '--seed', '7',
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
        cls.done = run('--save-rollout', 'worst', '--bag', cls.bag, '--csv', cls.csv, '--json', answer)
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
        self.assertIn('ends: object_fell', events[-1])
        self.assertIn(events[-1], self.done.stdout)

    def test_the_table_has_the_same_samples(self):
        with open(self.csv, encoding='utf-8') as file:
            lines = file.read().splitlines()
        self.assertEqual(len(lines) - 1, len(self.of('/rollout/speed')))

    def test_what_cannot_be_is_said_before_anything_is_imagined(self):
        for words, wanted in ((('--save-rollout', 'wurst', '--csv', self.csv), 'wurst'),
                              (('--save-rollout', 'worst'), '--csv FILE or --bag FILE'),
                              (('--save-rollout', 'worst', '--bag', '/no/such/folder/x.bag'),
                               '/no/such/folder')):
            done = run(*words)
            self.assertEqual(done.returncode, 1, done.stdout)
            self.assertEqual(done.stdout, '')
            self.assertIn(wanted, done.stderr)


if __name__ == '__main__':
    run_test('saved_rollout', SavedRolloutTest)
