#!/usr/bin/env python3
"""launch/imagination.launch comes up, answers, and goes without a trace; with --cycles, many times
and at any moment. Run alone, or by `rostest hires imagination_launch.test`."""

import os
import shutil
import signal
import sys
import time
import unittest
from concurrent.futures import ThreadPoolExecutor

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from imagination_system import ImaginationSystem  # noqa: E402
from ros_processes import executable, free_port_block, wait_until  # noqa: E402
from test_run import run_test  # noqa: E402

EXAMPLES = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'examples')
EXAMPLE = os.path.join(EXAMPLES, 'own_robot')
CYCLES = 20
SIDE_BY_SIDE = 2  # under a master each


class Launch:
    """imagination.launch with one worker, to be started again and again."""

    def __init__(self):
        self.system = ImaginationSystem(workers=1)

    def start(self):
        # With -p roslaunch would bring a master of its own; the one at ROS_MASTER_URI is there.
        return self.system.run(['roslaunch', 'hires', 'imagination.launch', 'workers:=1',
                                'base_port:=%d' % self.system.base_port])

    def is_there(self, sign):
        return any(sign in command for command in self.system.alive().values())

    def stop_at(self, moment):
        """Starts it, and stops it when a process with that in its command line is there, or when
        all is up; [s] it took to stop."""
        launch = self.start()
        if moment:
            wait_until(lambda: self.is_there(moment), moment)
        else:
            launch.wait_for('worker=1 joined')
        launch.signal(signal.SIGINT)
        stopped = time.monotonic()
        assert launch.wait() == 0, launch.output()
        wait_until(lambda: not self.system.alive(), 'all processes to end', 2.0)
        return time.monotonic() - stopped


class LaunchCase(unittest.TestCase):
    def launches(self, count):
        launches = [Launch() for _ in range(count)]
        for launch in launches:
            self.addCleanup(launch.system.destroy)
        return launches


class ImaginationLaunchTest(LaunchCase):
    def test_launched_as_a_user_does_it_answers(self):
        (imagination,) = self.launches(1)
        launch = imagination.start()
        launch.wait_for('worker=1 joined')
        answer = imagination.system.ask(rollouts=16).answer()
        self.assertEqual(answer.code, 0, answer.output)
        launch.signal(signal.SIGINT)
        self.assertEqual(launch.wait(), 0)
        wait_until(lambda: not imagination.system.alive(), 'all processes to end', 2.0)

    def test_two_of_one_master_have_workers_of_their_own_also_of_files_with_blanks_in_their_names(self):
        (imagination,) = self.launches(1)
        system = imagination.system
        world = os.path.join(system.processes.folder.name, 'my lab', 'hall.world')
        os.mkdir(os.path.dirname(world))
        shutil.copy(os.path.join(EXAMPLE, 'hall.world'), world)

        def launch(name, base_port, *files):
            return system.run(['roslaunch', 'hires', 'imagination.launch', 'workers:=1',
                               'base_port:=%d' % base_port, *files], ROS_NAMESPACE=name)
        with_master = launch('restaurant', system.base_port)
        with_master.wait_for('worker=1 joined')
        beside = launch('hall', free_port_block(2) - 1, 'world:=' + world,
                        'robot:=' + os.path.join(EXAMPLE, 'courier.yaml'),
                        'objects:=' + os.path.join(EXAMPLE, 'objects.yaml'))
        beside.wait_for('worker=1 joined')
        asked = system.run([executable('hires'), 'imagine', '--action', 'move_base_param', '--from', 'kitchenDoor',
                            '--arg', 'atRoundTable', '--arg', 'slow', '--rollouts', '8'], ROS_NAMESPACE='hall')
        self.assertEqual(asked.wait(), 0, asked.output())
        for each in (beside, with_master):  # whose master goes with it
            self.assertEqual(each.output().count('worker=1 joined'), 1, each.output())
            self.assertNotIn('withdrawn', each.output())
            each.signal(signal.SIGINT)
            each.wait()

    def test_a_map_and_a_file_of_goals_are_a_world(self):
        (imagination,) = self.launches(1)
        system = imagination.system
        files = {'map': os.path.join(EXAMPLES, 'your_files', 'depot.yaml'),
                 'areas': os.path.join(EXAMPLES, 'your_files', 'goals.yaml'),
                 'robot': os.path.join(EXAMPLE, 'courier.yaml')}
        launch = system.run(['roslaunch', 'hires', 'imagination.launch', 'workers:=1',
                             'base_port:=%d' % system.base_port,
                             *(':='.join(file) for file in files.items())])
        launch.wait_for('worker=1 joined')
        question = {'action': ['--action', 'move_base_param', '--from', 'loading_bay', '--arg',
                               'rack_1_front,rack_2_front', '--arg', 'slow'], 'rollouts': 8}
        asked = system.ask(**question).answer()
        options = [word for name, file in files.items() for word in ('--' + name, file)]
        local = system.ask('--local', *options, **question).answer()
        self.assertEqual(asked.code, 0, asked.output)
        self.assertEqual(asked.content(), local.content())
        refused = system.run([executable('imagination_client'), '_world:=a.world', '_map:=b.yaml',
                              '__name:=refused'])
        self.assertEqual(refused.wait(), 1)
        self.assertIn("~world is 'a.world' and ~map 'b.yaml', wanted one of them", refused.output())
        launch.signal(signal.SIGINT)
        launch.wait()


class ImaginationLaunchCyclesTest(LaunchCase):
    def test_twenty_starts_and_stops_leave_no_process(self):
        # Each cycle is stopped at another moment of the start, every fourth when all is up. Not
        # earlier: a signal that roslaunch sends to a node it is just forking is lost, and
        # roslaunch waits 15 s before it sends another.
        moments = ('lib/hires/worker_host', 'rosmaster --core', '__name:=sim_worker_1', None)
        launches = self.launches(SIDE_BY_SIDE)

        def play(lane):
            return [launches[lane].stop_at(moments[cycle % len(moments)])
                    for cycle in range(lane, CYCLES, SIDE_BY_SIDE)]
        with ThreadPoolExecutor(SIDE_BY_SIDE) as pool:
            durations = [duration for lane in pool.map(play, range(SIDE_BY_SIDE))
                         for duration in lane]
        self.assertEqual(len(durations), CYCLES)
        # Past rosunit, which keeps standard output to itself.
        print('longest shutdown: %.2f s' % max(durations), file=sys.__stderr__, flush=True)


if __name__ == '__main__':
    if '--cycles' in sys.argv:
        run_test('imagination_launch_cycles', ImaginationLaunchCyclesTest)
    else:
        run_test('imagination_launch', ImaginationLaunchTest)
