#!/usr/bin/env python3
"""A simulated robot that does not tell its place, as launch/closed_loop.launch starts it with
localisation:=nodes: odometry_filter and localisation find it by wheels, inertial unit, laser and map, and the
middle layer drives by what they say. Run alone, or by `rostest hires own_place.test`."""

import bisect
import math
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from diagnostics import diagnostics  # noqa: E402
from failures import text_of  # noqa: E402
from robot_system import RobotSystem  # noqa: E402
from ros_processes import executable, wait_until  # noqa: E402
from scanned_room import after, wrapped, yaw_of  # noqa: E402
from test_run import run_test  # noqa: E402

FAR, FAR_PLACE = 'preManipulationAreaEastCounter1', (6.8, 10.11)
NEAR, NEAR_PLACE = 'preManipulationAreaEastTable2', (11.78, 11.49)
OFF = 0.15                  # [m] by which the believed place may be off
TOLERANCE = 0.2 + 0.08      # [m] goal tolerance and rolling on
AHEAD = 100000000           # [ns] transform_tolerance of config/localisation.yaml
STANDS = 0.02               # [m/s]


def speed(state):
    return math.hypot(state.twist.linear.x, state.twist.linear.y)


def planar(pose):
    return pose.position.x, pose.position.y, yaw_of(pose.orientation)


class Belief:
    """Where tf says that the base is, and who says it."""

    def __init__(self, rospy):
        from tf2_msgs.msg import TFMessage
        self.X_MO, self.X_OB = {}, {}  # by stamp [ns]
        self.tellers = set()
        self._subscriber = rospy.Subscriber('/tf', TFMessage, self._take, queue_size=10000, tcp_nodelay=True)

    def _take(self, message):
        for transform in message.transforms:
            stamp, t = transform.header.stamp.to_nsec(), transform.transform
            pose = t.translation.x, t.translation.y, yaw_of(t.rotation)
            frames = transform.header.frame_id, transform.child_frame_id
            if frames == ('map', 'odom_combined'):
                self.X_MO[stamp - AHEAD] = pose
            elif frames == ('odom_combined', 'base_footprint'):
                self.X_OB[stamp] = pose
            else:
                continue
            self.tellers.add((frames[0], message._connection_header['callerid']))

    def errors(self, truth, since=0):
        """[(m, rad)] at the moments [ns] of the truth of which tf says something."""
        corrected = sorted(self.X_MO)
        found = []
        for stamp, state in truth:
            newest = bisect.bisect_right(corrected, stamp) - 1
            if stamp < since or newest < 0 or stamp not in self.X_OB:
                continue
            believed, true = after(self.X_MO[corrected[newest]], self.X_OB[stamp]), planar(state.pose)
            found.append((math.dist(believed[:2], true[:2]), abs(wrapped(believed[2] - true[2]))))
        return found

    def close(self):
        self._subscriber.unregister()


class OwnPlaceTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.system = RobotSystem(seed=5, tells_place=False)
        cls.addClassCleanup(cls.system.stop)
        cls.system.connect('own_place_test')
        cls.codes = cls.system.codes

    def begin(self, **arguments):
        system = self.system
        if system.rospy.has_param('/localisation'):
            system.rospy.delete_param('/localisation')  # where an earlier robot was
        self.belief = Belief(system.rospy)
        self.addCleanup(self.belief.close)
        self.addCleanup(system.end_processes)
        system.start_robot(**arguments)
        system.start_middle_layer(lockstep=arguments['lockstep'])
        self.nodes = {}
        self.start('odometry_filter', 'odom:=base_odometry/odom', 'imu_data:=torso_lift_imu/data')
        self.start('localisation')

    def start(self, name, *arguments):
        self.nodes[name] = self.system.processes.start(
            [executable(name), '__name:=' + name, *arguments], self.system.main)
        self.addCleanup(self.nodes[name].destroy)
        return self.nodes[name]

    def output(self):
        return '\n'.join([self.system.output()] + [node.output() for node in self.nodes.values()])

    def drive(self, area, place):
        """There; the robot's true state once it stands there."""
        result = self.system.execute('move_base', area).result()
        self.assertEqual((result.code, text_of(result.failure)), (self.codes.SUCCEEDED, ''), self.output())
        state = self.system.wait_for_truth(lambda s: speed(s) < STANDS, 'the robot to stand')
        self.assertLess(math.dist((state.pose.position.x, state.pose.position.y), place), TOLERANCE + OFF)

    def require_belief(self, since=0):
        errors = self.belief.errors(self.system.truth, since)
        self.assertGreater(len(errors), 20)
        worst = tuple(map(max, zip(*errors)))
        print('believed place off by %.3f m, %.3f rad at worst, in %d moments' % (*worst, len(errors)))
        self.assertLess(worst[0], OFF)

    def test_a_robot_that_finds_its_place_drives_and_arrives(self):
        """In lockstep: the robot waits at each tick until it is localised and its skill has answered."""
        self.begin(lockstep=True, pace=0.0)
        self.system.require_ready()
        self.drive(FAR, FAR_PLACE)
        self.require_belief()
        self.assertEqual(self.belief.tellers, {('map', '/localisation'), ('odom_combined', '/odometry_filter')})
        self.assertEqual(self.system.main.publishers('/amcl_pose'), ['/localisation'])
        diagnostics(self.system.rospy, 'odometry_filter', lambda v: v['message'] == 'wheels and inertial unit')

    def test_a_robot_whose_localisation_dies_stops_and_goes_on_with_another_one(self):
        """Time goes on whatever happens, at half its pace: six processes share the computer with other tests. The
        new localisation is told nothing: it knows where the old one was."""
        self.begin(lockstep=False, pace=0.5)
        self.system.require_ready()
        goal = self.system.execute('move_base', FAR)
        self.system.wait_during(goal, lambda s: speed(s) > 0.3, 'the robot to be fast')
        wait_until(lambda: self.system.rospy.has_param('/localisation/initial_odometry_time'), 'a place to be kept')
        self.nodes['localisation'].kill()
        result = goal.result()
        self.assertEqual((result.code, text_of(result.failure).split(':')[0]),
                         (self.codes.FAILED, 'stale_observation'), self.output())
        self.system.wait_for_truth(lambda s: speed(s) < STANDS, 'the robot to stand')
        since = self.system.truth[-1][0]
        self.start('localisation').wait_for('pose=set')
        wait_until(lambda: max(self.belief.X_MO) > since, lambda: 'the new localisation\n' + self.output())
        self.drive(NEAR, NEAR_PLACE)
        self.require_belief(since)


if __name__ == '__main__':
    run_test('own_place', OwnPlaceTest)
