#!/usr/bin/env python3
"""Tasks drawn at random are done by pictures alone, each in a process of its own that needs no master:
two beside each other. Usage: random_tasks_local_test.py HIRES plain|surprised|off FIRST LAST
`surprised`: beside things that nobody told the robot of (support/surprises.py). `off`: the same, and the
camera sits otherwise than the robot believes, by 5 mm and 5 mrad (test/data/loop). The two scenarios of config/scenarios
are played, too, but for `off`: with surprises they take ten minutes each, most of it imagination. Prints a table.

The ranges that ctest plays are seeds by which faults were found and mended, and how many may be lost was set to
what was found on them then. So it fails where something became worse, and says nothing of how many other tasks
are done: that is what fresh seeds are for (docs/notes_perception.md)."""

import json
import multiprocessing.pool
import os
import re
import subprocess
import sys
import tempfile
import unittest

import yaml

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, 'support'))

from closed_loop import CONFIG, IMAGINE_PLACING  # noqa: E402
from random_tasks import RandomTask  # noqa: E402
from restaurant import FURNITURE, SEATS, is_over  # noqa: E402
from surprises import AT_GOAL, COUNTER, MOVED_CHAIR, ON_COUNTER, surprises  # noqa: E402

CHAIR_AND_CAMERA_OFF = os.path.join(os.path.dirname(MOVED_CHAIR), 'moved_chair_camera_off.yaml')
TRUTHS = {'plain': 'same', 'surprised': MOVED_CHAIR, 'off': CHAIR_AND_CAMERA_OFF}
BESIDE_EACH_OTHER = 2
REACH = 0.02  # [m] beyond the edge of an area
# Where the knowledge says that the robot is to stand there are 16 mm between its base and the legs of
# a table, and it may stop 30 mm off: that its base comes to touch one is said here, and allowed to few.
TOUCHES_A_TABLE = re.compile(r'base_link/\S+ touches table\d+$')
MOST_TOUCHES = 0.1  # of all tasks
# A hand that is 0.09 m open leaves 5 mm on either side of a mug, so where the camera is off by as much
# some are knocked over. A bound against getting worse, no accuracy: 2 of 12 were lost on 2026-11-26, on
# seeds by which faults had been mended, and 4 of 7 of fresh ones.
MOST_LOST = {'plain': 0.0, 'surprised': 0.0, 'off': 0.2}  # of all tasks
ROW = '%-4s %-46s %-10s %8s  %-12s %-34s %s'


class Played:
    """What became of one task, in truth."""

    def __init__(self, task, answer):
        self.task = task
        self.outcome, self.reason = answer['outcome'], answer['reason']
        truth = answer['in_truth']
        self.seconds, self.touched = truth['virtual_seconds'], truth['touched']
        things = truth['objects']
        self.fallen = sorted(name for name, end in things.items() if end['falls'] > 0)
        self.there = sorted(
            name for name, end in things.items() if end['stands'] and
            any(is_over(area, *end['position'], slack=REACH) for area in task.goal_areas))

    def row(self):
        there = 'there: ' + ', '.join(self.there)
        return ROW % (self.task.seed, self.task.task, self.outcome, '%.1f' % self.seconds,
                      ', '.join(self.fallen) or '-', self.touched or '-',
                      '; '.join(filter(None, (there, self.reason))))

    def has_forgiven_touch(self):
        return TOUCHES_A_TABLE.match(self.touched or '') is not None

    def is_good(self):
        return (self.outcome == 'succeeded' and not self.fallen and
                (not self.touched or self.has_forgiven_touch()) and
                self.task.is_done(self.there))


class ShippedTask:
    """A scenario of config/scenarios, with what the test asks of a random task."""
    seed = 1

    def __init__(self, name, goal_areas):
        folder = os.path.join(CONFIG, 'scenarios')
        with open(os.path.join(folder, name + '.yaml')) as file:
            self.given = yaml.safe_load(file)
        self.given['knowledge'] = [os.path.join(folder, path) for path in self.given['knowledge']]
        self.task, self.goal_areas = self.given['task'], goal_areas
        self.objects = {thing['name']: thing['pose'] for thing in self.given['objects']}
        self.hidden = {thing['name']: thing['pose'] for thing in self.given['hidden']}

    def files(self, _):
        return dict(self.given)

    def is_done(self, there):
        return bool(set(there) & set(self.objects))


class DrawnTask(RandomTask):

    def files(self, folder):
        """The scenario, beside its knowledge in a file of its own."""
        path = os.path.join(folder, 'known.yaml')
        with open(path, 'w') as file:
            file.write(self.knowledge(is_exact=False))
        knowledge = [path, IMAGINE_PLACING] if self.is_placing_imagined else [path]
        return dict(self.scenario(), task=self.task, knowledge=knowledge)


def play(task):
    with tempfile.TemporaryDirectory() as folder:
        scenario = task.files(folder)
        words = ['--truth', TRUTHS[VARIANT], '--sensing', 'pictures', '--seed', str(task.seed), '--threads', '1']
        if VARIANT != 'plain':
            scenario['hidden'] = scenario['hidden'] + surprises(task)
        path, end = os.path.join(folder, 'all.yaml'), os.path.join(folder, 'end.json')
        with open(path, 'w') as file:
            yaml.safe_dump(scenario, file)
        done = subprocess.run([PROGRAM, 'achieve', '--local', '--scenario', path, '--json', end, *words],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if not os.path.exists(end):
            raise AssertionError('seed %d, %s: %s' % (task.seed, task.task, done.stdout[-2000:]))
        with open(end) as file:
            return Played(task, json.load(file))


class RandomTasksLocalTest(unittest.TestCase):

    def test_tasks_are_done_and_nothing_falls_or_is_touched(self):
        print(ROW % ('seed', 'task', 'outcome', 'sim. s', 'fallen', 'touched', ''), flush=True)
        lost, num_touches = [], 0
        with multiprocessing.pool.ThreadPool(BESIDE_EACH_OTHER) as pool:
            for played in pool.imap(play, TASKS):
                print(played.row(), flush=True)
                num_touches += played.has_forgiven_touch()
                lost += [] if played.is_good() else [played.row()]
        most = int(MOST_LOST[VARIANT] * len(TASKS))
        print('done: %d of %d; touched a table with the base: %d; judged by at most %d lost, which is a bound against '
              'getting worse on seeds by which faults were mended' %
              (len(TASKS) - len(lost), len(TASKS), num_touches, most), flush=True)
        self.assertLessEqual(len(lost), most, '\n'.join(lost))
        self.assertLessEqual(num_touches, max(1, int(MOST_TOUCHES * len(TASKS))))

    def test_each_task_has_its_surprises(self):
        if VARIANT == 'plain':
            self.skipTest('only where there are surprises')
        with_table = [task for task in TASKS if COUNTER not in task.goal_areas]
        on_table = 0  # where a table has room for one
        for task in TASKS:
            names = [thing['name'] for thing in surprises(task)]
            with self.subTest(seed=task.seed, task=task.task):
                self.assertEqual(names[:len(ON_COUNTER)], [name for name, _ in ON_COUNTER])
                self.assertIn(names[len(ON_COUNTER):], ([], [AT_GOAL[0]]) if task in with_table else ([],))
            on_table += AT_GOAL[0] in names
        print('surprises: all on the counter in %d tasks; on tables in %d of %d' %
              (len(TASKS), on_table, len(with_table)), flush=True)
        self.assertGreaterEqual(2 * on_table, len(with_table))


if __name__ == '__main__':
    if len(sys.argv) != 5 or sys.argv[2] not in TRUTHS:
        sys.exit(__doc__)
    PROGRAM, VARIANT = sys.argv[1:3]
    TASKS = [DrawnTask(seed) for seed in range(int(sys.argv[3]), int(sys.argv[4]) + 1)]
    if VARIANT != 'off':  # first, since they take longest
        TASKS = [ShippedTask('topple', FURNITURE['table1']),
                 ShippedTask('serve_coffee', SEATS['sittingareawesttable1'])] + TASKS
    unittest.main(argv=sys.argv[:1])
