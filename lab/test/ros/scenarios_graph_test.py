#!/usr/bin/env python3
"""`hires_lab scenarios --graph` with whole graphs: a task that is done, a planner that is killed, a worker
that is stopped, a runner that is killed. Run alone, or by `rostest hires scenarios_graph.test`."""

import json
import os
import signal
import sys
import unittest
import uuid


HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, *[os.pardir] * 3, 'test', 'ros', 'support'))

from ros_processes import Processes, executable, processes_with, wait_until  # noqa: E402
from test_run import run_test  # noqa: E402

MARK = 'HIRES_TEST_MARK'
START = 180.0  # [s] at most for a whole graph to start on a loaded machine
TASK = 'carry_object_on_tray peppermill1 counter1 table1'
SERIES = """!Scenario
Scenario: topple
Instruction: achieve {}
---
!FluentPoseModification
Instance: poseTable1
Group: g
Choices: 1
Modifications: [[hasX, [0.3]]]
Attachments: [poseChair1, poseChair2]
"""


class ScenariosGraphTest(unittest.TestCase):
    def setUp(self):
        self.processes = Processes()
        self.addCleanup(self.processes.stop_all)
        self.mark = uuid.uuid4().hex
        self.addCleanup(self.kill_marked)
        self.folder = self.processes.folder.name

    def marked(self, kind=''):
        return {pid: command for pid, command in processes_with(MARK, self.mark).items()
                if kind in command}

    def kill_marked(self):
        for pid in self.marked():
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass

    def scenarios(self, instruction, *arguments, pace='3'):
        series = os.path.join(self.folder, 'some.yaml')
        with open(series, 'w') as file:
            file.write(SERIES.format(instruction))
        self.json = os.path.join(self.folder, 'all.json')
        command = [executable('hires_lab'), 'scenarios', series, '--runs', '1', '--graph', '--pace', pace,
                   '--store', os.path.join(self.folder, 'store'), '--json', self.json]
        return self.processes.start(command + list(arguments), None, **{MARK: self.mark})

    def run_record(self):
        with open(self.json) as file:
            return json.load(file)['runs'][0]

    def log(self):
        store = os.path.join(self.folder, 'store')
        for name in os.listdir(store) if os.path.isdir(store) else []:
            path = os.path.join(store, name, 'run.log')
            if os.path.exists(path):
                with open(path) as file:
                    return file.read()
        return ''

    def wait_for_step(self):
        wait_until(lambda: ':running' in self.log(), 'a step to run', START)

    def assert_nothing_left(self):
        wait_until(lambda: not self.marked(), 'all processes to be gone', START)

    def test_a_task_is_done_in_the_changed_world_and_its_episode_is_kept(self):
        scenarios = self.scenarios(TASK, pace='0')
        self.assertEqual(scenarios.wait(600.0), 0, scenarios.output())
        run = self.run_record()
        self.assertEqual(run['outcome'], 'succeeded')
        self.assertGreater(run['simulated_seconds'], 30.0)
        self.assertGreater(run['fluents'], 200)
        self.assertTrue(os.path.exists(os.path.join(self.folder, 'store', run['episode'] + '.db')))
        self.assert_nothing_left()

    def test_a_killed_planner_breaks_the_run_which_is_started_again(self):
        scenarios = self.scenarios(TASK)
        self.wait_for_step()
        for pid in self.marked('__name:=planner'):
            os.kill(pid, signal.SIGKILL)
        wait_until(lambda: 'started again' in scenarios.output(), 'a restart', START)
        self.assertIn('planner', scenarios.output())
        scenarios.signal(signal.SIGINT)
        self.assertEqual(scenarios.wait(START), 130, scenarios.output())
        self.assert_nothing_left()

    def test_a_stopped_worker_breaks_the_run(self):
        scenarios = self.scenarios(TASK,
                                   '--restarts', '0')
        self.wait_for_step()
        wait_until(lambda: self.marked('__name:=sim_worker_1'), 'the worker', START)
        for pid in self.marked('__name:=sim_worker_1'):
            os.kill(pid, signal.SIGSTOP)
        self.assertEqual(scenarios.wait(START), 3, scenarios.output())
        self.assertEqual(self.run_record()['outcome'], 'broken')
        self.assertRegex(self.run_record()['cause'], r'\(pid \d+\) (is stopped|died)')
        self.assert_nothing_left()

    def test_a_killed_runner_leaves_no_process_behind(self):
        scenarios = self.scenarios(TASK)
        wait_until(lambda: self.marked('__name:=sim_robot'), "a robot's simulator", START)
        scenarios.kill()
        self.assert_nothing_left()


if __name__ == '__main__':
    run_test('scenarios_graph', ScenariosGraphTest)
