#!/usr/bin/env python3
"""The node that keeps what a load on the tray goes through, as a real process: beside a simulated robot that
drives with a pepper mill, killed and begun anew; and with moments made here, good and bad. Run alone, or by
`rostest hires topple_monitor.test`."""

import collections
import math
import os
import subprocess
import sys
import threading
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from diagnostics import diagnostics  # noqa: E402
from failures import text_of  # noqa: E402
from listeners import listeners  # noqa: E402
from robot_system import RobotSystem  # noqa: E402
from ros_processes import executable, wait_until  # noqa: E402
from test_run import long_case, run_test  # noqa: E402

CONFIG = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'config'))
X, Y = 12.5, 9.8        # [m] where the robot begins
ON_TRAY = (0.28, 0.3464)  # [m] before its base and above the floor
SCENARIO = """
task: none
knowledge: []
robot:
  pose: [%g, %g, 0.0]
  torso: torsoupposture
  arms: {leftarm1: armtuckedposture, rightarm1: armtuckedposture}
objects:
  - {name: peppermill1, pose: [%g, %g, %g, 0.0]}
hidden: []
""" % (X, Y, X + ON_TRAY[0], Y, ON_TRAY[1])
PERIOD = 0.05  # [s]

Line = collections.namedtuple('Line', 'time episode state tilt deviation')


class ToppleMonitorTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # Nothing waits for the node, so the robot is not quicker than a loaded computer writes.
        cls.system = RobotSystem(uncertainty='none', lockstep=True, pace=4.0)
        cls.addClassCleanup(cls.system.stop)
        cls.system.connect('topple_monitor_test')
        cls.main = cls.system.main
        from hires.msg import ToppleEpisodePart
        cls.changed = threading.Condition()
        cls.parts = []
        cls.listener = cls.system.rospy.Subscriber('topple_episode_part', ToppleEpisodePart, cls.note, queue_size=10000)

    @classmethod
    def note(cls, part):
        with cls.changed:
            cls.parts.append(part)
            cls.changed.notify_all()

    def setUp(self):
        type(self).parts = []
        self.store = os.path.join(self.system.processes.folder.name, self.id() + '.db')

    def begin(self, *arguments, **parameters):
        """The node, heard by us."""
        from rospy import has_param, delete_param
        if has_param('/topple_monitor'):
            delete_param('/topple_monitor')
        parameters.setdefault('store', self.store)
        node = self.system.processes.start(
            [executable('topple_monitor'), *arguments] +
            ['_%s:=%s' % (key, value) for key, value in parameters.items()], self.main)
        self.addCleanup(node.destroy)
        return node

    def wait_to_hear(self, node):
        """Until we listen to this one, and to no other that is gone."""
        wait_until(lambda: '/topple_monitor' in self.main.publishers('/topple_episode_part') and
                   self.listener.get_num_connections() == 1, node.output)

    def begin_alone(self, **parameters):
        """Likewise, with moments that this test tells."""
        from hires.msg import RobotState, WorldState
        config = self.system.processes.write('told.yaml', 'world_state: told/world\nrobot_state: told/robot\n'
                                             'object: ""\nafter_fall: 1.5\n')
        rospy = self.system.rospy
        self.worlds = rospy.Publisher('told/world', WorldState, queue_size=100)
        self.robots = rospy.Publisher('told/robot', RobotState, queue_size=100)
        self.addCleanup(self.worlds.unregister)
        self.addCleanup(self.robots.unregister)
        node = self.begin(config=config, run='told', **parameters)
        wait_until(lambda: self.worlds.get_num_connections() > 0 and self.robots.get_num_connections() > 0,
                   node.output)
        self.wait_to_hear(node)
        return node

    def tell(self, number, tilt=0.0, robot_stamp=None, x=0.0):
        """What is so at the number-th moment."""
        from hires.msg import ObjectState, RobotState, WorldState
        rospy = self.system.rospy
        stamp = rospy.Time.from_sec(100.0) + rospy.Duration.from_sec(PERIOD * number)
        mill = ObjectState(name='peppermill1', model='peppermill_thesis')
        mill.pose.position.x, mill.pose.position.z = ON_TRAY
        mill.pose.orientation.x, mill.pose.orientation.w = math.sin(0.5 * tilt), math.cos(0.5 * tilt)
        world = WorldState(objects=[mill])
        world.header.stamp, world.header.frame_id = stamp, 'map'
        robot = RobotState()
        robot.pose.orientation.w = 1.0
        robot.pose.position.x = x
        robot.joints.header.stamp = robot_stamp or stamp
        self.robots.publish(robot)
        self.worlds.publish(world)

    def wait_for_parts(self, number):
        with self.changed:
            self.assertTrue(self.changed.wait_for(lambda: len(self.parts) >= number, 60.0),
                            '%d parts of %d' % (len(self.parts), number))

    def lab(self, *arguments):
        return subprocess.run([executable('hires_lab'), *arguments], check=True, stdout=subprocess.PIPE,
                              text=True, timeout=60).stdout

    def stored(self, *query):
        """As lines of Listing 5.4."""
        path = os.path.join(self.system.processes.folder.name, 'parts.csv')
        self.lab('experiences', 'export', self.store, '--csv', path, *query)
        lines = []
        with open(path) as file:
            for text in file:
                fields = text.strip().split(',')
                lines.append(Line(int(fields[0]), int(fields[4]), fields[5], float(fields[9]),
                                  float(fields[10])))
        return lines

    def require_same(self, lines, parts):
        self.assertEqual([(line.time, line.episode, line.state) for line in lines],
                         [(part.header.stamp.to_nsec(), part.EpisodeID, part.state) for part in parts])
        for line, part in zip(lines, parts):
            self.assertAlmostEqual(line.tilt, part.obj_dev.vector.x, delta=1e-6)
            self.assertAlmostEqual(line.deviation, part.obj_dev.vector.y, delta=1e-6)

    def test_a_drive_with_a_mill_is_told_and_kept_also_after_a_kill(self):
        self.system.start_robot(scenario=self.system.processes.write('tray.yaml', SCENARIO), hold=True)
        self.addCleanup(self.system.end_processes)
        self.system.start_middle_layer()
        self.system.tell({'peppermill1': ('peppermill_thesis', X + ON_TRAY[0], Y, ON_TRAY[1])})
        node = self.begin(run='first')
        diagnostics(self.system.rospy, 'topple_monitor', lambda v: v['moments'] == '1')
        self.wait_to_hear(node)
        self.system.hold(False)
        self.system.require_ready()
        self.wait_for_goals_to_be_heard()
        self.drive('preManipulationAreaEastCounter1')
        self.system.hold(True)
        self.system.wait_for_standstill()
        diagnostics(self.system.rospy, 'topple_monitor', lambda v: int(v['parts']) == len(self.parts))
        node.signal(15)
        node.wait()
        self.wait_for_parts(100)
        told = [part.header.stamp.to_nsec() for part in self.parts]
        steps = {later - earlier for earlier, later in zip(told, told[1:])}
        self.assertEqual(steps, {int(PERIOD * 1e9)}, 'at 20 Hz, none lost')
        speeds = [part.base_dyn.linear.vel for part in self.parts]
        self.assertGreater(max(speeds), 0.5)
        self.assertLess(max(speeds), 0.56)
        self.assertNotIn('topple', {part.state for part in self.parts})
        self.require_same(self.stored(), self.parts)
        driven = self.stored('--action', 'move_base_param(preManipulationAreaEastCounter1, fast)')
        self.assertGreater(len(driven), 60)

        # Killed on the way, it has kept all but the last second at most; begun anew, it goes on.
        type(self).parts = []
        self.system.hold(False)
        node = self.begin(run='second')
        self.wait_to_hear(node)
        self.wait_for_goals_to_be_heard()
        goal = self.system.execute('move_base_param', 'preManipulationAreaSouthTable1', 'fast')
        self.wait_for_parts(60)
        node.kill()
        before = self.stored('--run', 'second')
        self.assertGreaterEqual(len(before), 40)
        both = min(len(before), len(self.parts))  # the last may be written and not sent, or the reverse
        self.require_same(before[:both], self.parts[:both])
        node = self.begin(run='third')
        self.assertEqual(goal.result().code, self.system.codes.SUCCEEDED, self.system.output())
        diagnostics(self.system.rospy, 'topple_monitor', lambda v: int(v['written']) > 0)
        node.signal(15)
        node.wait()
        self.assertGreater(len(self.stored('--run', 'third')), 0)
        self.assertEqual(self.stored('--run', 'second'), before)
        self.assertIn('move_base_param(preManipulationAreaSouthTable1, fast)',
                      self.lab('experiences', 'stats', self.store))

    def wait_for_goals_to_be_heard(self):
        """By the node, beside the middle layer."""
        wait_until(lambda: listeners(self.system.client.pub_goal) >= {'/middle_layer', '/topple_monitor'},
                   'two listeners to goals')

    def drive(self, area):
        result = self.system.execute('move_base_param', area, 'fast').result()
        self.assertEqual((result.code, text_of(result.failure)), (self.system.codes.SUCCEEDED, ''),
                         self.system.output())

    def test_a_fall_ends_an_episode_and_is_kept_at_once(self):
        node = self.begin_alone()
        for number in range(10):
            self.tell(number, tilt=0.02 if number > 7 else 0.0, x=0.001 * number)
        self.tell(10, tilt=0.7)
        self.wait_for_parts(8)
        wait_until(lambda: self.stored('--state', 'topple'), 'the fall to be written')
        self.assertIn('topples object=peppermill1 episode=0 time=100.50', node.output())
        for number in range(11, 20):
            self.tell(number)
        self.wait_for_parts(14)
        self.assertEqual([part.state for part in self.parts],
                         ['notopple'] * 5 + ['shaking'] * 2 + ['topple'] + ['notopple'] * 6)
        self.assertEqual([part.EpisodeID for part in self.parts], [0] * 8 + [1] * 6)
        self.assertAlmostEqual(self.parts[0].base_dyn.linear.vel, 0.001 / PERIOD, delta=1e-6)
        moment = self.parts[0].header.stamp - self.parts[0].base_dyn.header.stamp
        self.assertAlmostEqual(moment.to_sec(), 1.5 * PERIOD, delta=1e-9)
        self.assertEqual((self.parts[0].header.frame_id, self.parts[0].obj_dev.header.frame_id),
                         ('map', 'base_footprint'))

    def test_a_clock_that_begins_anew_is_another_run(self):
        self.begin_alone()
        for number in list(range(100, 110)) + list(range(10)):
            self.tell(number)
        self.wait_for_parts(14)
        diagnostics(self.system.rospy, 'topple_monitor', lambda v: v['written'] == '14')
        self.assertEqual(len(self.stored('--run', 'told')), 7)
        self.assertEqual(len(self.stored('--run', 'told/2')), 7)

    def test_what_it_waits_for_and_what_it_refuses_is_in_the_diagnostics(self):
        self.begin_alone()
        rospy = self.system.rospy
        for number in range(100):
            self.tell(number, robot_stamp=rospy.Time.from_sec(7.0))
        diagnostics(rospy, 'topple_monitor', lambda v: v['message'] ==
                    'waits for /told/world and /told/robot of one stamp' and v['level'] == 1)
        self.tell(200, x=float('nan'))
        found = diagnostics(rospy, 'topple_monitor', lambda v: v['dropped'] == '1')
        self.assertIn('dropped a moment: ', found['message'])
        for number in range(201, 206):
            self.tell(number)
        diagnostics(rospy, 'topple_monitor', lambda v: v['message'] == 'looks at peppermill1')

    def require_refusal(self, words, **parameters):
        node = self.begin(**parameters)
        self.assertNotEqual(node.wait(), 0)
        self.assertIn(words, node.output())

    @long_case
    def test_what_is_wrong_with_its_parameters_is_said(self):
        self.require_refusal('~store is missing', store='')
        self.require_refusal('there is no folder /nowhere', store='/nowhere/x.db')
        self.require_refusal("has no tray", robot=os.path.join(CONFIG, 'robots', 'fetch.yaml'))
        bad = self.system.processes.write('bad.yaml', 'world_state: a\nrobot_state: b\nobject: ""\n'
                                          'after_fall: -1\n')
        self.require_refusal('after_fall', config=bad)
        self.require_refusal("'stor' is unknown", stor='x')
        text = self.system.processes.write('text.db', 'This is no database, and never was one at all.')
        self.require_refusal('text.db', store=text)


if __name__ == '__main__':
    run_test('topple_monitor', ToppleMonitorTest)
