#!/usr/bin/env python3
"""How launches end: at once and with one word where a configuration is wrong or a name is taken, and quietly
when what they were started for is done. Run by `rostest hires launch_end.test`."""

import os
import signal
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from ros_processes import Processes, wait_until  # noqa: E402
from test_run import run_test  # noqa: E402

PLANNER = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'launch', 'planner.launch')
DONE = """<launch>
  <node pkg="hires" type="hires" name="done" output="screen" required="true"
        args="list scenarios --end-launch"/>
</launch>
"""


OWN = """<launch>
  <include file="$(find hires)/launch/closed_loop.launch">
    <arg name="scenario" value="topple"/>
    <arg name="task" value="none"/>
    <arg name="knowledge" value="$(find hires)/config/knowledge/restaurant.yaml"/>
    <arg name="domain" value="%s"/>
  </include>
</launch>
"""


class LaunchEndTest(unittest.TestCase):
    def setUp(self):
        self.processes = Processes()
        self.addCleanup(self.processes.stop_all)
        self.master = self.processes.master()

    def launch(self, *words):
        return self.processes.start(['roslaunch', *words], self.master)

    def test_a_wrong_configuration_is_said_once_and_ends_the_launch(self):
        for words in (('hires', 'planner.launch'), (os.path.relpath(PLANNER),)):
            launch = self.launch(*words, 'domain:=/nowhere/d.lisp')
            launch.wait()
            self.assertEqual(launch.output().count('/nowhere/d.lisp: no such file'), 1, launch.output())

    def test_so_it_does_at_once_whatever_a_node_does_with_signals(self):
        for file, argument, text in (('worker_host.launch', 'index:=0', '~index is 0'),
                                     ('relay.launch', 'foreign_master:=nowhere', "~foreign_master is 'nowhere'"),
                                     ('base_guard.launch', 'navigation:=sail', "~navigation is 'sail'")):
            launch = self.launch('hires', file, argument)
            launch.wait()
            self.assertIn(text, launch.output())
            self.assertNotIn('escalating', launch.output())
            self.assertNotIn('has died', launch.output())

    def test_so_it_is_in_a_launch_file_of_somebody_else_where_the_robot_is_simulated(self):
        launch = self.launch(self.processes.write('own.launch', OWN % '/nowhere/d.lisp'))
        launch.wait()
        self.assertIn('/nowhere/d.lisp: no such file', launch.output())

    def test_a_second_launch_under_the_same_names_ends_and_the_first_goes_on(self):
        first = self.launch('hires', 'planner.launch')
        wait_until(lambda: 'plan/status' in str(self.master.publishers()), 'the planner')
        second = self.launch('hires', 'planner.launch')
        second.wait()
        self.assertEqual(second.output().count('bears this name'), 1, second.output())
        self.assertTrue(first.is_running())
        self.assertNotIn('new node registered', first.output())
        first.signal(signal.SIGINT)  # its nodes are no children of this test
        first.wait()

    def test_what_is_done_ends_the_launch_without_a_word_of_death(self):
        launch = self.launch(self.processes.write('done.launch', DONE))
        self.assertEqual(launch.wait(), 0, launch.output())
        self.assertIn('topple', launch.output())
        self.assertNotIn('has died', launch.output())


if __name__ == '__main__':
    run_test('launch_end', LaunchEndTest)
