#!/usr/bin/env python3
"""The running graph in lockstep with its robot, and the loop in one process and virtual time, do the
same tasks step by step. Run alone, or by `rostest hires loop_identity.test`.

Compared are outcome, repairs, the steps with their order, arguments, phases and failures, and what
was recommended: these are equal. A step begins in the loop 0.03 s after its reason, and in the graph as
soon as messages have gone from node to node and through the Blackboard, which takes the computer's time;
it may so begin a tick (0.05 s) of the robot's time sooner or later, at which skills look. With another
tick the robot would draw other noise, to which a blind drive answers with up to 0.7 s; it is taken away
here, and the load's steps last in the middle layer as long as in the loop, up to one tick and the loop's
own messages, but for one look of the camera (each 0.5 s), of which skills want several: a tick decides
whether one is still in time. A drive among obstacles plans by what it sees at each tick: there times are
printed, and nothing is claimed of them, nor of how long an imagination took."""

import json
import os
import sys

import yaml

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from closed_loop import CONFIG, RESTAURANT, scenario_of  # noqa: E402
from loop_case import AT_COUNTER, MUG, LoopCase  # noqa: E402
from ros_processes import executable, wait_until  # noqa: E402
from test_run import run_test  # noqa: E402

TICK = 0.05  # [s] of the robot's time
DELAY = 0.01  # [s] of an action's end in the loop
LOOK = 0.5   # [s] config/sim_robot.yaml, detector
PACE = 1.0   # the robot's time to the computer's: a tick is longer than all messages of a decision
LIMIT = 560.0  # [s] by the wall's clock: it ends a broken test, and measures nothing

MILL = {'peppermill1': (5.47, 10.16, 0.75, 0.0)}
LOAD = 'load_tray mug1 counter1'
TOPPLE = 'carry_object_on_tray peppermill1 counter1 table1'


def steps_of(report):
    """Without those that only ask imagination."""
    return [s for s in report['steps'] if s['started'] is not None and s['action'] != 'imagine']


def looks_of(step):
    return (step['plan'], step['index'], step['action'], step['arguments'], step['phase'],
            step['failure'])


def imagined(report):
    """Of each step the answer with which it began: whether an earlier one was there before something
    changed and it was asked for again depends on how long the computer imagines."""
    last = {}
    for step in report['imaginations']:
        recommended = step['recommended']
        last[step['plan'], step['step']] = (
            step['action'], step['alternatives'], step['outcome'],
            step['predictions'][recommended]['arguments'] if recommended >= 0 else None)
    return last


def durations(steps):
    return [s['finished'] - s['started'] for s in steps]


def pauses(steps):
    return [after['started'] - before['finished'] for before, after in zip(steps, steps[1:])]


def print_apart(what, one, other):
    apart = [b - a for a, b in zip(one, other)]
    print('%s: at most %.3f s apart, on average %.3f s' % (
        what, max(map(abs, apart)), sum(apart) / len(apart)), flush=True)


class LoopIdentityTest(LoopCase):
    SETTINGS = {'pace': PACE, 'rollouts': 64, 'workers': 2}  # those of config/loop.yaml

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        with open(os.path.join(CONFIG, 'truths', 'same.yaml')) as file:
            truth = dict(yaml.safe_load(file), sensing='ideal', localisation='ideal')
        truth['uncertainty']['file'] = 'none'
        cls.without_noise = cls.loop.processes.write('without_noise.yaml', yaml.safe_dump(truth))
        cls.loop.remaps['sim_robot'] = ['_truth:=' + cls.without_noise]

    def locally(self, task, robot, objects, imagination):
        scenario = dict(scenario_of(robot, objects), task=task, knowledge=[RESTAURANT])
        path = self.loop.processes.write('local.yaml', yaml.safe_dump(scenario))
        return self.report_of([task, '--local', '--scenario', path, '--seed', '1',
                               '--truth', self.without_noise, '--imagination', imagination])

    def in_the_graph(self, task, robot, objects, imagination):
        self.begin(robot, objects)
        self.results = []
        subscriber = self.loop.rospy.Subscriber('execute_action/result',
                                                self.loop.msg.ExecuteActionActionResult,
                                                self.results.append)
        self.addCleanup(subscriber.unregister)
        wait_until(lambda: subscriber.get_num_connections() > 0, 'the middle layer')
        return self.report_of([task, '--wait', '60', '--imagination', imagination])

    def report_of(self, words):
        path = os.path.join(self.loop.processes.folder.name, 'report.json')
        process = self.loop.processes.start(
            [executable('hires'), 'achieve', *words, '--json', path], self.loop.main)
        self.assertEqual(process.wait(LIMIT), 0, process.output())
        with open(path) as file:
            return json.load(file)

    def require_same(self, task, robot, objects, imagination):
        loop = self.locally(task, robot, objects, imagination)
        graph = self.in_the_graph(task, robot, objects, imagination)
        for key in ('task', 'outcome', 'failure', 'replans', 'warnings'):
            self.assertEqual(graph[key], loop[key], key)
        one, other = steps_of(loop), steps_of(graph)
        self.assertEqual([looks_of(s) for s in other], [looks_of(s) for s in one])
        self.assertEqual(imagined(graph), imagined(loop))
        print_apart('durations', durations(one), durations(other))
        print_apart('pauses', pauses(one), pauses(other))
        return one, other, imagined(graph)

    def test_a_tray_is_loaded_alike(self):
        loop, graph, predicted = self.require_same(LOAD, AT_COUNTER, MUG, 'off')
        self.assertEqual(predicted, {})
        wait_until(lambda: len(self.results) == len(graph), 'a result of each step')
        lasted = [result.result.duration for result in self.results]
        print_apart('durations in the middle layer', durations(loop), lasted)
        for step, one, other in zip(loop, durations(loop), lasted):
            apart = min(abs(other - one + looks * LOOK) for looks in (-1, 0, 1))
            self.assertLessEqual(apart, TICK + DELAY + 1e-6, '%s: %g, %g' % (
                step['action'], one, other))

    def test_a_mill_is_carried_alike_as_it_was_imagined(self):
        _, _, predicted = self.require_same(TOPPLE, AT_COUNTER, MILL, 'domain')
        (answer,) = predicted.values()
        self.assertEqual(answer[2], 'ranked')
        self.assertEqual(answer[3], ['premanipulationareanorthtable1', 'slow'])


if __name__ == '__main__':
    run_test('loop_identity', LoopIdentityTest)
