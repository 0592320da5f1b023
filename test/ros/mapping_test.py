#!/usr/bin/env python3
"""The node that makes a map while a robot drives, as a real process: a robot that drives round a room and scans
it, with odometry that drifts; and scans, odometry, clocks and parameters that are wrong. Run alone, or by
`rostest hires mapping.test`."""

import math
import os
import sys
import tempfile
import unittest

import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from diagnostics import diagnostics  # noqa: E402
from ros_processes import Processes, executable, wait_until  # noqa: E402
from scanned_room import (ANGLES, BASE, RANGE_MAX, RESOLUTION, HearsEchoes, Laser, Robot, after,  # noqa: E402
                          laser_transform, room, scan_message, transform_message, wrapped, yaw_of)
from test_run import long_case, run_test  # noqa: E402

ODOMETRY = 'odom_combined'
PERIOD = 0.2      # [s] between scans
TOLERANCE = 0.1   # [s] transform_tolerance of config/mapping.yaml
INTERVAL = 5.0    # [s] map_update_interval there
ROUND = 107       # scans of one round
NAN, INF = float('nan'), float('inf')
CONFIG = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'config', 'mapping.yaml')


def walls_of(message):
    """Centres of occupied cells [m], where the room has them."""
    grid = numpy.array(message.data).reshape(message.info.height, message.info.width)
    rows, columns = numpy.nonzero(grid == 100)
    x = message.info.origin.position.x + (columns + 0.5) * message.info.resolution
    y = message.info.origin.position.y + (rows + 0.5) * message.info.resolution
    c, s = math.cos(Robot.START[2]), math.sin(Robot.START[2])
    return numpy.stack([Robot.START[0] + c * x - s * y, Robot.START[1] + s * x + c * y], axis=1)


def wall_errors(message):
    """[m] from the map's walls to those of the room."""
    rows, columns = numpy.nonzero(room())
    truth = (numpy.stack([columns, rows], axis=1) + 0.5) * RESOLUTION
    return numpy.array([numpy.hypot(*(truth - wall).T).min() for wall in walls_of(message)])


class Node:
    """One process with what it says; names of its own, and common inputs."""
    count = 0

    def __init__(self, test, *arguments):
        from nav_msgs.msg import MapMetaData, OccupancyGrid
        from tf2_msgs.msg import TFMessage
        Node.count += 1
        self.space = '/n%d' % Node.count
        self.name = self.space + '/mapping'
        self.maps, self.sizes, self.transforms = [], [], {}
        rospy = test.rospy
        listeners = [rospy.Subscriber(self.space + '/map', OccupancyGrid, self.maps.append, queue_size=100),
                     rospy.Subscriber(self.space + '/map_metadata', MapMetaData, self.sizes.append, queue_size=100),
                     rospy.Subscriber('/tf', TFMessage, self._take, queue_size=100)]
        self.process = test.processes.start(
            [executable('mapping'), '__ns:=' + self.space, 'base_scan:=/base_scan'] + list(arguments), test.main)
        test.addCleanup(self.process.destroy)
        for listener in listeners:
            test.addCleanup(listener.unregister)
        for publisher in test.publishers:
            wait_until(lambda: any(c.endpoint_id == self.name for c in publisher.impl.connections),
                       lambda: '%s to listen to %s\n%s' % (self.name, publisher.name, self.process.output()))
        wait_until(lambda: all(any(c.callerid_pub == self.name for c in listener.impl.connections)
                               for listener in listeners),
                   lambda: '%s to be heard\n%s' % (self.name, self.process.output()))

    def _take(self, message):
        if message._connection_header['callerid'] != self.name:
            return
        for transform in message.transforms:
            self.transforms[transform.header.stamp.to_nsec()] = transform


class MappingTest(HearsEchoes, unittest.TestCase):
    node_type = Node

    @classmethod
    def setUpClass(cls):
        cls.processes = Processes()
        cls.addClassCleanup(cls.processes.stop_all)
        cls.main = cls.processes.master()
        os.environ.update(ROS_MASTER_URI=cls.main.uri, ROS_IP='127.0.0.1')
        os.environ.pop('ROS_HOSTNAME', None)
        import rospy
        from rosgraph_msgs.msg import Clock
        from sensor_msgs.msg import LaserScan
        from tf2_msgs.msg import TFMessage
        cls.rospy = rospy
        rospy.init_node('mapping_test', disable_signals=True)
        cls.main.set_param('/use_sim_time', True)  # of the nodes; this one goes by the wall's clock
        cls.clock = rospy.Publisher('/clock', Clock, queue_size=100)
        cls.moving = rospy.Publisher('/tf', TFMessage, queue_size=1000)
        cls.fixed = rospy.Publisher('/tf_static', TFMessage, queue_size=10, latch=True)
        cls.scans = rospy.Publisher('/base_scan', LaserScan, queue_size=1000)
        cls.publishers = [cls.clock, cls.moving, cls.fixed, cls.scans]
        cls.fixed.publish(TFMessage([laser_transform()]))
        cls.laser = Laser()

    now = 1000.0  # [s]

    def setUp(self):
        MappingTest.now += 100.0
        self.robot = Robot()

    # What goes in.

    def scan(self):
        return scan_message(self.laser, self.robot.pose, self.now)

    def tick(self, with_odometry=True):
        """Time goes on, and odometry with it."""
        MappingTest.now = round(self.now + PERIOD, 3)
        self.clock.publish(self.rospy.Time.from_sec(self.now))
        if with_odometry:
            self.tell_odometry()

    def tell_odometry(self):
        from tf2_msgs.msg import TFMessage
        self.moving.publish(TFMessage([transform_message(ODOMETRY, BASE, self.robot.odometry, self.now)]))

    def answer_to(self, scan):
        return (scan.header.stamp + self.rospy.Duration.from_sec(TOLERANCE)).to_nsec()

    def step(self, *nodes):
        """One scan, until each node has said where the robot was then; those poses, as the room has them."""
        self.tick()
        scan = self.scan()
        self.scans.publish(scan)
        stamp = self.answer_to(scan)
        wait_until(lambda: all(stamp in node.transforms for node in nodes), lambda: 'an answer to a scan\n' +
                   '\n'.join(node.process.output() for node in nodes))
        return [self.seen(node.transforms[stamp]) for node in nodes]

    def seen(self, transform):
        self.assertEqual((transform.header.frame_id, transform.child_frame_id), ('map', ODOMETRY))
        where = transform.transform
        X_MO = (where.translation.x, where.translation.y, yaw_of(where.rotation))
        return after(Robot.START, after(X_MO, self.robot.odometry))

    def drive(self, count, *nodes):
        """(m, rad) by which the first node was off after each scan."""
        errors = []
        for _ in range(count):
            self.robot.drive()
            pose = self.step(*nodes)[0]
            errors.append((math.dist(pose[:2], self.robot.pose[:2]), abs(wrapped(pose[2] - self.robot.pose[2]))))
        return errors

    def begun(self, *arguments):
        """A node that has the first scan."""
        node = Node(self, *arguments)
        self.step(node)
        return node

    def map_of(self, node):
        """With all scans."""
        from nav_msgs.srv import GetMap
        return self.rospy.ServiceProxy(node.space + '/dynamic_map', GetMap)().map

    def say(self, node, condition):
        """Its diagnostics, once they are as wanted."""
        return diagnostics(self.rospy, node.name[1:], condition)

    def dropped(self, node, words):
        return self.say(node, lambda v: words in v['dropped last'])

    # What it does.

    def test_a_room_is_mapped_while_a_robot_drives_round(self):
        node = self.begun()
        errors = self.drive(ROUND + 30, node)
        print('pose: worst %.3f m, %.4f rad' % tuple(map(max, zip(*errors))))
        self.assertLess(max(error[0] for error in errors), 0.1)
        self.assertLess(max(error[1] for error in errors), 0.05)
        drifted = after(Robot.START, self.robot.odometry)
        self.assertGreater(math.dist(drifted[:2], self.robot.pose[:2]), 0.5, 'odometry would do it, too')
        grid = self.map_of(node)
        self.assertEqual(grid.header.frame_id, 'map')
        off = wall_errors(grid)
        print('walls: %d cells, median %.3f m, 95 %% %.3f m' % (len(off), *numpy.percentile(off, [50, 95])))
        self.assertLess(numpy.median(off), 0.05)
        self.assertGreater(len(off), 500)
        self.assertGreater(sum(value == 0 for value in grid.data) * RESOLUTION ** 2, 40.0)  # [m^2]
        said = self.say(node, lambda v: v['message'] == 'mapping')
        print('keyframes %(keyframes)s, loops %(loops)s, drawing %(drawing the last map [s])s s' % said)
        self.assertEqual(said['level'], 0)
        self.assertGreater(int(said['loops']), 0)
        self.assertEqual(said['lost scans'], '0')
        self.assertEqual(said['scans'], str(ROUND + 31))

    def test_maps_come_when_they_are_due(self):
        node = self.begun()
        wait_until(lambda: len(node.maps) == 1, 'a map of the first scan')
        count = round(INTERVAL / PERIOD)
        for number in 2, 3:
            self.drive(count - 1, node)
            self.assertEqual(len(node.maps), number - 1)
            self.step(node)
            wait_until(lambda: len(node.maps) == number and len(node.sizes) == number, 'map %d' % number)
        stamps = [message.header.stamp.to_sec() for message in node.maps]
        self.assertAlmostEqual(stamps[1] - stamps[0], INTERVAL)
        self.assertAlmostEqual(stamps[2] - stamps[1], INTERVAL)
        self.assertEqual(node.sizes[-1], node.maps[-1].info)
        # The last scans have none after them that draws them; a service that asks does.
        self.drive(3, node)
        self.assertEqual(self.map_of(node).header.stamp, self.rospy.Time.from_sec(self.now))
        wait_until(lambda: len(node.maps) == 4, 'the fourth map')

    @long_case
    def test_the_last_scans_are_drawn_when_no_more_come(self):
        node = self.begun()
        self.drive(3, node)
        wait_until(lambda: node.maps and node.maps[-1].header.stamp == self.rospy.Time.from_sec(self.now),
                   'the last scan in a map')

    def test_the_same_messages_give_the_same_map(self):
        nodes = [Node(self), Node(self)]
        self.step(*nodes)
        # Which maps come depends on how long one is drawn; what is in them does not.
        for _ in range(4):
            self.drive(15, *nodes)
            first, second = (self.map_of(node) for node in nodes)
            self.assertEqual(first, second)
        self.assertEqual(nodes[0].transforms, nodes[1].transforms)

    def test_a_map_is_saved_where_it_was_told(self):
        from std_srvs.srv import Trigger
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'room.yaml')
            node = Node(self, '_map_file:=' + path)
            save = self.rospy.ServiceProxy(node.space + '/save_map', Trigger)
            answer = save()
            self.assertFalse(answer.success)
            self.assertIn('no scan has met anything yet', answer.message)
            self.step(node)
            self.drive(5, node)
            answer = save()
            self.assertTrue(answer.success, answer.message)
            with open(path) as file:
                text = file.read()
            self.assertIn('room.pgm', text)
            self.assertIn('resolution: 0.05\n', text)
            self.assertTrue(os.path.exists(os.path.join(folder, 'room.pgm')))
        answer = save()
        self.assertFalse(answer.success)
        self.assertIn('room', answer.message)
        self.drive(2, node)

    # What is wrong.

    @long_case
    def test_scans_that_are_wrong_are_dropped_with_the_reason(self):
        from nav_msgs.srv import GetMap
        node = Node(self)

        def refuse(words, **change):
            self.robot.drive()
            self.tick()
            scan = self.scan()
            for key, value in change.items():
                setattr(scan.header if key in ('stamp', 'frame_id') else scan, key, value)
            self.scans.publish(scan)
            if 'frame_id' in change and change['frame_id']:
                self.step(node)  # it waits until a later one can be used
            self.assertIn('base_scan', self.dropped(node, words)['dropped last'])

        def at(stamp):
            return self.rospy.Time.from_sec(stamp)
        nothing = [INF] * len(ANGLES)
        self.say(node, lambda v: v['message'].startswith('waits for scans on '))
        refuse('nothing met', ranges=nothing)  # no map begins with it
        with self.assertRaises(self.rospy.ServiceException):
            self.rospy.ServiceProxy(node.space + '/dynamic_map', GetMap)()
        self.robot = Robot()
        self.step(node)
        refuse('header.stamp is 0', stamp=self.rospy.Time(0))
        refuse('header.frame_id is empty', frame_id='')
        refuse("tf does not know frame 'nobodys_laser'", frame_id='nobodys_laser')
        refuse('in the future', stamp=at(self.now + 50.0))
        refuse('s old, wanted 3', stamp=at(self.now - 50.0))
        refuse('no ranges: 0 ranges', ranges=[])
        refuse('nothing measured', ranges=[NAN] * len(ANGLES))
        refuse('bad angles', angle_increment=NAN)
        refuse('bad angles', angle_min=INF)
        self.step(node)
        self.scans.publish(self.scan())  # the same stamp again
        self.dropped(node, 'wanted more than the')
        self.assertLess(max(self.drive(10, node))[0], 0.1)
        self.say(node, lambda v: v['message'] == 'mapping')
        self.assertLess(numpy.median(wall_errors(self.map_of(node))), 0.05)

    def test_a_laser_that_sees_nothing_goes_by_odometry(self):
        node = self.begun()
        self.drive(10, node)
        for _ in range(5):
            self.robot.drive()
            self.tick()
            scan = self.scan()
            scan.ranges = [RANGE_MAX + 1.0] * len(ANGLES)
            self.scans.publish(scan)
            wait_until(lambda: self.answer_to(scan) in node.transforms, 'an answer')
        said = self.say(node, lambda v: v['message'].startswith('lost'))
        self.assertEqual((said['level'], said['lost scans']), (1, '5'))
        self.assertLess(self.drive(10, node)[-1][0], 0.1)

    def test_scans_without_odometry_wait_for_it(self):
        node = self.begun()
        self.robot.drive()
        self.tick(with_odometry=False)
        scan = self.scan()
        self.scans.publish(scan)
        self.say(node, lambda v: v['message'].startswith("waits for the transform of 'base_footprint'"))
        self.tell_odometry()
        wait_until(lambda: self.answer_to(scan) in node.transforms, 'the scan to be used')

    def test_odometry_that_begins_again_at_zero_counts_as_no_motion(self):
        node = self.begun()
        self.drive(10, node)
        self.robot.odometry = (0.0, 30.0, 2.0)
        self.step(node)
        self.say(node, lambda v: v['odometry jumps'] == '1')
        self.assertLess(max(self.drive(20, node))[0], 0.1)

    def test_a_clock_that_begins_again_begins_another_map(self):
        node = self.begun()
        self.drive(10, node)
        before = self.map_of(node)
        MappingTest.now = 100.0
        self.robot = Robot()
        # The first scans may overtake the clock, and are from another time then.
        wait_until(lambda: self._is_answered(node), lambda: 'an answer\n' + node.process.output())
        self.assertEqual(self.say(node, lambda v: v['message'] == 'mapping')['clock begun again'], '1')
        self.assertEqual(sum('a new map is begun' in line for line in node.process.lines), 1)
        self.assertLess(max(self.drive(10, node))[0], 0.1)
        grid = self.map_of(node)
        self.assertLess(numpy.median(wall_errors(grid)), 0.05)
        self.assertLess(grid.header.stamp, before.header.stamp)

    def _is_answered(self, node):
        self.tick()
        before = len(node.transforms)
        self.scans.publish(self.scan())
        return len(node.transforms) > before

    def test_a_map_that_would_be_too_large_is_not_drawn_and_said(self):
        with open(CONFIG) as file:
            text = file.read()
        with tempfile.NamedTemporaryFile('w', suffix='.yaml') as config:
            config.write(text.replace('delta: 0.05', 'delta: 0.01').replace('maxRange: 30.0', 'maxRange: 100.0'))
            config.flush()
            node = self.begun('_config:=' + config.name)
        wait_until(lambda: node.maps, 'the first map')
        for _ in range(3):  # walls around 200 m
            self.robot.drive()
            self.tick()
            scan = self.scan()
            scan.ranges, scan.range_max = [99.0] * len(ANGLES), 120.0
            self.scans.publish(scan)
            wait_until(lambda: self.answer_to(scan) in node.transforms, 'an answer')
        with self.assertRaises(self.rospy.ServiceException):
            self.map_of(node)
        self.assertEqual(self.say(node, lambda v: v['message'].startswith('no map: a map of'))['level'], 2)

    def test_parameters_that_nobody_knows_end_it(self):
        with open(CONFIG) as file:
            text = file.read()
        with tempfile.NamedTemporaryFile('w', suffix='.yaml') as config:
            config.write(text.replace('delta:', 'deltaa:'))
            config.flush()
            for name, argument, word in (('mistaken', '_map_fil:=x', "'map_fil'"),
                                         ('misread', '_config:=' + config.name, 'delta')):
                node = self.processes.start([executable('mapping'), '__name:=' + name, argument], self.main)
                self.assertNotEqual(node.wait(), 0)
                self.assertIn(word, node.output())


if __name__ == '__main__':
    run_test('mapping', MappingTest)
