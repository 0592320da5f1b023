#!/usr/bin/env python3
"""The node that tells where a robot is in a map, as a real process: a robot that drives through a room and
scans it, told where it begins, or not, or carried away; and maps, poses, scans and clocks that are wrong. Run
alone, or by `rostest hires localisation.test`."""

import math
import os
import signal
import sys
import threading
import unittest

import numpy

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from diagnostics import diagnostics  # noqa: E402
from ros_processes import Processes, executable, wait_until  # noqa: E402
from scanned_room import (ANGLES, BASE, RESOLUTION, HearsEchoes, Laser, Robot, after, laser_transform,  # noqa: E402
                          map_message, pose_message, room, scan_message, transform_message, wrapped, yaw_of)
from test_run import long_case, run_test  # noqa: E402

ODOMETRY = 'odom_combined'
PERIOD = 0.2      # [s] between scans
TOLERANCE = 0.1   # [s] transform_tolerance of config/localisation.yaml
NAN = float('nan')


class Node:
    """One process with what it says; names of its own, and common inputs."""
    count = 0

    def __init__(self, test, *arguments, space=None):
        """@param space  its namespace: that of one that runs no more, or of its own."""
        Node.count += 1
        self.space = space or '/n%d' % Node.count
        self.name = self.space + '/localisation'
        self.poses, self.transforms = [], {}
        rospy = test.rospy
        from geometry_msgs.msg import PoseWithCovarianceStamped
        from tf2_msgs.msg import TFMessage
        listeners = [rospy.Subscriber(self.space + '/amcl_pose', PoseWithCovarianceStamped, self.poses.append,
                                      queue_size=100),
                     rospy.Subscriber('/tf', TFMessage, self._take, queue_size=100)]
        # Those of one of its name that runs no more may still be listed.
        before = [c for publisher in test.publishers for c in publisher.impl.connections]
        before += [c for listener in listeners for c in listener.impl.connections]

        def is_new(connection):
            return all(connection is not old for old in before)

        self.process = test.processes.start(
            [executable('localisation'), '__ns:=' + self.space, 'base_scan:=/base_scan', 'map:=/map',
             'initialpose:=/initialpose', 'static_map:=/static_map'] + list(arguments), test.main)
        test.addCleanup(self.process.destroy)
        for listener in listeners:
            test.addCleanup(listener.unregister)
        has_map = any(argument.startswith('_map_file:=') for argument in arguments)
        for publisher in test.publishers:
            if publisher is test.maps and has_map:
                continue
            wait_until(lambda: any(c.endpoint_id == self.name and is_new(c) for c in publisher.impl.connections),
                       lambda: '%s to listen to %s\n%s' % (self.name, publisher.name, self.process.output()))
        wait_until(lambda: all(any(c.callerid_pub == self.name and is_new(c) for c in listener.impl.connections)
                               for listener in listeners),
                   lambda: '%s to be heard\n%s' % (self.name, self.process.output()))

    def _take(self, message):
        if message._connection_header['callerid'] != self.name:
            return
        for transform in message.transforms:
            self.transforms[transform.header.stamp.to_nsec()] = transform


class LocalisationTest(HearsEchoes, unittest.TestCase):
    node_type = Node

    @classmethod
    def setUpClass(cls):
        cls.processes = Processes()
        cls.addClassCleanup(cls.processes.stop_all)
        cls.main = cls.processes.master()
        os.environ.update(ROS_MASTER_URI=cls.main.uri, ROS_IP='127.0.0.1')
        os.environ.pop('ROS_HOSTNAME', None)
        import rospy
        from geometry_msgs.msg import PoseWithCovarianceStamped
        from nav_msgs.msg import OccupancyGrid
        from rosgraph_msgs.msg import Clock
        from sensor_msgs.msg import LaserScan
        from tf2_msgs.msg import TFMessage
        cls.rospy = rospy
        rospy.init_node('localisation_test', disable_signals=True)
        cls.main.set_param('/use_sim_time', True)  # of the nodes; this one goes by the wall's clock
        cls.clock = rospy.Publisher('/clock', Clock, queue_size=100)
        cls.moving = rospy.Publisher('/tf', TFMessage, queue_size=1000)
        cls.fixed = rospy.Publisher('/tf_static', TFMessage, queue_size=10, latch=True)
        cls.maps = rospy.Publisher('/map', OccupancyGrid, queue_size=10)
        cls.told = rospy.Publisher('/initialpose', PoseWithCovarianceStamped, queue_size=10)
        cls.scans = rospy.Publisher('/base_scan', LaserScan, queue_size=1000)
        cls.publishers = [cls.clock, cls.moving, cls.fixed, cls.maps, cls.told, cls.scans]
        cls.fixed.publish(TFMessage([laser_transform()]))
        cls.laser = Laser()

    now = 1000.0  # [s]

    def setUp(self):
        LocalisationTest.now += 100.0
        self.robot = Robot()

    # What goes in.

    def pose(self, pose):
        return pose_message(pose, self.now)

    def scan(self):
        return scan_message(self.laser, self.robot.pose, self.now)

    def odometry(self):
        return transform_message(ODOMETRY, BASE, self.robot.odometry, self.now)

    def tick(self):
        """Time goes on, and odometry with it."""
        from tf2_msgs.msg import TFMessage
        LocalisationTest.now = round(self.now + PERIOD, 3)
        self.clock.publish(self.rospy.Time.from_sec(self.now))
        self.moving.publish(TFMessage([self.odometry()]))

    def step(self, *nodes):
        """One scan, until each node has said where the robot was then; those poses."""
        self.tick()
        scan = self.scan()
        self.scans.publish(scan)
        stamp = (scan.header.stamp + self.rospy.Duration.from_sec(TOLERANCE)).to_nsec()
        wait_until(lambda: all(stamp in node.transforms for node in nodes), lambda: 'an answer to a scan\n' +
                   '\n'.join(node.process.output() for node in nodes))
        return [self.seen(node.transforms[stamp]) for node in nodes]

    def seen(self, transform):
        where = transform.transform
        X_MO = (where.translation.x, where.translation.y, yaw_of(where.rotation))
        return after(X_MO, self.robot.odometry)

    def drive(self, count, *nodes):
        """(m, rad) by which the first node was off after each scan."""
        errors = []
        for _ in range(count):
            self.robot.drive()
            pose = self.step(*nodes)[0]
            errors.append((math.hypot(pose[0] - self.robot.pose[0], pose[1] - self.robot.pose[1]),
                           abs(wrapped(pose[2] - self.robot.pose[2]))))
        return errors

    def begun(self, *arguments):
        """A node that knows where the robot is."""
        node = Node(self, *arguments)
        self.begin(node)
        return node

    def begin(self, *nodes):
        self.tick()
        self.maps.publish(map_message())
        for node in nodes:
            node.process.wait_for('map=used')
        self.told.publish(self.pose(self.robot.START))
        for node in nodes:
            node.process.wait_for('pose=set')
        self.step(*nodes)

    def say(self, node, condition):
        """Its diagnostics, once they are as wanted."""
        return diagnostics(self.rospy, node.name[1:], condition)

    def dropped(self, node, words):
        return self.say(node, lambda v: words in v['dropped last'])

    # What it does.

    def test_a_robot_that_was_told_where_it_is_is_followed(self):
        node = self.begun()
        errors = self.drive(107, node)  # once round
        print('worst %.3f m, %.3f rad' % tuple(map(max, zip(*errors))))
        self.assertLess(max(error[0] for error in errors), 0.15)
        self.assertLess(max(error[1] for error in errors), 0.06)
        drifted = after(Robot.START, self.robot.odometry)
        self.assertGreater(math.dist(drifted[:2], self.robot.pose[:2]), 0.5, 'odometry would do it, too')
        self.assertEqual(self.say(node, lambda v: v['message'] == 'good')['level'], 0)
        pose = node.poses[-1]
        self.assertEqual(pose.header.frame_id, 'map')
        covariance = pose.pose.covariance
        planar = {6 * row + column for row in (0, 1, 5) for column in (0, 1, 5)}
        self.assertTrue(all((value != 0.0) == (i in planar) for i, value in enumerate(covariance)), covariance)
        for index in (0, 7, 35):
            self.assertTrue(0.0 < covariance[index] < 0.02, covariance)
        self.assertEqual(covariance[1], covariance[6])

    def test_a_robot_that_nobody_told_where_it_is_says_nothing_until_it_knows(self):
        """The place that the configuration names is nobody's belief: a drive would begin there."""
        node = Node(self)
        self.tick()
        self.maps.publish(map_message())
        node.process.wait_for('map=used')
        self.tick()
        self.scans.publish(self.scan())
        self.assertEqual(self.say(node, lambda v: v['message'].startswith('lost'))['level'], 2)
        node.process.wait_for('place=lost')
        self.assertFalse(node.transforms or node.poses)
        self.told.publish(self.pose(self.robot.START))
        node.process.wait_for('pose=set')
        pose = self.step(node)[0]
        self.assertEqual(len(node.transforms), 1)
        self.assertLess(math.dist(pose[:2], self.robot.pose[:2]), 0.15)

    def test_a_robot_that_stands_keeps_its_transform_and_is_looked_at_again_when_asked(self):
        from std_srvs.srv import Empty
        node = self.begun()
        wait_until(lambda: node.poses, 'the first pose')
        before = len(node.poses)
        for _ in range(5):
            self.step(node)
        self.assertEqual(len(node.poses), before)
        self.rospy.ServiceProxy(node.space + '/request_nomotion_update', Empty)()
        self.step(node)
        wait_until(lambda: len(node.poses) == before + 1, 'a pose that was asked for')

    def test_a_robot_that_may_be_anywhere_finds_itself(self):
        from std_srvs.srv import Empty
        node = self.begun()
        self.rospy.ServiceProxy(node.space + '/global_localization', Empty)()
        errors = self.drive(80, node)
        print('at first %.2f m, at last %.3f m, %.3f rad' % (errors[0][0], *errors[-1]))
        self.assertGreater(max(error[0] for error in errors[:5]), 0.5, 'it knew all the time')
        self.assertLess(errors[-1][0], 0.15)
        self.assertLess(errors[-1][1], 0.06)
        self.say(node, lambda v: v['message'] == 'good')

    def test_a_robot_that_was_carried_away_is_lost_says_so_and_is_found(self):
        node = self.begun()
        self.drive(5, node)
        self.say(node, lambda v: v['message'] == 'good')
        robot = Robot()
        robot.odometry = self.robot.odometry
        for _ in range(50):  # half round
            robot.move(0.1, 0.1 / 1.7)
        self.robot.pose = robot.pose
        for _ in range(10):
            self.step(node)
        self.assertEqual(self.say(node, lambda v: v['message'].startswith('lost'))['level'], 2)
        node.process.wait_for('place=lost')
        # It stands, and tells whoever drives by its covariance.
        wait_until(lambda: min(node.poses[-1].pose.covariance[i] for i in (0, 7, 35)) >= 1.0, 'a pose that is lost')
        errors = self.drive(100, node)
        node.process.wait_for('place=found')
        print('found, %.3f m off at last' % errors[-1][0])
        self.assertLess(errors[-1][0], 0.15)
        self.assertLess(node.poses[-1].pose.covariance[0], 0.1)

    @long_case
    def test_a_robot_whose_laser_goes_blind_is_less_and_less_sure_and_lost_and_finds_itself(self):
        node = self.begun()
        self.drive(10, node)
        sees = self.scan

        def blind():
            scan = sees()
            scan.ranges = [useless] * len(ANGLES)
            return scan

        def spread():
            pose = node.poses[-1]
            return (pose.header.stamp.to_sec(), sum(pose.pose.covariance[i] for i in (0, 7)))
        for useless in (NAN, 0.0):
            known, before = len(node.process.lines), spread()
            self.scan = blind
            self.drive(20, node)
            during = spread()
            self.assertGreater(during[1], before[1] + 0.003)
            self.drive(20, node)
            node.process.wait_for('place=lost', first=known)
            self.assertGreater(spread()[1], during[1] + 0.003)
            self.assertGreater(spread()[0], self.now - 1.0, 'nobody is told any more')
            self.assertEqual(self.say(node, lambda v: v['message'].startswith('no scan'))['level'], 2)
            self.scan = sees
            errors = self.drive(20, node)
            node.process.wait_for('place=found', first=known)
            self.assertLess(errors[-1][0], 0.15)
            self.assertLess(spread()[1], 0.02)

    @long_case
    def test_a_laser_that_hangs_upside_down_is_turned_over(self):
        from geometry_msgs.msg import Quaternion
        from tf2_msgs.msg import TFMessage
        turned = laser_transform()
        turned.child_frame_id = 'turned_laser'
        turned.transform.rotation = Quaternion(x=1.0, w=0.0)
        self.fixed.publish(TFMessage([laser_transform(), turned]))
        node = self.begun()
        plain = self.scan

        def upside_down():
            scan = plain()
            scan.header.frame_id = 'turned_laser'
            scan.ranges = list(reversed(scan.ranges))
            return scan
        self.scan = upside_down
        self.assertLess(max(error[0] for error in self.drive(30, node)), 0.15)

    def test_the_same_messages_give_the_same_bits(self):
        nodes = [Node(self, '_seed:=3'), Node(self, '_seed:=3'), Node(self, '_seed:=4')]
        self.begin(*nodes)
        self.drive(40, *nodes)

        # The transforms were waited for; poses come by a topic of their own, and not of every scan.
        def told():
            poses = [[(p.header.stamp.to_nsec(), p.pose) for p in node.poses] for node in nodes]
            return len(set(map(len, poses))) == 1 and poses
        first, second, other = wait_until(told, lambda: 'as many poses of each: %s' %
                                          [len(node.poses) for node in nodes])
        self.assertGreater(len(first), 10)
        self.assertEqual(first, second)
        self.assertEqual([stamp for stamp, _ in first], [stamp for stamp, _ in other])
        self.assertNotEqual(first, other)
        self.assertEqual(nodes[0].transforms, nodes[1].transforms)

    @long_case
    def test_another_map_is_begun_with_where_the_robot_was(self):
        node = self.begun()
        self.drive(10, node)
        known = len(node.process.lines)
        other = room()
        other[20:24, 180:184] = True
        self.maps.publish(map_message())  # the same again is no other one
        self.maps.publish(map_message(other))
        node.process.wait_for('pose=set', first=known)
        self.assertEqual(sum('map=used' in line for line in node.process.lines), 2)
        self.assertLess(max(self.drive(10, node))[0], 0.15)

    def test_particles_are_shown_to_those_who_look(self):
        from geometry_msgs.msg import PoseArray
        node = self.begun()
        shown = []
        listener = self.rospy.Subscriber(node.space + '/particlecloud', PoseArray, shown.append)
        self.addCleanup(listener.unregister)
        wait_until(lambda: listener.get_num_connections() > 0, 'the particles')
        self.drive(4, node)
        wait_until(lambda: shown and len(shown[-1].poses) >= 500, 'particles')
        self.assertEqual(shown[-1].header.frame_id, 'map')

    # What is wrong.

    @long_case
    def test_scans_that_are_wrong_are_dropped_with_the_reason(self):
        from geometry_msgs.msg import Quaternion
        from tf2_msgs.msg import TFMessage
        node = self.begun()

        def refuse(words, **change):
            self.robot.drive()
            self.tick()
            scan = self.scan()
            for key, value in change.items():
                if key in ('stamp', 'frame_id'):
                    setattr(scan.header, key, value)
                else:
                    setattr(scan, key, value)
            self.scans.publish(scan)
            if 'frame_id' in change and change['frame_id']:
                self.step(node)  # it waits until a later one can be used
            self.assertIn('base_scan', self.dropped(node, words)['dropped last'])

        def at(stamp):
            return self.rospy.Time.from_sec(stamp)
        refuse('header.stamp is 0', stamp=self.rospy.Time(0))
        refuse('header.frame_id is empty', frame_id='')
        refuse("tf does not know frame 'nobodys_laser'", frame_id='nobodys_laser')
        refuse('in the future', stamp=at(self.now + 50.0))
        refuse('s old, wanted 3', stamp=at(self.now - 50.0))
        refuse('no ranges: 0 ranges', ranges=[])
        refuse('nothing measured', ranges=[NAN] * len(ANGLES))
        refuse('nothing met', ranges=[float('inf')] * len(ANGLES))
        refuse('nothing measured', ranges=[0.0] * len(ANGLES))
        refuse('bad angles', angle_increment=NAN)
        tilted = laser_transform()
        tilted.child_frame_id = 'tilted_laser'
        tilted.transform.rotation = Quaternion(y=math.sin(0.2), w=math.cos(0.2))  # into the ground
        self.fixed.publish(TFMessage([laser_transform(), tilted]))
        refuse('tilted', frame_id='tilted_laser')
        self.assertLess(self.drive(5, node)[-1][0], 0.15)
        self.say(node, lambda v: v['message'] == 'good')

    def test_scans_without_odometry_wait_for_it(self):
        from tf2_msgs.msg import TFMessage
        node = self.begun()
        self.robot.drive()
        LocalisationTest.now += PERIOD
        self.clock.publish(self.rospy.Time.from_sec(self.now))
        scan = self.scan()
        self.scans.publish(scan)
        self.say(node, lambda v: v['message'].startswith("waits for the transform of 'base_footprint'"))
        self.moving.publish(TFMessage([self.odometry()]))
        stamp = (scan.header.stamp + self.rospy.Duration.from_sec(TOLERANCE)).to_nsec()
        wait_until(lambda: stamp in node.transforms, 'the scan to be used')

    def test_scans_that_come_just_before_their_odometry_are_not_said_to_wait(self):
        from diagnostic_msgs.msg import DiagnosticArray
        from tf2_msgs.msg import TFMessage
        node = self.begun()
        said = []

        def hear(message):
            said.extend(status.message for status in message.status
                        if status.name.startswith(node.name[1:]) and status.values)
        listener = self.rospy.Subscriber('/diagnostics', DiagnosticArray, hear)
        self.addCleanup(listener.unregister)
        for _ in range(40):
            LocalisationTest.now = round(self.now + PERIOD, 3)
            self.clock.publish(self.rospy.Time.from_sec(self.now))
            self.scans.publish(self.scan())
            self.rospy.sleep(0.1)
            self.moving.publish(TFMessage([self.odometry()]))
        self.assertEqual(set(said), {'good'})

    def test_silence_of_the_laser_is_told(self):
        node = self.begun()
        LocalisationTest.now += 10.0
        self.clock.publish(self.rospy.Time.from_sec(self.now))
        self.say(node, lambda v: v['message'].startswith('no scan'))
        self.step(node)
        self.say(node, lambda v: v['message'] == 'good')

    @long_case
    def test_a_clock_that_begins_again_is_gone_along_with(self):
        node = self.begun()
        self.drive(10, node)
        for now in (100.0, self.now + 100.0):  # back, and on
            LocalisationTest.now = now
            self.tick()
            # The first scans may overtake the clock, and are from another time then.
            wait_until(lambda: self._is_answered(node), lambda: 'an answer\n' + node.process.output())
            self.assertLess(self.drive(10, node)[-1][0], 0.15)
            self.say(node, lambda v: v['message'] == 'good')

    @long_case
    def test_odometry_that_begins_again_at_zero_is_gone_along_with(self):
        node = self.begun()
        self.drive(10, node)
        self.robot.odometry = (0.0, 30.0, 2.0)
        self.step(node)
        self.dropped(node, 'odometry jumped: it goes on from this odometry')
        self.assertLess(max(self.drive(20, node))[0], 0.15)

    def _is_answered(self, node):
        self.tick()
        before = len(node.transforms)
        self.scans.publish(self.scan())
        return len(node.transforms) > before

    def test_poses_that_are_none_are_refused(self):
        node = self.begun()

        def refuse(words, change):
            message = self.pose(Robot.START)
            change(message)
            self.told.publish(message)
            self.assertIn('initialpose', self.dropped(node, words)['dropped last'])
        refuse("header.frame_id is 'odom', wanted 'map'", lambda m: setattr(m.header, 'frame_id', 'odom'))
        refuse('position is nan', lambda m: setattr(m.pose.pose.position, 'x', NAN))
        refuse('x 500 m, y 1.8 m lies outside of the map, which reaches from x ',
               lambda m: setattr(m.pose.pose.position, 'x', 500.0))
        refuse('has length 0, wanted 1', lambda m: setattr(m.pose.pose.orientation, 'w', 0.0))
        refuse('covariance', lambda m: m.pose.covariance.__setitem__(0, NAN))
        refuse('covariance', lambda m: m.pose.covariance.__setitem__(0, -1.0))
        self.assertLess(self.drive(5, node)[-1][0], 0.15)

    @long_case
    def test_maps_that_are_none_are_refused_and_static_map_is_asked(self):
        from nav_msgs.srv import GetMap, GetMapResponse
        node = Node(self)
        self.tick()
        self.say(node, lambda v: v['message'] == 'waits for a map on /map')

        def refuse(words, message):
            self.maps.publish(message)
            self.assertIn('map', self.dropped(node, words)['dropped last'])
        grid = room()
        refuse('has no free cell', map_message(grid | True))
        refuse('has no occupied cell', map_message(grid & False))
        refuse('0 x 0 cells', type(map_message())(header=map_message().header))
        elsewhere = map_message()
        elsewhere.header.frame_id = 'attic'
        refuse("header.frame_id is 'attic', wanted 'map'", elsewhere)
        server = self.rospy.Service('/static_map', GetMap, lambda _: GetMapResponse(map_message()))
        self.addCleanup(server.shutdown)
        node.process.wait_for('map=used')
        self.told.publish(self.pose(Robot.START))
        node.process.wait_for('pose=set')
        self.step(node)
        self.assertLess(self.drive(5, node)[-1][0], 0.15)

    @long_case
    def test_a_map_server_that_never_answers_holds_up_nothing(self):
        from nav_msgs.srv import GetMap, GetMapResponse
        answer = threading.Event()
        self.addCleanup(answer.set)

        def hang(_):
            answer.wait()
            return GetMapResponse(map_message())
        server = self.rospy.Service('/static_map', GetMap, hang)
        self.addCleanup(server.shutdown)
        node = Node(self)
        self.say(node, lambda v: v['message'] == 'waits for a map on /map; /static_map is there and does not '
                                                 'answer, restart the map server')
        self.begin(node)  # a map that comes otherwise is used all the same
        self.assertLess(self.drive(5, node)[-1][0], 0.15)
        node.process.signal(signal.SIGINT)  # while the call is open
        self.assertEqual(node.process.wait(), 0, node.process.output())

    # What outlives it.

    def test_one_that_was_killed_goes_on_where_the_robot_is_meanwhile(self):
        first = self.begun()
        self.drive(15, first)
        wait_until(lambda: self.rospy.has_param(first.name + '/initial_odometry_time'), 'a place to be kept')
        first.process.destroy()
        for _ in range(5):
            self.robot.drive()
            self.tick()
        second = Node(self, space=first.space)
        self.maps.publish(map_message())
        second.process.wait_for('map=used')
        errors = self.drive(3, second)
        print('off by %.3f m, %.3f rad' % errors[0])
        self.assertLess(errors[0][0], 0.15)
        self.assertLess(errors[0][1], 0.06)
        self.assertLess(self.rospy.get_param(first.name + '/initial_cov_xx'), 0.1)

    def test_one_that_is_told_where_it_is_forgets_where_it_was(self):
        first = self.begun()
        self.drive(3, first)
        wait_until(lambda: self.rospy.has_param(first.name + '/initial_odometry_time'), 'a place to be kept')
        first.process.destroy()
        self.robot.pose = (3.0, 5.0, 1.0)  # carried; odometry knows nothing of it
        second = Node(self, space=first.space)
        self.told.publish(self.pose(self.robot.pose))
        self.maps.publish(map_message())
        second.process.wait_for('pose=set x=3')
        self.assertLess(self.drive(3, second)[-1][0], 0.15)

    # Maps of files.

    def map_file(self, occupied, name='room'):
        """As map_saver writes it."""
        pixels = numpy.where(occupied[::-1], 0, 254).astype(numpy.uint8)
        with open(os.path.join(self.processes.folder.name, name + '.pgm'), 'wb') as file:
            file.write(b'P5\n%d %d\n255\n' % pixels.shape[::-1] + pixels.tobytes())
        return self.processes.write(name + '.yaml', 'image: %s.pgm\nresolution: %g\norigin: [0.0, 0.0, 0.0]\n'
                                    'negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n' % (name, RESOLUTION))

    def test_a_map_of_a_file_is_used_and_served(self):
        from nav_msgs.msg import OccupancyGrid
        from nav_msgs.srv import GetMap
        node = Node(self, '_map_file:=' + self.map_file(room()))
        node.process.wait_for('map=used')
        self.tick()
        self.told.publish(self.pose(Robot.START))
        node.process.wait_for('pose=set')
        self.assertLess(max(self.drive(10, node))[0], 0.15)
        heard = []
        listener = self.rospy.Subscriber('/map', OccupancyGrid, heard.append)
        self.addCleanup(listener.unregister)
        wait_until(lambda: heard, 'the map')
        self.rospy.wait_for_service('/static_map', 20.0)
        for served in (heard[0], self.rospy.ServiceProxy('/static_map', GetMap)().map):
            self.assertEqual(served.header.frame_id, 'map')
            self.assertAlmostEqual(served.info.resolution, RESOLUTION, places=6)
            self.assertEqual((served.info.width, served.info.height), room().shape[::-1])
            self.assertEqual(list(served.data), list(map_message().data))

    def refuse_at_start(self, argument, *words):
        node = self.processes.start([executable('localisation'), '__name:=mistaken', argument], self.main)
        self.assertNotEqual(node.wait(), 0)
        for word in words:
            self.assertIn(word, node.output())
        self.rospy.delete_param('/mistaken')

    def test_maps_of_files_that_are_none_end_it(self):
        self.refuse_at_start('_map_file:=/nowhere/room.yaml', '/nowhere/room.yaml')
        path = self.map_file(room() & False, 'empty')
        self.refuse_at_start('_map_file:=' + path, '~map_file', path, 'has no occupied cell')

    def test_parameters_that_nobody_knows_end_it(self):
        self.refuse_at_start('_sed:=3', "'sed'")
        self.refuse_at_start('_initial_cov_xx:=-1.0', '~initial_cov_xx is -1')


if __name__ == '__main__':
    run_test('localisation', LocalisationTest)
