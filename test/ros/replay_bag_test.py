#!/usr/bin/env python3
"""Bags of a real imagination, imagined again: `hires replay` and `rosbag play`. Run alone, or by
`rostest hires replay_bag.test`."""

import copy
import io
import json
import os
import struct
import sys
import unittest

import rosbag
import rospy
from actionlib_msgs.msg import GoalStatusArray
from hires.msg import (ActionTemplate, Atom, ImagineActionGoal, ImagineActionResult, ImagineGoal,
                       ImagineResult, StringList)

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from imagination_system import ImaginationSystem  # noqa: E402
from ros_processes import LIMIT, executable, wait_until  # noqa: E402
from test_run import long_case, run_test  # noqa: E402

SOUTH, NORTH = 'preManipulationAreaSouthTable1', 'preManipulationAreaNorthTable1'
COMPLETE = ('one_way', 'two_ways', 'refused')  # requests whose answers must repeat themselves


def goal_of(request_id, areas, **changes):
    goal = ImagineGoal(
        steps=[ActionTemplate('move_base_blind', [StringList(areas)])],
        updated_fluents=[Atom('RobotAt', ['preManipulationAreaEastCounter1']),
                         Atom('On', ['peppermill1', 'trayArea1'])],
        rollouts=8, min_success=0.3, seed=7, request_id=request_id)
    for name, value in changes.items():
        setattr(goal, name, value)
    return ImagineActionGoal(goal=goal)


def content_of(result):
    """Every bit of a result but its wall time."""
    result = copy.deepcopy(result)
    result.wall_seconds = 0.0
    out = io.BytesIO()
    result.serialize(out)
    return out.getvalue()


class Recording:
    """Goals sent to a running client one after the other, recorded by `rosbag record`."""

    def __init__(self, system, num_goals):
        self.path = system.file('imagine.bag')
        self.results = {}
        self._system = system
        self._goals = rospy.Publisher('/imagine/goal', ImagineActionGoal, queue_size=10)
        self._answers = rospy.Subscriber('/imagine/result', ImagineActionResult, self._take)
        # It ends by itself when it has them all: stopped by a signal, it could miss the last one.
        self._recorder = system.run(['rosbag', 'record', '--output-name=' + self.path,
                                     '--limit=%d' % num_goals, '/imagine/goal', '/imagine/result'])
        wait_until(lambda: self._goals.get_num_connections() == 2, 'client and recorder')
        wait_until(lambda: len(self._subscribers('/imagine/result')) == 2, 'who hears results')

    def _subscribers(self, topic):
        return dict(self._system.main._call('getSystemState')[1]).get(topic, [])

    def _take(self, message):
        self.results[message.status.goal_id.id] = message.result

    def ask(self, message):
        message.goal_id.id = 'goal_' + message.goal.request_id
        self._goals.publish(message)
        wait_until(lambda: message.goal_id.id in self.results, 'a result', 3 * LIMIT)

    def finish(self):
        self._recorder.wait()
        self._answers.unregister()  # what comes later is not of the recording
        return self.path


class ReplayBagTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.system = ImaginationSystem(workers=1)
        cls.addClassCleanup(cls.system.destroy)
        # [s] How long the server remembers a goal after its end; actionlib's own is 5.
        cls.system.main.set_param('/imagine/status_list_timeout', 0.5)
        cls.system.start()
        os.environ['ROS_MASTER_URI'] = cls.system.main.uri
        rospy.init_node('replay_bag_test', disable_signals=True)
        recording = Recording(cls.system, num_goals=4)
        recording.ask(goal_of('one_way', [SOUTH]))
        recording.ask(goal_of('two_ways', [SOUTH, NORTH], play_all=True,
                              deadline=rospy.Duration(500.0)))
        recording.ask(goal_of('refused', ['preManipulationAreaSouthTabel1']))
        recording.ask(goal_of('late', [SOUTH, NORTH], deadline=rospy.Duration(0.001)))
        cls.results = recording.results
        cls.path = recording.finish()

    def replay(self, *arguments, path=None, master=None):
        """Exit code, output and JSON by request id."""
        json_path = self.system.file('replay.json')
        process = self.system.processes.start(
            [executable('hires'), 'replay', path or self.path, '--json', json_path, *arguments],
            master or self.system.main)
        code = process.wait(3 * LIMIT)
        if not os.path.exists(json_path):
            return code, process.output(), {}
        with open(json_path) as file:
            return code, process.output(), {r['request_id']: r for r in json.load(file)}

    def rewrite(self, change):
        """A copy of the bag; change(message) may change goals and results."""
        path = self.system.file('changed.bag')
        with rosbag.Bag(self.path) as old, rosbag.Bag(path, 'w') as new:
            for topic, message, stamp in old.read_messages():
                change(message)
                new.write(topic, message, stamp)
        return path

    def require_all_identical(self, code, output, replayed):
        self.assertEqual(code, 0, output)
        self.assertEqual(set(replayed), {*COMPLETE, 'late'})
        for request in COMPLETE:
            self.assertTrue(replayed[request]['identical'], output)
            self.assertEqual(replayed[request]['differences'], [])
            self.assertFalse(replayed[request]['depended_on_moment'])
            then, now = dict(replayed[request]['then']), dict(replayed[request]['now'])
            for answer in (then, now):
                answer.pop('wall_seconds', None)
                answer.pop('real_time_factor', None)
            self.assertEqual(then, now)
        self.assertTrue(replayed['late']['depended_on_moment'])
        self.assertEqual(replayed['late']['outcome_then'], 'nothing_finished')

    def test_the_recorded_answers_say_something(self):
        self.assertEqual(self.results['goal_one_way'].outcome, ImagineResult.RANKED)
        two = self.results['goal_two_ways']
        self.assertEqual([p.rollouts for p in two.predictions], [8, 8])
        self.assertNotEqual(two.predictions[0].duration_mean, two.predictions[1].duration_mean)
        self.assertGreater(self.results['goal_one_way'].predictions[0].duration_sd, 0.0)
        self.assertEqual(self.results['goal_refused'].outcome, ImagineResult.INVALID)

    def test_the_running_client_gives_the_same_bits_again(self):
        self.require_all_identical(*self.replay())

    def test_this_process_gives_the_same_bits_with_any_number_of_threads(self):
        for threads in ('1', '2'):
            with self.subTest(threads=threads):
                self.require_all_identical(*self.replay('--local', '--threads', threads))

    @long_case
    def test_another_seed_differs(self):
        def change(message):
            if message._type.endswith('Goal') and message.goal.request_id == 'one_way':
                message.goal.seed = 8
        path = self.rewrite(change)
        for way in ((), ('--local',)):
            with self.subTest(way=way):
                code, output, replayed = self.replay(*way, path=path)
                self.assertEqual(code, 2, output)
                self.assertFalse(replayed['one_way']['identical'])
                self.assertTrue(replayed['two_ways']['identical'])
                self.assertIn('seed: 7 then, 8 now', output)
                self.assertIn('place 1, duration_mean: ', output)

    def test_a_tampered_bit_is_found_and_named(self):
        def change(message):
            if message._type.endswith('Result') and message.result.predictions:
                prediction = message.result.predictions[0]
                bits = struct.unpack('<q', struct.pack('<d', prediction.max_tilt_p95))[0] ^ 1
                prediction.max_tilt_p95 = struct.unpack('<d', struct.pack('<q', bits))[0]
        code, output, replayed = self.replay('--local', path=self.rewrite(change))
        self.assertEqual(code, 2, output)
        for request in ('one_way', 'two_ways'):
            (line,) = replayed[request]['differences']
            self.assertRegex(line, '^place 1, max_tilt_p95: .* then, .* now$')
        self.assertTrue(replayed['refused']['identical'])

    def test_a_tampered_recommendation_is_found(self):
        def change(message):
            if message._type.endswith('Result') and len(message.result.predictions) == 2:
                message.result.predictions.reverse()
        code, output, replayed = self.replay('--local', path=self.rewrite(change))
        self.assertEqual(code, 2, output)
        self.assertIn('place 1, action: move_base_blind(', output)
        self.assertTrue(replayed['one_way']['identical'])

    def test_a_bag_without_index_is_read_and_is_told_of(self):
        path = self.system.file('unindexed.bag')
        with open(self.path, 'rb') as file:
            content = bytearray(file.read())
        at = content.index(b'index_pos=') + len(b'index_pos=')
        index = struct.unpack('<q', content[at:at + 8])[0]
        content[at:at + 8] = bytes(8)
        with open(path, 'wb') as file:
            file.write(content[:index])
        code, output, replayed = self.replay('--local', path=path)
        self.assertIn(path + ' (format 2.0): has no index', output)
        self.require_all_identical(code, output, replayed)

    def test_bad_input_gives_exit_code_one_and_says_why(self):
        def drop_results(topic):
            path = self.system.file('dropped.bag')
            with rosbag.Bag(self.path) as old, rosbag.Bag(path, 'w') as new:
                for name, message, stamp in old.read_messages():
                    if name != topic:
                        new.write(name, message, stamp)
            return path
        for path, arguments, text in (
                ('/nowhere.bag', [], '/nowhere.bag: no such bag'),
                (self.path, ['--topic', '/imagin'], "action '/imagin' is unknown"),
                (drop_results('/imagine/goal'), [], '/imagine/result (hires/ImagineActionResult)'),
                (drop_results('/imagine/result'), [], 'goal goal_one_way of /imagine'),
                (self.path, ['--threads', '2'], '--local')):
            with self.subTest(text=text):
                code, output, _ = self.replay(*arguments, path=path)
                self.assertEqual(code, 1, output)
                self.assertIn(text, output)

    def test_without_a_master_the_message_names_the_way_out(self):
        other = self.system.processes.master()
        other.kill()
        code, output, _ = self.replay(master=other)
        self.assertEqual(code, 1, output)
        self.assertIn('no ROS master answers at ' + other.uri, output)
        self.assertIn('--local', output)

    def play(self, *arguments):
        """`rosbag play` of the recording; the results that came on /imagine/result meanwhile."""
        results = {}
        subscriber = rospy.Subscriber(
            '/imagine/result', ImagineActionResult,
            lambda message: results.setdefault(message.status.goal_id.id, message.result))
        self.addCleanup(subscriber.unregister)
        wait_until(lambda: subscriber.get_num_connections() == 1, 'the client')
        # Kept alive, so that its end cannot overtake what it still has queued.
        player = self.system.run(['rosbag', 'play', '--quiet', '--immediate', '--keep-alive',
                                  '--wait-for-subscribers', self.path, *arguments])
        wait_until(lambda: set(results) >= set(self.results), 'results', 3 * LIMIT)
        player.destroy()
        return results

    def require_same_results(self, results):
        for request in COMPLETE:
            self.assertEqual(content_of(results['goal_' + request]),
                             content_of(self.results['goal_' + request]))

    def wait_until_forgotten(self):
        """An action server ignores a goal id that its status list still holds."""
        status = {}
        subscriber = rospy.Subscriber(
            '/imagine/status', GoalStatusArray,
            lambda message: status.update(ids={s.goal_id.id for s in message.status_list}))
        wait_until(lambda: 'ids' in status and not status['ids'] & set(self.results),
                   'old goals to leave the status list')
        subscriber.unregister()

    @long_case
    def test_rosbag_play_of_the_goals_alone_drives_a_running_client(self):
        self.wait_until_forgotten()
        self.require_same_results(self.play('--topics', '/imagine/goal'))

    @long_case
    def test_rosbag_play_of_everything_needs_the_old_results_out_of_the_way(self):
        self.wait_until_forgotten()
        old = {}
        subscriber = rospy.Subscriber(
            '/then/imagine/result', ImagineActionResult,
            lambda message: old.setdefault(message.status.goal_id.id, message.result))
        self.addCleanup(subscriber.unregister)
        new = self.play('/imagine/result:=/then/imagine/result')
        self.require_same_results(new)
        self.assertEqual(set(old), set(self.results))
        self.assertEqual(content_of(new['goal_two_ways']), content_of(old['goal_two_ways']))


if __name__ == '__main__':
    run_test('replay_bag', ReplayBagTest)
