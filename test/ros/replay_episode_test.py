#!/usr/bin/env python3
"""Robot episodes: recorded by the loop, played by rosbag, recorded by the node, imagined again by
`hires replay`. Run alone, or by `rostest hires replay_episode.test`."""

import glob
import json
import os
import signal
import sys
import unittest

import rosbag
import rospy
from std_msgs.msg import String

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from imagination_system import ImaginationSystem  # noqa: E402
from ros_processes import LIMIT, executable, wait_until  # noqa: E402
from test_run import run_test  # noqa: E402

TASK = 'drive_robot preManipulationAreaEastCounter1'
DELAY = 0.01  # [s] of a message, config/loop.yaml
RATE = 20.0   # of rosbag play
NEEDED = ['/tf', '/base_odometry/odom', '/joint_states']


class Recorder:
    """A node episode_recorder that listens to all that is played."""

    def __init__(self, system, name):
        self.folder = system.file(name)
        self.process = system.run([executable('episode_recorder'), '__name:=' + name,
                                   '_folder:=' + self.folder])
        self.name = '/' + name
        self._system = system
        wait_until(lambda: self._listens('/execute_action/result'), name)

    def _listens(self, topic):
        return self.name in dict(self._system.main._call('getSystemState')[1]).get(topic, [])

    def bag(self, ending):
        (path,) = glob.glob(os.path.join(self.folder, '*' + ending))
        return path

    def content(self):
        """What is on disk."""
        content = b''
        for path in glob.glob(os.path.join(self.folder, '*')):
            with open(path, 'rb') as file:
                content += file.read()
        return content

    def has(self, goal_id, messages):
        """What is on disk names the goal twice, in itself and in its result, and has the messages: each
        topic comes on a line of its own, and a short one may overtake all others."""
        content = self.content()
        return content.count(goal_id.encode()) >= 2 and all(data in content for data in messages)


class ReplayEpisodeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.system = ImaginationSystem(workers=1)
        cls.addClassCleanup(cls.system.destroy)
        cls.path, report = cls.system.file('loop.bag'), cls.system.file('report.json')
        loop = cls.system.run([
            executable('hires'), 'achieve', *TASK.split(), '--local', '--imagination', 'off',
            '--record', cls.path, '--json', report])
        code = loop.wait(3 * LIMIT)
        assert code == 0, loop.output()
        with open(report) as file:
            cls.report = json.load(file)
        cls.code, cls.output, cls.replayed = cls.replay(cls.path, '--local')

    @classmethod
    def replay(cls, path, *arguments):
        """Exit code, output and JSON."""
        json_path = cls.system.file('replay.json')
        process = cls.system.run([executable('hires'), 'replay', path, '--rollouts', '6', '--json',
                                  json_path, *arguments])
        code = process.wait(3 * LIMIT)
        if not os.path.exists(json_path):
            return code, process.output(), None
        with open(json_path) as file:
            return code, process.output(), json.load(file)

    def steps(self, replayed):
        (episode,) = replayed['episodes']
        return episode['steps']

    def test_the_loops_bag_gives_the_steps_of_its_report(self):
        self.assertEqual(self.code, 0, self.output)
        done = sorted(self.report['steps'], key=lambda step: step['started'])
        self.assertGreaterEqual(len(done), 2)
        found = self.steps(self.replayed)
        self.assertEqual([(s['action'], s['arguments']) for s in found],
                         [(s['action'], s['arguments']) for s in done])
        for then, now in zip(done, found):
            self.assertAlmostEqual(now['begin'], then['started'] + DELAY, 6)
            self.assertEqual(now['happened'], 'succeeded')
            self.assertEqual(now['imagined']['rollouts'], 6)
            self.assertEqual(len(now['imagined']['durations']), 6)
            # Few rollouts show no surprise: the durations must be near at least.
            self.assertLess(abs(now['duration'] - now['imagined']['duration_mean']),
                            0.2 * now['duration'] + 1.0, now)
        self.assertIn('as imagined', self.output)

    def test_the_bag_holds_the_task_with_its_steps(self):
        with rosbag.Bag(self.path) as bag:
            ((_, result, _),) = bag.read_messages('/achieve/result')
        self.assertEqual([s.action.name for s in result.result.steps],
                         [s['action'] for s in self.report['steps']])

    def test_without_goals_its_motions_are_found(self):
        path = self.rewrite(lambda topic: not topic.startswith('/execute_action'))
        code, output, replayed = self.replay(path, '--local')
        self.assertEqual(code, 0, output)
        motions = self.steps(replayed)
        asked = self.steps(self.replayed)
        (drive,) = [s for s in motions if s['action'] == 'move_base_param']
        (asked_drive,) = [s for s in asked if s['action'] == 'move_base']
        self.assertEqual(drive['arguments'], [*asked_drive['arguments'], 'fast'])
        self.assertLess(abs(drive['duration'] - asked_drive['duration']), 2.0)
        self.assertIn('tuck_arms', [s['action'] for s in motions])
        self.assertIn('/execute_action/goal (hires/ExecuteActionActionGoal)', output)

    def test_a_bag_without_what_is_needed_says_what_to_record(self):
        for topics, text in ((('/tf',), '/tf (tf2_msgs/TFMessage)'),
                             (('/tf', '/joint_states', '/base_odometry/odom'), 'rosbag record')):
            with self.subTest(text=text):
                path = self.rewrite(lambda topic: topic not in topics)
                code, output, _ = self.replay(path, '--local')
                self.assertEqual(code, 1, output)
                self.assertIn(text, output)
        path = self.system.file('other.bag')
        with rosbag.Bag(path, 'w') as bag:
            bag.write('/joint_states', String('not a joint'), rospy.Time(1.0))
        code, output, _ = self.replay(path, '--local')
        self.assertEqual(code, 1, output)
        self.assertIn('/joint_states has messages of type std_msgs/String', output)

    def rewrite(self, keeps):
        path = self.system.file('rewritten.bag')
        with rosbag.Bag(self.path) as old, rosbag.Bag(path, 'w') as new:
            for topic, message, stamp, header in old.read_messages(
                    raw=True, return_connection_header=True):
                if keeps(topic):
                    new.write(topic, message, stamp, raw=True, connection_header=header)
        return path

    def test_what_is_played_is_recorded_and_imagined_by_a_running_client(self):
        self.system.start()
        whole = self.record_what_is_played('whole', signal.SIGINT).bag('.bag')
        code, output, replayed = self.replay(whole)
        self.assertEqual(code, 0, output)
        self.assertEqual(replayed['imagined_by'], 'imagination client')
        self.require_same_steps(replayed, self.replayed)
        _, output, locally = self.replay(whole, '--local')
        self.require_same_steps(replayed, locally)
        for a, b in zip(self.steps(replayed), self.steps(locally)):
            self.assertEqual(a['imagined']['durations'], b['imagined']['durations'])
            self.assertEqual(a['percentile'], b['percentile'])

    def what_must_be_on_disk(self):
        """The id of the last goal, and of all that is needed the last that came a second before its result."""
        with rosbag.Bag(self.path) as bag:
            result, end = [(m.status.goal_id.id, t) for _, m, t
                           in bag.read_messages('/execute_action/result')][-1]
            last = {topic: raw[1] for topic, raw, t in bag.read_messages(NEEDED, raw=True)
                    if t < end - rospy.Duration(1.0)}
        self.assertEqual(sorted(last), sorted(NEEDED))
        return result, last.values()

    def record_what_is_played(self, name, end):
        recorder = Recorder(self.system, name)
        # Kept alive, so that its end cannot overtake what it still has queued, which may be all: at
        # this rate a tenth of a second in which nobody listens is two seconds of the episode.
        player = self.system.run(['rosbag', 'play', '--quiet', '--wait-for-subscribers',
                                  '--keep-alive', '--queue=100000', '-r', str(RATE), self.path])
        last, messages = self.what_must_be_on_disk()
        wait_until(lambda: recorder.has(last, messages), 'the last result to be on disk')
        os.kill(recorder.process.pid, end)
        recorder.process.wait()
        player.destroy()
        return recorder

    def require_same_steps(self, one, other):
        """Messages of one moment are recorded in the order in which they came, which may differ; so
        what was known at the start may differ in its last bits, and with it a rollout's duration."""
        found, known = self.steps(one), self.steps(other)
        self.assertEqual(len(found), len(known))
        for a, b in zip(found, known):
            for key in ('action', 'arguments', 'begin', 'duration', 'happened'):
                self.assertEqual(a[key], b[key])
            self.assertIsNotNone(a['imagined'], a)
            self.assertEqual(a['imagined']['success'], b['imagined']['success'])

    def test_what_came_first_of_a_topic_is_on_disk_at_once(self):
        """Else a kill may cut the description of the topic short, and nothing of the bag can be mended."""
        recorder = Recorder(self.system, 'first')
        goals = self.system.run(['rostopic', 'pub', '-r', '100', '/execute_action/goal',
                                 'hires/ExecuteActionActionGoal', '{goal_id: {id: alone}}'])
        wait_until(lambda: recorder.content().count(b'alone') > 1, 'the goal to be on disk, and another')
        recorder.process.kill()
        goals.destroy()
        path = recorder.bag('.bag.active')
        mend = self.system.run(['rosbag', 'reindex', path])
        self.assertEqual(mend.wait(), 0, mend.output())
        with rosbag.Bag(path) as bag:
            self.assertEqual({m.goal_id.id for _, m, _ in bag.read_messages('/execute_action/goal')}, {'alone'})

    def test_a_recorder_that_is_killed_leaves_a_bag_that_can_be_read(self):
        path = self.record_what_is_played('killed', signal.SIGKILL).bag('.bag.active')
        code, output, replayed = self.replay(path, '--local')
        self.assertEqual(code, 0, output)
        self.assertIn('whole messages are read', output)
        self.assertEqual([s['action'] for s in self.steps(replayed)],
                         [s['action'] for s in self.steps(self.replayed)])


if __name__ == '__main__':
    run_test('replay_episode', ReplayEpisodeTest)
