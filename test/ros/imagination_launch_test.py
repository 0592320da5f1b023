#!/usr/bin/env python3
"""launch/imagination.launch comes up, answers, and goes without a trace, many times: run alone, or
by `rostest hires imagination_launch.test`."""

import os
import signal
import sys
import time
import unittest

import rosunit

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from imagination_system import ImaginationSystem  # noqa: E402
from ros_processes import wait_until  # noqa: E402

CYCLES = 20


class ImaginationLaunchTest(unittest.TestCase):
    def setUp(self):
        self.system = ImaginationSystem(workers=1)
        self.addCleanup(self.system.destroy)

    def launch(self):
        # With -p roslaunch would bring a master of its own; the one at ROS_MASTER_URI is there.
        return self.system.run(['roslaunch', 'hires', 'imagination.launch', 'workers:=1',
                                'base_port:=%d' % self.system.base_port])

    def is_there(self, sign):
        return any(sign in command for command in self.system.alive().values())

    def test_launched_as_a_user_does_it_answers(self):
        launch = self.launch()
        launch.wait_for('worker=1 joined')
        answer = self.system.ask(rollouts=16).answer()
        self.assertEqual(answer.code, 0, answer.output)
        launch.signal(signal.SIGINT)
        self.assertEqual(launch.wait(), 0)
        wait_until(lambda: not self.system.alive(), 'all processes to end', 2.0)

    def test_twenty_starts_and_stops_leave_no_process(self):
        # Each cycle is stopped at another moment of the start, every fourth when all is up. Not
        # earlier: a signal that roslaunch sends to a node it is just forking is lost, and
        # roslaunch waits 15 s before it sends another.
        moments = ('lib/hires/worker_host', 'rosmaster --core', '__name:=sim_worker_1', None)
        longest = 0.0
        for cycle in range(CYCLES):
            moment = moments[cycle % len(moments)]
            with self.subTest(cycle=cycle, stopped_at=moment):
                launch = self.launch()
                if moment:
                    wait_until(lambda: self.is_there(moment), moment)
                else:
                    launch.wait_for('worker=1 joined')
                launch.signal(signal.SIGINT)
                stopped = time.monotonic()
                self.assertEqual(launch.wait(), 0, launch.output())
                wait_until(lambda: not self.system.alive(), 'all processes to end', 2.0)
                longest = max(longest, time.monotonic() - stopped)
        # Past rosunit, which keeps standard output to itself.
        print('longest shutdown: %.2f s' % longest, file=sys.__stderr__, flush=True)


if __name__ == '__main__':
    rosunit.unitrun('hires', 'imagination_launch', ImaginationLaunchTest)
