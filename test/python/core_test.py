"""hires.core imagines what `hires imagine --local` does, and tells Python what is wrong. Usage: core_test.py HIRES"""

import json
import os
import subprocess
import sys
import tempfile
import threading
import unittest
from _thread import interrupt_main

import numpy
from hires import core

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..'))
WORLD = os.path.join(ROOT, 'worlds', 'workshop.world')
CART = os.path.join(ROOT, 'config', 'robots', 'cart.yaml')
START = {'robot_at': 'dock', 'on_tray': ['peppermill1']}
MEASURED = ('wall_seconds', 'real_time_factor')  # and not the same twice
MANY = 7  # threads, more than Python itself has


def imagine_on_command_line(*options):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, 'answer.json')
        done = subprocess.run([HIRES, 'imagine', '--local', '--quiet', '--world', WORLD, '--json', path,
                               *options], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
        if not os.path.exists(path):
            return done.stderr
        with open(path, encoding='utf-8') as file:
            return without_measured(json.load(file))


def without_measured(answer):
    """Nor how it came about, which only a program knows that was called by a command."""
    return {name: value for name, value in answer.items() if name not in (*MEASURED, 'report')}


class CoreTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scene = core.Scene(world=WORLD)
        cls.answer = cls.scene.imagine('move_base_param', 'atBench', ['slow', 'fast'], rollouts=8, seed=7,
                                       threads=2, **START)

    def test_the_answer_is_that_of_the_command_line_to_the_last_bit(self):
        told = imagine_on_command_line('--from', 'dock', '--object', 'peppermill1', '--action',
                                       'move_base_param', '--arg', 'atBench', '--arg', 'slow,fast',
                                       '--rollouts', '8', '--seed', '7', '--threads', '1')
        self.assertEqual(without_measured(json.loads(self.answer.json())), told)

    def test_an_answer_has_what_its_json_has(self):
        told = json.loads(self.answer.json())
        self.assertEqual(self.answer.outcome, told['outcome'])
        self.assertIsNotNone(told['by_cost'], 'the default is cost')
        self.assertEqual(self.answer.recommended.arguments,
                         tuple(told['ranking'][told['recommended']]['arguments']))
        for way, ranked in zip(self.answer.ranking, told['ranking']):
            self.assertEqual(way.success, ranked['success']['share'])
            self.assertEqual(repr(way), 'Alternative(move_base_param(%s): success %.3f of 8 rollouts)' % (
                ', '.join(way.arguments), way.success))
            self.assertEqual(way.interval, (ranked['success']['lower'], ranked['success']['upper']))
            self.assertEqual(way.confidence, ranked['confidence']['pooled'])
            self.assertEqual(way.tilt, (ranked['max_tilt']['p50'], ranked['max_tilt']['p95']))
            self.assertEqual(sum(way.failures.values()), sum(f['count'] for f in ranked['failures']))
            self.assertIsInstance(way.durations, numpy.ndarray)
            self.assertAlmostEqual(way.durations.mean(), ranked['duration']['mean'], places=9)

    def test_a_recording_is_one_of_the_rollouts_that_were_imagined(self):
        way = self.answer.ranking[0]
        recording = self.scene.record('move_base_param', *way.arguments, rollout=3, seed=7, **START)
        self.assertIn(recording.duration, way.durations)
        n = len(recording.time)
        self.assertTrue(numpy.allclose(numpy.diff(recording.time), 0.05))
        self.assertEqual([recording.position.shape, recording.orientation.shape, recording.velocity.shape,
                          recording.acceleration.shape], [(n, 3), (n, 4), (n, 3), (n, 3)])
        self.assertTrue(numpy.allclose(numpy.linalg.norm(recording.orientation, axis=1), 1.0))
        self.assertEqual(recording.objects['peppermill1'].shape, (n, 3))
        # What it drove is what its velocities add up to; 20 Hz samples of at most 0.55 m/s.
        path = numpy.linalg.norm(numpy.diff(recording.position[:, :2], axis=0), axis=1).sum()
        speed = numpy.hypot(recording.velocity[:, 0], recording.velocity[:, 1])
        self.assertAlmostEqual(path, 0.05 * speed.sum(), delta=0.05 * path)
        self.assertEqual(recording.succeeded, recording.failure == '')

    def test_another_speed_can_be_tried(self):
        scene = core.Scene(world=WORLD, robot=CART)
        scene.add_motion_set('crawl', speed=0.1, acceleration=0.5)
        self.assertEqual(scene.motion_sets['crawl'], (0.1, 0.5))
        answer = scene.imagine('move_base_param', 'atBench', ['crawl', 'slow'], rollouts=2, **START)
        ways = {way.arguments[1]: way for way in answer.ranking}
        self.assertGreater(ways['crawl'].duration, 1.5 * ways['slow'].duration)

    def test_bad_input_is_an_exception_with_the_message_of_the_command_line(self):
        with self.assertRaises(core.ConfigError) as caught:
            self.scene.imagine('move_base_param', 'atBensh', 'slow', robot_at='dock')
        told = imagine_on_command_line('--from', 'dock', '--action', 'move_base_param', '--arg', 'atBensh',
                                       '--arg', 'slow')
        self.assertEqual('hires: %s\n' % caught.exception, told)
        self.assertIsInstance(caught.exception, ValueError)

    def test_each_bad_argument_is_named(self):
        for words, arguments in (('no fact', {'facts': ['On mug1']}), ('threads is -1', {'threads': -1}),
                                 ('rollouts', {'rollouts': -3}), ('ranking', {'ranking': 'best'}),
                                 ('mugg', {'on_tray': ['mugg']})):
            with self.subTest(words), self.assertRaisesRegex(core.ConfigError, words):
                self.scene.imagine('move_base_param', 'atBench', 'slow', **{**START, **arguments})
        with self.assertRaisesRegex(core.ConfigError, 'rollout is -1'):
            self.scene.record('move_base_param', 'atBench', 'slow', rollout=-1, **START)
        for words, arguments in (('speed is 9', {'speed': 9.0, 'acceleration': 1.0}),
                                 ('acceleration is nan', {'speed': 0.1, 'acceleration': float('nan')})):
            with self.subTest(words), self.assertRaisesRegex(core.ConfigError, words):
                self.scene.add_motion_set('new', **arguments)
        with self.assertRaisesRegex(core.ConfigError, "'Slow' is there already"):
            self.scene.add_motion_set('Slow', speed=0.1, acceleration=0.1)
        with self.assertRaisesRegex(core.ConfigError, 'nowhere.world'):
            core.Scene(world='nowhere.world')
        with self.assertRaisesRegex(core.ConfigError, 'world and map'):
            core.Scene(world=WORLD, map='a.yaml')

    def test_an_argument_of_a_wrong_type_is_named_with_what_came_and_what_was_wanted(self):
        def told(call, *words, **arguments):
            with self.assertRaises(TypeError) as caught:
                call(*words, **arguments)
            return str(caught.exception)
        way = ('move_base_param', 'atBench', 'slow')
        for argument, value, message in (
                ('rollouts', '8', "imagine: rollouts is '8' (str), wanted a whole number of at most 2147483647"),
                ('rollouts', 2.5, 'imagine: rollouts is 2.5 (float), wanted a whole number of at most 2147483647'),
                ('seed', -1, 'imagine: seed is -1 (int), wanted a whole number from 0 on'),
                ('deadline', 'soon', "imagine: deadline is 'soon' (str), wanted a number"),
                ('on_tray', 'mug1', "imagine: on_tray is 'mug1' (str), wanted a list of texts"),
                ('facts', None, 'imagine: facts is None (NoneType), wanted a list of texts'),
                ('robot_at', None, 'imagine: robot_at is None (NoneType), wanted a text'),
                ('put', {'mug1': (1, 2)}, "imagine: put is {'mug1': (1, 2)} (dict), wanted {object: (x, y, z, yaw)}"),
                ('rolouts', 8, "imagine: argument 'rolouts' is unknown; did you mean 'rollouts'?")):
            with self.subTest(message):
                self.assertEqual(told(self.scene.imagine, *way, **{**START, argument: value}), message)
        self.assertEqual(told(self.scene.imagine, 'move_base_param', 'atBench', 3, **START),
                         'imagine: argument 3 is 3 (int), wanted a text, or a list of texts to choose from')
        self.assertEqual(told(self.scene.record, 'move_base_param', 'atBench', ['slow'], **START),
                         "record: argument 3 is ['slow'] (list), wanted a text")
        self.assertEqual(told(self.scene.add_motion_set, 'new', speed='fast', acceleration=1.0),
                         "add_motion_set: speed is 'fast' (str), wanted a number")
        self.assertEqual(told(core.Scene, world=WORLD, objects='vase.sdf'),
                         "Scene: objects is 'vase.sdf' (str), wanted a list of texts")
        self.assertIn('imagine(self: hires.core.Scene, action: str', core.Scene.imagine.__doc__)

    def test_own_objects_and_areas_are_named_by_their_files_as_on_the_command_line(self):
        with tempfile.TemporaryDirectory() as folder:
            parcel, goals = os.path.join(folder, 'parcel.yaml'), os.path.join(folder, 'goals.yaml')
            with open(parcel, 'w') as file:
                file.write('shape: box\ndepth: 0.1\nwidth: 0.1\nheight: 0.1\nmass: 0.5\n')
            with open(goals, 'w') as file:
                file.write('spot: [1.0, 1.0, 0.5]\n')
            scene = core.Scene(world=WORLD, areas=goals)
            self.assertIn('spot', scene.areas)
            scene.add_motion_set('crawl', speed=0.1, acceleration=0.5)
            way = ['move_base_param', 'atBench', 'crawl']
            by_file = scene.imagine(*way, robot_at='dock', on_tray=[parcel], rollouts=2, threads=1)
            self.assertIn('parcel', scene.objects)
            by_name = scene.imagine(*way, robot_at='dock', on_tray=['parcel'], rollouts=2, threads=1)
            self.assertEqual(by_file.ranking[0].durations.tolist(), by_name.ranking[0].durations.tolist())
            missing = os.path.join(folder, 'none.yaml')
            with self.assertRaisesRegex(core.ConfigError, 'none.yaml'):
                scene.imagine(*way, robot_at='dock', on_tray=[missing])

    def test_other_threads_of_python_run_meanwhile_and_may_interrupt(self):
        def interrupt():
            # Until the rollouts' own threads are there; without the interpreter's lock it could not look.
            while len(os.listdir('/proc/self/task')) <= MANY:
                pass
            interrupt_main()

        threading.Thread(target=interrupt, daemon=True).start()
        with self.assertRaises(KeyboardInterrupt):
            self.scene.imagine('move_base_param', 'atBench', 'slow', rollouts=100000, early_stop=False,
                               threads=MANY, **START)


if __name__ == '__main__':
    HIRES = sys.argv.pop(1)
    unittest.main()
