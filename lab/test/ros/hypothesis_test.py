#!/usr/bin/env python3
"""`hires_lab experiment hypothesis` with whole systems that die, are interrupted, or lose their
experiment: run alone, or by `rostest hires hypothesis.test`."""

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
START = 180.0  # [s] at most for a whole system to start on a loaded machine


class HypothesisTest(unittest.TestCase):
    def setUp(self):
        self.processes = Processes()
        self.addCleanup(self.processes.stop_all)
        self.mark = uuid.uuid4().hex
        self.addCleanup(self.kill_marked)
        self.journal = os.path.join(self.processes.folder.name, 'runs.journal')

    def marked(self, kind=''):
        """{pid: command line} of what the experiment started, and itself."""
        return {pid: command for pid, command in processes_with(MARK, self.mark).items()
                if kind in command}

    def kill_marked(self):
        for pid in self.marked():
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass

    def experiment(self, *arguments):
        command = [executable('hires_lab'), 'experiment', 'hypothesis', '--scenario', 'topple',
                   '--runs', '1', '--pace', '1', '--resume', self.journal] + list(arguments)
        # In a folder of temporary files of its own, that must be empty afterwards.
        self.temporary = os.path.join(self.processes.folder.name, 'tmp')
        os.makedirs(self.temporary, exist_ok=True)
        return self.processes.start(command, None, TMPDIR=self.temporary, **{MARK: self.mark})

    def wait_for_robot(self, not_among=()):
        """Process ids of a robot's simulator, once there is another than those."""
        return wait_until(lambda: set(self.marked('__name:=sim_robot')) - set(not_among),
                          "a robot's simulator", START)

    def lines(self):
        with open(self.journal) as file:
            return [json.loads(line) for line in file]

    def assert_nothing_left(self):
        wait_until(lambda: not self.marked(), 'all processes to be gone')

    def test_runs_whose_system_dies_are_recorded_as_failed(self):
        experiment = self.experiment()
        first = self.wait_for_robot()
        for pid in first:
            os.kill(pid, signal.SIGKILL)
        for pid in self.wait_for_robot(not_among=first):
            os.kill(pid, signal.SIGKILL)
        self.assertEqual(experiment.wait(START), 2, experiment.output())  # none came to its end
        records = self.lines()[1:]
        self.assertEqual([record['imagination'] for record in records], [True, False])
        self.assertEqual(records[0]['seed'], records[1]['seed'])
        for record in records:
            self.assertFalse(record['success'])
            self.assertFalse(record['complete'])
            self.assertEqual(record['outcome'], 'system_died', record)
        self.assert_nothing_left()
        self.assertEqual(os.listdir(self.temporary), [])

    def test_an_interrupted_experiment_ends_its_system_and_says_how_to_go_on(self):
        experiment = self.experiment()
        self.wait_for_robot()
        experiment.signal(signal.SIGINT)
        self.assertEqual(experiment.wait(START), 130, experiment.output())
        self.assertIn('0 of 2 runs are kept in ' + self.journal, experiment.output())
        self.assertEqual(len(self.lines()), 1)
        self.assert_nothing_left()
        self.assertEqual(os.listdir(self.temporary), [])

    def test_a_killed_experiment_leaves_no_process_behind(self):
        experiment = self.experiment()
        self.wait_for_robot()
        experiment.kill()
        wait_until(lambda: not self.marked(), 'all processes to be gone', START)

    def test_two_experiments_do_not_share_a_master(self):
        first = self.experiment()
        robot = self.wait_for_robot()
        self.journal += '2'
        second = self.experiment()
        both = robot | self.wait_for_robot(not_among=robot)
        masters = set()
        for pid in both:
            with open('/proc/%d/environ' % pid) as file:
                masters.update(entry for entry in file.read().split('\0')
                               if entry.startswith('ROS_MASTER_URI='))
        self.assertEqual(len(masters), 2)
        first.signal(signal.SIGINT)
        second.signal(signal.SIGINT)
        self.assertEqual(first.wait(START), 130, first.output())
        self.assertEqual(second.wait(START), 130, second.output())
        self.assert_nothing_left()


if __name__ == '__main__':
    run_test('hypothesis', HypothesisTest)
