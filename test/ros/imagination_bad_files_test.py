#!/usr/bin/env python3
"""Files and parameters that make no sense, or do not fit together: nodes stop and say why, workers
that differ are named. Run alone, or by `rostest hires imagination_bad_files.test`."""

import os
import re
import sys
import unittest

import yaml

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from imagination_system import (ACTION, CONFIG_FOLDER, ImaginationSystem,  # noqa: E402
                                read_yaml)
from ros_processes import executable  # noqa: E402
from test_run import run_test  # noqa: E402


class ImaginationBadFilesTest(unittest.TestCase):
    def setUp(self):
        self.system = ImaginationSystem(workers=2)
        self.addCleanup(self.system.destroy)
        self.num_nodes = 0

    # Workers that do not fit.

    def test_workers_with_another_world_or_robot_are_named(self):
        system = self.system
        world = os.path.join(CONFIG_FOLDER, '..', 'worlds', 'restaurant.world')
        with open(world) as file:
            text = file.read()
        # The same but for one number.
        changed = text.replace('<pose>13 11.3 0', '<pose>13 11.4 0')
        self.assertNotEqual(text, changed)
        other = self.copy_of_world(changed)
        system.start_client(worker_wait=0.5)
        system.start_host(1, '_world:=' + other)
        system.start_host(2, '_robot:=' + os.path.join(CONFIG_FOLDER, 'robots', 'cart.yaml'))
        for k in (1, 2):
            system.wait_until_joined(k)
        answer = system.ask().answer()
        self.assertEqual(answer.code, 3, answer.output)
        self.assertEqual(answer.report['ranking'], [])
        self.assertIn('worker 1: world differs: the client has', answer.report['why'])
        self.assertIn('worker 2: robot differs: the client has', answer.report['why'])
        self.assertIn('start both with the same files', answer.report['why'])
        for k in (1, 2):
            self.assertEqual(system.times_joined(k), 1)

    def test_workers_with_other_actions_are_named_with_their_libraries(self):
        system = self.system
        library = os.path.join(os.path.dirname(executable('hires')), 'libown_action.so')
        other = system.file('libother_build.so')
        with open(library, 'rb') as file, open(other, 'wb') as copy:
            copy.write(file.read() + b'another build')
        system.start_client(worker_wait=0.5, arguments=['_action_libraries:=' + library])
        system.start_host(1)
        system.start_host(2, '_action_libraries:=' + other)
        for k in (1, 2):
            system.wait_until_joined(k)
        answer = system.ask().answer()
        self.assertEqual(answer.code, 3, answer.output)
        why = answer.report['why']
        self.assertRegex(why, 'worker 1: actions differ: the client has [0-9a-f]{16}, this worker '
                         '[0-9a-f]{16} with no library')
        self.assertRegex(why, 'worker 2: actions differ: .* with [0-9]+_libother_build.so [0-9a-f]{16}')
        self.assertRegex(why, 'the client loaded libown_action.so [0-9a-f]{16}')

    def test_workers_that_call_something_else_a_fall_are_named(self):
        system = self.system
        other = '_config:=' + self.worker_config(tilt=0.4, hold_time=0.2)
        system.start_client(worker_wait=0.5)
        for k in (1, 2):
            system.start_host(k, other)
        for k in (1, 2):
            system.wait_until_joined(k)
        answer = system.ask().answer()
        self.assertEqual(answer.code, 3, answer.output)
        for k in (1, 2):
            self.assertIn('worker %d: physics (sections physics, rollout, standing of the scene) '
                          'differs: the client has' % k, answer.report['why'])

    def worker_config(self, **standing):
        """Path of a worker's configuration whose scene says so of falls, and is the same elsewhere
        to the letter: hashes are of the text of values."""
        with open(os.path.join(CONFIG_FOLDER, 'scene.yaml')) as file:
            scene = file.read()
        for key in ('world', 'robot', 'objects', 'uncertainty', 'detector', 'obstacle_layer'):
            scene = re.sub(r'(?m)^(%s: )(\S+)' % key, lambda found: found[1] + os.path.normpath(
                os.path.join(CONFIG_FOLDER, found[2])), scene, count=1)
        for key, value in standing.items():
            scene, count = re.subn(r'(?m)^(standing: .*\b%s: )[^,}]+' % key,
                                   lambda found: '%s%g' % (found[1], value), scene)
            self.assertEqual(count, 1, key)
        worker = read_yaml('sim_worker.yaml')
        worker['scene'] = self.system.file('scene.yaml')
        path = self.system.file('sim_worker.yaml')
        with open(worker['scene'], 'w') as file:
            file.write(scene)
        with open(path, 'w') as file:
            yaml.safe_dump(worker, file)
        return path

    def copy_of_world(self, text):
        folder = os.path.join(CONFIG_FOLDER, '..', 'worlds')
        copies = os.path.join(self.system.processes.folder.name, 'worlds')
        os.mkdir(copies)
        for name in os.listdir(folder):
            os.symlink(os.path.join(folder, name), os.path.join(copies, name))
        path = os.path.join(copies, 'other.world')
        with open(path, 'w') as file:
            file.write(text)
        return path

    # Each node stops with exit code 1 and says why, before it does anything.

    def config(self, node):
        """What the node needs to come up, as parameters."""
        return ['_config:=' + os.path.join(CONFIG_FOLDER, node + '.yaml')]

    def require_refusal(self, node, arguments, *texts):
        # Parameters stay at the master: each node has a name of its own.
        self.num_nodes += 1
        process = self.system.run(
            [executable(node), '__name:=%s_%d' % (node, self.num_nodes), *arguments])
        self.assertEqual(process.wait(), 1, process.output())
        for text in texts:
            self.assertIn(text, process.output())

    def test_an_unknown_private_parameter_is_named_with_one_like_it(self):
        for node, typo, wanted in (('imagination_client', 'wrokers', 'workers'),
                                   ('sim_worker', 'uncertanty', 'uncertainty'),
                                   ('relay', 'namspace', 'namespace'),
                                   ('worker_host', 'base_prot', 'base_port')):
            with self.subTest(node=node):
                self.require_refusal(node, [*self.config(node), '_%s:=3' % typo],
                                     "private parameter '%s' is unknown" % typo, "'%s'" % wanted)

    def test_a_private_parameter_out_of_range_or_of_the_wrong_kind(self):
        for node, argument, text in (
                ('imagination_client', '_workers:=0',
                 '~workers is 0, wanted a whole number between 1 and 256'),
                ('imagination_client', '_workers:=many', "~workers is 'many', wanted a whole number"),
                ('sim_worker', '_index:=257',
                 '~index is 257, wanted a whole number between 1 and 256'),
                ('imagination_client', '_localisation:=my pose', '[my pose]'),  # no topic's name
                ('sim_worker', '_world:=3', '~world is 3, wanted text')):
            with self.subTest(argument=argument):
                self.require_refusal(node, [argument], text)

    def test_files_that_are_not_there(self):
        for node in ('imagination_client', 'sim_worker', 'relay', 'worker_host'):
            with self.subTest(node=node):
                self.require_refusal(node, ['_config:=/nowhere/x.yaml'], '/nowhere/x.yaml')
        for key in ('world', 'robot', 'objects', 'uncertainty'):
            for node in ('imagination_client', 'sim_worker'):
                with self.subTest(node=node, key=key):
                    self.require_refusal(node, ['_%s:=/nowhere/%s.yaml' % (key, key)],
                                         '/nowhere/%s.yaml' % key)

    def test_libraries_of_actions_that_are_not_there(self):
        for node in ('imagination_client', 'sim_worker', 'middle_layer', 'world_tracker'):
            with self.subTest(node=node):
                self.require_refusal(node, [*self.config(node), '_action_libraries:=/nowhere/lib.so'],
                                     "library of actions '/nowhere/lib.so'", 'no such file')

    def test_malformed_yaml_is_named_with_its_line(self):
        for node in ('imagination_client', 'sim_worker', 'relay', 'worker_host'):
            with self.subTest(node=node):
                path = self.system.write('bad.yaml', 'scene: scene.yaml\n  index: [1\n')
                self.require_refusal(node, ['_config:=' + path], 'bad.yaml', 'line ')

    def test_a_missing_an_unknown_and_an_unfit_key_are_named(self):
        for node, key, bad in (('imagination_client', 'feedback_period', -1.0),
                               ('sim_worker', 'display_rate', 0.0),
                               ('relay', 'poll_period', 'often'),
                               ('worker_host', 'nice', 77)):
            good = read_yaml(node + '.yaml')
            for path in {'scene', 'prices', 'validated', 'relay_config'} & set(good):
                good[path] = os.path.join(CONFIG_FOLDER, good[path])
            without = {k: v for k, v in good.items() if k != key}
            for change, text in (({key: bad}, '%s is' % key), ({}, key),
                                 ({key: good[key], 'colour': 'red'}, "'colour'")):
                with self.subTest(node=node, change=change):
                    path = self.system.write(node + '.yaml',
                                             yaml.safe_dump({**without, **change}))
                    self.require_refusal(node, ['_config:=' + path], node + '.yaml', text)

    def test_the_command_line_says_what_is_wrong(self):
        for arguments, text in (
                (['imagine'], '--action is required'),
                (['imagine', *ACTION, '--rollouts', '0'], '--rollouts'),
                (['imagine', *ACTION, '--seed', 'x'], '--seed'),
                (['imagine', *ACTION, '--ranking', 'best'], 'best'),
                (['imagine', *ACTION, '--world', '/nowhere.world'],
                 'running nodes are asked about the files that they were started with'),
                (['imagine', *ACTION, '--uncertainty', '/nowhere.yaml'], '/nowhere.yaml'),
                (['imagin'], 'imagin')):
            with self.subTest(arguments=arguments):
                process = self.system.run([executable('hires'), *arguments])
                self.assertEqual(process.wait(), 1, process.output())
                self.assertIn(text, process.output())

    def test_a_clock_that_nobody_publishes_is_said_and_not_waited_for(self):
        self.system.main.set_param('/use_sim_time', True)  # as a simulation that ended leaves it
        for arguments in (['imagine', *ACTION], ['achieve', 'load_tray', '--wait', '1']):
            with self.subTest(arguments=arguments):
                process = self.system.run([executable('hires'), *arguments])
                self.assertEqual(process.wait(), 1, process.output())
                self.assertIn('nobody publishes /clock', process.output())
        self.system.run([executable('planner')]).wait_for('nobody publishes /clock', 60.0)


if __name__ == '__main__':
    run_test('imagination_bad_files', ImaginationBadFilesTest)
