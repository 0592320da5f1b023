#!/usr/bin/env python3
"""The running graph in lockstep with its robot, and the loop in one process and virtual time, do the
same task step by step. Run alone, or by `rostest hires loop_identity.test`.

Compared are outcome, repairs, the steps with their order, arguments, phases and failures, and what
was imagined, asked for and recommended: these are equal. Durations of steps, and the pauses between
them, are in the robot's time, and equal up to one tick (0.05 s) at which skills look: a step
begins in the loop 0.03 s after its reason, and in the graph as soon as messages have gone from node
to node and through the Blackboard, which takes the computer's time. With another tick the robot
draws other noise, so poses are not compared to the bit; nor is how long an imagination took."""

import json
import os
import sys

import yaml

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from closed_loop import RESTAURANT, scenario_of  # noqa: E402
from loop_case import AT_COUNTER, MUG, LoopCase  # noqa: E402
from ros_processes import executable  # noqa: E402
from test_run import run_test  # noqa: E402

TICK = 0.05  # [s] of the robot's time
PACE = 2.0   # the robot's time to the computer's: a tick is longer than all messages of a decision
LIMIT = 560.0  # [s] by the wall's clock: it ends a broken test, and measures nothing
DURATIONS = TICK  # [s] by which a step may last longer or shorter
PAUSES = TICK     # [s] likewise, from the end of a step to the next beginning

LOAD = 'load_tray mug1 counter1'


def steps_of(report):
    """Without those that only ask imagination."""
    return [s for s in report['steps'] if s['started'] is not None and s['action'] != 'imagine']


def looks_of(step):
    return (step['plan'], step['index'], step['action'], step['arguments'], step['phase'],
            step['failure'])


def imagined(step):
    recommended = step['recommended']
    return (step['plan'], step['step'], step['action'], step['alternatives'], step['outcome'],
            step['predictions'][recommended]['arguments'] if recommended >= 0 else None)


def durations(steps):
    return [s['finished'] - s['started'] for s in steps]


def pauses(steps):
    return [after['started'] - before['finished'] for before, after in zip(steps, steps[1:])]


class LoopIdentityTest(LoopCase):
    SETTINGS = {'pace': PACE, 'rollouts': 64, 'workers': 2}  # those of config/loop.yaml

    def locally(self, task, robot, objects, imagination):
        scenario = dict(scenario_of(robot, objects), task=task, knowledge=[RESTAURANT])
        path = self.loop.processes.write('local.yaml', yaml.safe_dump(scenario))
        return self.report_of([task, '--local', '--scenario', path, '--seed', '1',
                               '--imagination', imagination])

    def in_the_graph(self, task, robot, objects, imagination):
        self.begin(robot, objects)
        return self.report_of([task, '--wait', '60', '--imagination', imagination])

    def report_of(self, words):
        path = os.path.join(self.loop.processes.folder.name, 'report.json')
        process = self.loop.processes.start(
            [executable('hires'), 'achieve', *words, '--json', path], self.loop.main)
        self.assertEqual(process.wait(LIMIT), 0, process.output())
        with open(path) as file:
            return json.load(file)

    def require_alike(self, what, one, other, most):
        """Each of these times [s] within `most` of the other's."""
        apart = [b - a for a, b in zip(one, other)]
        print('%s: at most %.3f s apart, on average %.3f s' % (
            what, max(map(abs, apart)), sum(apart) / len(apart)), flush=True)
        for i, difference in enumerate(apart):
            self.assertLessEqual(abs(difference), most + 1e-6, '%s %d: %s' % (what, i, apart))

    def require_same(self, task, robot, objects, imagination):
        loop = self.locally(task, robot, objects, imagination)
        graph = self.in_the_graph(task, robot, objects, imagination)
        for key in ('task', 'outcome', 'failure', 'replans', 'warnings'):
            self.assertEqual(graph[key], loop[key], key)
        one, other = steps_of(loop), steps_of(graph)
        self.assertEqual([looks_of(s) for s in other], [looks_of(s) for s in one])
        self.assertEqual([imagined(s) for s in graph['imaginations']],
                         [imagined(s) for s in loop['imaginations']])
        self.require_alike('durations', durations(one), durations(other), DURATIONS)
        self.require_alike('pauses', pauses(one), pauses(other), PAUSES)

    def test_a_tray_is_loaded_alike(self):
        self.require_same(LOAD, AT_COUNTER, MUG, 'off')


if __name__ == '__main__':
    run_test('loop_identity', LoopIdentityTest)
