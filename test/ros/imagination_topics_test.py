#!/usr/bin/env python3
"""What a worker shows under its own master, under the names of a PR2, and what of it crosses to the
main one: run alone, or by `rostest hires imagination_topics.test`."""

import math
import os
import sys
import threading
import unittest

import rosbag
import yaml

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from imagination_system import ImaginationSystem  # noqa: E402
from ros_processes import wait_until  # noqa: E402
from test_run import run_test  # noqa: E402

# What the worker's node publishes under its own master; action topics aside.
PR2_TOPICS = {'/clock', '/tf', '/tf_static', '/joint_states', '/base_odometry/odom'}


class Recorder:
    """All messages of one topic of the master this process belongs to."""

    def __init__(self, rospy, topic, kind):
        self._messages = []
        self._lock = threading.Lock()
        self._subscriber = rospy.Subscriber(topic, kind, self._keep)

    def _keep(self, message):
        with self._lock:
            self._messages.append(message)

    def messages(self):
        with self._lock:
            return list(self._messages)

    def wait_for(self, number):
        wait_until(lambda: len(self.messages()) >= number, '%d messages' % number)
        return self.messages()


def transforms(messages):
    return [transform for message in messages for transform in message.transforms]


class ImaginationTopicsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.system = ImaginationSystem(workers=1)
        cls.addClassCleanup(cls.system.destroy)
        cls.system.start()
        # This process becomes a node of the worker's master, beside the robot.
        os.environ.update(ROS_MASTER_URI='http://127.0.0.1:%d/' % cls.system.worker_port(1),
                          ROS_IP='127.0.0.1', ROS_LOG_DIR=cls.system.processes.folder.name)
        os.environ.pop('ROS_HOSTNAME', None)
        import rospy
        from nav_msgs.msg import Odometry
        from rosgraph_msgs.msg import Clock
        from sensor_msgs.msg import JointState
        from tf2_msgs.msg import TFMessage
        rospy.init_node('imagination_topics_test', disable_signals=True, anonymous=True)
        kinds = {'/clock': Clock, '/tf': TFMessage, '/tf_static': TFMessage,
                 '/joint_states': JointState, '/base_odometry/odom': Odometry}
        cls.rospy = rospy
        cls.recorders = {topic: Recorder(rospy, topic, kind) for topic, kind in kinds.items()}
        cls.idle_clock = cls.recorders['/clock'].wait_for(10)
        # Who starts after the first rollout could not tell what was shown before it.
        answer = cls.system.ask(rollouts=60).answer()
        assert answer.code == 0, answer.output

    def recorded(self, topic, at_least=1):
        return self.recorders[topic].wait_for(at_least)

    def main_topics(self):
        """{topic: [publishers]} under the main master."""
        return self.system.main.publishers()

    # Under the worker's master.

    def test_the_clock_ticks_while_idle_and_never_runs_backwards(self):
        stamps = [message.clock.to_sec() for message in self.idle_clock]
        self.assertEqual(len(set(stamps)), len(stamps))
        all_stamps = [message.clock.to_sec() for message in self.recorded('/clock', 30)]
        self.assertEqual(all_stamps, sorted(all_stamps))
        self.assertGreater(all_stamps[0], 0.0)
        # Rollouts of seconds were played in far less time: the clock is the simulation's.
        self.assertGreater(all_stamps[-1] - all_stamps[0], 60.0)

    def test_the_robot_moves_in_the_frames_of_a_pr2(self):
        pairs = {(t.header.frame_id, t.child_frame_id) for t in transforms(self.recorded('/tf', 5))}
        self.assertEqual(pairs, {('map', 'odom_combined'), ('odom_combined', 'base_footprint')})
        positions = {(round(t.transform.translation.x, 1), round(t.transform.translation.y, 1))
                     for t in transforms(self.recorded('/tf'))
                     if t.child_frame_id == 'base_footprint'}
        self.assertGreater(len(positions), 3, 'the robot stands still')

    def test_every_link_hangs_below_the_base_exactly_once(self):
        links = transforms(self.recorded('/tf_static'))
        parent_of = {link.child_frame_id: link.header.frame_id for link in links}
        self.assertEqual(len(parent_of), len(links))
        self.assertIn('base_laser_link', parent_of)
        self.assertNotIn('base_footprint', parent_of)
        for link in parent_of:
            seen = set()
            while link in parent_of:
                self.assertNotIn(link, seen)
                seen.add(link)
                link = parent_of[link]
            self.assertEqual(link, 'base_footprint')

    def test_odometry_says_what_the_transforms_say(self):
        poses = {t.header.stamp: t.transform for t in transforms(self.recorded('/tf'))
                 if t.child_frame_id == 'base_footprint'}
        compared = 0
        for odometry in self.recorded('/base_odometry/odom', 5):
            self.assertEqual(odometry.header.frame_id, 'odom_combined')
            self.assertEqual(odometry.child_frame_id, 'base_footprint')
            transform = poses.get(odometry.header.stamp)
            if transform is None:
                continue
            compared += 1
            self.assertEqual(odometry.pose.pose.position.x, transform.translation.x)
            self.assertEqual(odometry.pose.pose.orientation.z, transform.rotation.z)
        self.assertGreater(compared, 3)
        speeds = [math.hypot(m.twist.twist.linear.x, m.twist.twist.linear.y)
                  for m in self.recorded('/base_odometry/odom')]
        self.assertGreater(max(speeds), 0.1)
        self.assertLess(max(speeds), 1.0)

    def test_joints_stand_in_the_driving_posture(self):
        first = self.recorded('/joint_states', 5)[0]
        self.assertEqual(len(first.name), len(first.position))
        self.assertIn('torso_lift_joint', first.name)
        for message in self.recorded('/joint_states'):
            self.assertEqual((message.name, message.position), (first.name, first.position))

    def test_stamps_are_on_the_workers_own_clock(self):
        clock = [message.clock.to_sec() for message in self.recorded('/clock')]
        for message in self.recorded('/base_odometry/odom'):
            self.assertTrue(0.0 < message.header.stamp.to_sec() <= clock[-1] + 1.0)

    def test_the_robot_description_is_the_robots_urdf(self):
        text = self.rospy.get_param('/robot_description')
        self.assertTrue(text.lstrip().startswith('<'), text[:80])
        for link in ('base_footprint', 'torso_lift_link'):
            self.assertIn('name="%s"' % link, text)

    # What crosses.

    def test_only_what_carries_the_workers_name_crosses(self):
        mirrored = {topic for topic, nodes in self.main_topics().items()
                    if any(node.startswith('/mirrored/') for node in nodes)}
        self.assertEqual(mirrored, {'/worker_1/markers', '/worker_1/rollout/status',
                                    '/worker_1/rollout/feedback', '/worker_1/rollout/result'})
        self.assertEqual(PR2_TOPICS & set(self.main_topics()), set())

    def test_nothing_of_the_main_master_but_the_actions_ends_crosses_to_the_worker(self):
        _, _, state = self.rospy.get_master().getSystemState()
        mirrored = {topic for topic, nodes in state[0]
                    if any(node.startswith('/mirrored/') for node in nodes)}
        self.assertEqual(mirrored, {'/worker_1/rollout/goal', '/worker_1/rollout/cancel'})

    def test_world_and_ranking_are_latched_under_the_main_master(self):
        for topic, sign in (('/world_markers', 'areas'), ('/imagination_markers', 'ranking')):
            echo = self.system.run(['rostopic', 'echo', '-n', '1', topic])
            self.assertEqual(echo.wait(), 0, echo.output())
            self.assertIn('ns: "%s"' % sign, echo.output())
            self.assertIn('frame_id: "map"', echo.output())
            if sign == 'ranking':
                self.assertIn('premanipulationareasouthtable1', echo.output())

    def imagined_rollout(self, request_id, which):
        """What the service answers."""
        call = self.system.run(['rosservice', 'call', '/imagined_rollout',
                                "{request_id: '%s', which: '%s'}" % (request_id, which)])
        self.assertEqual(call.wait(), 0, call.output())
        return yaml.safe_load(call.output())

    def test_a_rollout_of_the_last_request_is_played_again_bit_by_bit(self):
        first = self.imagined_rollout('', 'worst')
        self.assertTrue(first['success'], first['message'])
        self.assertEqual(first['rollout']['seed'], 7)
        self.assertLess(first['rollout']['index'], 60)
        self.assertEqual(len(first['times']), len(first['events']))
        self.assertIn('action ends', first['events'][-1])  # the worst one failed
        with rosbag.Bag(first['path']) as bag:
            told = [message.data for _, message, _ in bag.read_messages('/rollout/events')]
        self.assertEqual(told, first['events'])
        with open(first['path'], 'rb') as file:
            bits = file.read()
        self.assertEqual(self.imagined_rollout('', 'worst'), first)
        with open(first['path'], 'rb') as file:
            self.assertEqual(file.read(), bits)

    def test_a_rollout_that_is_not_there_is_refused_with_a_word(self):
        for request_id, which, wanted in (('', 'wurst', 'wurst'), ('', '60', '60 were played'),
                                          ('nobodys', 'worst', 'nobodys')):
            answer = self.imagined_rollout(request_id, which)
            self.assertFalse(answer['success'])
            self.assertIn(wanted, answer['message'])

    def test_traces_of_a_rollout_are_shown_to_the_main_master(self):
        echo = self.system.run(['rostopic', 'echo', '-n', '1', '/worker_1/markers'])
        wait_until(lambda: '/worker_1/markers' in dict(self.system.main._call(
            'getSystemState')[1]), 'rostopic to subscribe')
        question = self.system.ask(rollouts=60)
        self.assertEqual(echo.wait(), 0, echo.output())
        self.assertIn('ns: "worker_1', echo.output())
        self.assertEqual(question.answer().code, 0)


if __name__ == '__main__':
    run_test('imagination_topics', ImaginationTopicsTest)
