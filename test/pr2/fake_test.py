#!/usr/bin/env python3
"""The parts of the fake PR2 have the PR2's habits. Needs no ROS."""

import math
import os
import sys
import unittest
import xml.etree.ElementTree as ElementTree

import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from fake import base as bases  # noqa: E402
from fake import hands, joints, laser  # noqa: E402
from fake.routes import Follower, Router  # noqa: E402
from fake.scene import Grid, Pose2, Scene  # noqa: E402

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..'))
WORLD = os.path.join(ROOT, 'worlds', 'restaurant.world')
URDF = os.path.join(ROOT, 'urdf', 'pr2_tray.urdf')
STEP = 0.01  # [s]


class BaseTest(unittest.TestCase):
    def setUp(self):
        self.base = bases.Base(Pose2())

    def drive(self, seconds, *command):
        """Speeds [m/s] at every step; without a command: in silence."""
        speeds = []
        for _ in range(round(seconds / STEP)):
            self.base.begin_turn(STEP)
            if command:
                self.base.command(*command)
            self.base.step(STEP)
            speeds.append(self.base.V_B[0])
        return numpy.array(speeds)

    def test_it_accelerates_as_its_controller_allows(self):
        speeds = self.drive(0.2, 0.5, 0.0, 0.0)
        self.assertAlmostEqual(speeds[9], 0.2, places=9)
        self.assertAlmostEqual(numpy.diff(speeds).max() / STEP, 2.0, places=9)

    def test_it_is_never_faster_than_its_controller_allows(self):
        self.drive(2.0, 3.0, 4.0, 5.0)
        self.assertAlmostEqual(self.base.V_B[0], 0.6)
        self.assertAlmostEqual(self.base.V_B[1], 0.8)
        self.assertAlmostEqual(self.base.V_B[2], 2.0)

    def test_silence_for_a_fifth_of_a_second_stops_it_without_a_ramp(self):
        self.drive(1.0, 0.5, 0.0, 0.0)
        speeds = self.drive(0.5)
        self.assertAlmostEqual(speeds[19], 0.5)
        self.assertAlmostEqual(speeds[20], 0.5 - bases.WHEEL_DECELERATION * STEP)
        self.assertEqual(speeds[-1], 0.0)

    def test_a_late_loop_is_no_silence(self):
        self.drive(1.0, 0.5, 0.0, 0.0)
        self.base.begin_turn(5.0)
        self.base.step(STEP)
        self.assertAlmostEqual(self.base.V_B[0], 0.5)

    def test_halted_motors_stop_it_and_it_stays_until_a_new_command(self):
        self.drive(1.0, 0.5, 0.0, 0.0)
        self.base.is_halted = True
        self.drive(0.5, 0.5, 0.0, 0.0)
        self.assertEqual(self.base.V_B[0], 0.0)
        self.base.is_halted = False
        self.assertEqual(self.drive(0.1)[-1], 0.0)

    def test_wheels_tell_more_turning_than_there_was(self):
        wheels, ekf = bases.Odometer(0.0, 0.03), bases.Odometer(0.0, 0.0)
        for _ in range(100):
            wheels.step(numpy.array([0.0, 0.0, 1.0]), STEP)
            ekf.step(numpy.array([0.0, 0.0, 1.0]), STEP)
        self.assertAlmostEqual(wheels.X_OB.yaw / ekf.X_OB.yaw, 1.03)

    def test_the_joystick_wins_while_it_speaks(self):
        mux = bases.Multiplexer()
        self.assertTrue(mux.admits_navigation(10.0))
        mux.joystick(10.0)
        self.assertFalse(mux.admits_navigation(10.4))
        self.assertTrue(mux.admits_navigation(10.6))


class AmclTest(unittest.TestCase):
    def test_it_speaks_only_when_the_robot_moved(self):
        amcl = bases.Amcl(1)
        self.assertIsNotNone(amcl.update(Pose2(), Pose2()))
        self.assertIsNone(amcl.update(Pose2(0.19), Pose2(0.19)))
        self.assertIsNotNone(amcl.update(Pose2(0.21), Pose2(0.21)))
        self.assertIsNone(amcl.update(Pose2(0.21, 0.0, 0.4), Pose2(0.21, 0.0, 0.4)))
        self.assertIsNotNone(amcl.update(Pose2(0.21, 0.0, 0.5), Pose2(0.21, 0.0, 0.51)))

    def test_it_tells_of_its_uncertainty(self):
        amcl = bases.Amcl(1)
        self.assertEqual(amcl.update(Pose2(), Pose2())[1], bases.Amcl.SPREAD)
        amcl.is_lost = True
        self.assertIsNone(amcl.update(Pose2(), Pose2()))
        amcl.forget()
        self.assertEqual(amcl.update(Pose2(), Pose2())[1], bases.Amcl.LOST_SPREAD)
        self.assertEqual(amcl.update(Pose2(1.0), Pose2(1.0))[1], bases.Amcl.LOST_SPREAD)


class Point:
    def __init__(self, time, positions, velocities=()):
        self.positions, self.velocities = positions, velocities
        self.time_from_start = Time(time)


class Time:
    def __init__(self, seconds):
        self._seconds = seconds

    def to_sec(self):
        return self._seconds


class Trajectory:
    def __init__(self, names, *points, stamp=0.0):
        self.joint_names, self.points = names, points
        self.header = type('Header', (), {'stamp': Time(stamp)})()


class TrajectoryTest(unittest.TestCase):
    def setUp(self):
        with open(URDF) as file:
            self.limits = joints.Limits(file.read())
        self.positions = joints.initial_positions()

    def controller(self, name):
        return joints.TrajectoryController(joints.CONTROLLERS[name], self.limits, self.positions)

    def run_until(self, controller, begin, end):
        for i in range(round((end - begin) / STEP)):
            controller.step(begin + (i + 1) * STEP, STEP)

    def test_every_joint_of_a_pr2_is_there_once(self):
        self.assertEqual(len(joints.NAMES), 45)
        moving = {joint.get('name') for joint in ElementTree.parse(URDF).getroot().findall('joint')
                  if joint.get('type') != 'fixed'}
        self.assertEqual(set(joints.NAMES), moving)

    def test_the_head_follows_a_spline_through_its_points(self):
        head = self.controller('head_traj_controller')
        names = ['head_tilt_joint', 'head_pan_joint']
        head.command(10.0, Trajectory(names, Point(1.0, [0.1, 0.4], [0.0, 0.0]),
                                      Point(2.0, [0.1, 0.8], [0.0, 0.0])))
        self.run_until(head, 10.0, 10.5)
        self.assertAlmostEqual(self.positions['head_pan_joint'], 0.2, places=6)
        self.run_until(head, 10.5, 13.0)
        self.assertAlmostEqual(self.positions['head_pan_joint'], 0.8, places=6)
        self.assertAlmostEqual(self.positions['head_tilt_joint'], 0.1, places=6)

    def test_a_trajectory_of_later_waits(self):
        head = self.controller('head_traj_controller')
        head.command(10.0, Trajectory(['head_pan_joint', 'head_tilt_joint'],
                                      Point(0.0, [0.0, 0.0], [0.0, 0.0]),
                                      Point(1.0, [0.5, 0.0], [0.0, 0.0]), stamp=12.0))
        self.run_until(head, 10.0, 12.0)
        self.assertAlmostEqual(self.positions['head_pan_joint'], 0.0, places=6)

    def test_the_torso_is_slow(self):
        torso = self.controller('torso_controller')
        torso.command(0.0, Trajectory(['torso_lift_joint'], Point(2.0, [0.295], [0.0])))
        self.run_until(torso, 0.0, 10.0)
        self.assertAlmostEqual(self.positions['torso_lift_joint'],
                               joints.TORSO_DOWN + 10.0 * 0.013, places=3)

    def test_a_new_trajectory_takes_over_where_the_old_one_was(self):
        head = self.controller('head_traj_controller')
        names = ['head_pan_joint', 'head_tilt_joint']
        head.command(0.0, Trajectory(names, Point(1.0, [1.0, 0.0])))
        self.run_until(head, 0.0, 0.5)
        head.command(0.5, Trajectory(names, Point(1.0, [0.5, 0.0], [0.0, 0.0])))
        self.run_until(head, 0.5, 2.0)
        self.assertAlmostEqual(self.positions['head_pan_joint'], 0.5, places=6)

    def test_a_joint_that_turns_for_ever_takes_the_short_way(self):
        arm = self.controller('l_arm_controller')
        wanted = [self.positions[name] for name in arm.joints]
        wanted[6] = 2 * math.pi - 0.2
        arm.command(0.0, Trajectory(arm.joints, Point(2.0, wanted)))
        self.run_until(arm, 0.0, 3.0)
        self.assertAlmostEqual(self.positions['l_wrist_roll_joint'], -0.2, places=6)

    def test_a_trajectory_for_other_joints_is_refused(self):
        torso = self.controller('torso_controller')
        refusal = torso.command(0.0, Trajectory(['head_pan_joint'], Point(1.0, [0.1])))
        self.assertIn('head_pan_joint', refusal)
        torso.step(STEP, STEP)
        self.assertEqual(self.positions['torso_lift_joint'], joints.TORSO_DOWN)

    def test_fingers_and_gap_agree_at_both_ends(self):
        self.assertAlmostEqual(joints.finger_angle(0.0), 0.0, delta=0.005)
        self.assertAlmostEqual(joints.finger_angle(0.09), 0.525, delta=0.005)


class HandTest(unittest.TestCase):
    """Tool frames stand still; the left one lies beside the mill, the right one far away."""

    def setUp(self):
        self.tools = {'l': hands.translation(0.5, 0.0, 0.9), 'r': hands.translation(0.0, 0.0, 5.0)}
        self.world = hands.World(Scene(WORLD), lambda link: self.tools[link[0]])
        self.world.move_base(Pose2(5.0, 10.0, 0.0))
        self.world.add('mill', 'peppermill_thesis', 5.5, 10.0, 0.75)
        self.mill, self.hand = self.world.things['mill'], self.world.hands['l']

    def close(self, gap=0.0):
        self.hand.command(gap)
        for _ in range(300):
            self.world.step(STEP)

    def grasp(self):
        self.close(0.09)
        self.close()

    def test_fingers_stop_at_what_is_between_them(self):
        self.grasp()
        self.assertAlmostEqual(self.hand.gap, 0.074)
        self.assertIs(self.hand.held, self.mill)

    def test_fingers_beside_an_object_close(self):
        self.tools['l'] = hands.translation(0.5, 0.08, 0.9)
        self.grasp()
        self.assertEqual(self.hand.gap, 0.0)
        self.assertIsNone(self.hand.held)

    def test_what_is_held_moves_with_the_hand(self):
        self.grasp()
        self.tools['l'] = hands.translation(0.6, 0.1, 1.0)
        numpy.testing.assert_allclose(self.world.pose(self.mill)[:3, 3], (5.6, 10.1, 0.85))

    def test_what_is_let_go_stands_on_what_is_below(self):
        self.grasp()
        self.tools['l'] = hands.translation(0.5, 0.0, 0.91)
        self.close(0.09)
        numpy.testing.assert_allclose(self.world.pose(self.mill)[:3, 3], (5.5, 10.0, 0.75))
        self.assertFalse(self.mill.fell)

    def test_what_is_put_on_the_tray_rides_along(self):
        self.grasp()
        self.world.move_base(Pose2(8.0, 10.5, 0.0))
        self.tools['l'] = hands.translation(0.2, 0.0, 0.505)
        self.close(0.09)
        self.assertEqual(self.mill.parent, 'base')
        self.world.move_base(Pose2(9.0, 10.5, math.pi / 2))
        numpy.testing.assert_allclose(self.world.pose(self.mill)[:3, 3],
                                      (9.0, 10.7, hands.TRAY_TOP), atol=1e-9)

    def test_what_is_let_go_high_above_the_floor_fell(self):
        self.grasp()
        self.world.move_base(Pose2(12.5, 9.8, 0.0))
        self.close(0.09)
        self.assertTrue(self.mill.fell)


    def test_what_counts_as_a_fall_is_the_scenes_to_say(self):
        self.assertEqual(set(hands.read_standing()), {'tilt', 'hold_time', 'drop', 'slide'})
        self.world._standing = {'tilt': 0.5, 'drop': 10.0}
        self.grasp()
        self.world.move_base(Pose2(12.5, 9.8, 0.0))
        self.close(0.09)
        self.assertFalse(self.mill.fell)


class WorldTest(unittest.TestCase):
    def test_the_laser_sees_a_wall_where_it_is(self):
        box = type('B', (), dict(pose=Pose2(3.0, 0.0), size=(1.0, 4.0), radius=None))()
        ranges = laser.Laser([box], 1).scan(Pose2())
        self.assertAlmostEqual(ranges[319], 2.5 - laser.FORWARD, delta=5 * laser.NOISE)
        self.assertTrue(math.isinf(ranges[0]))

    def test_the_laser_sees_a_leg_where_it_is(self):
        leg = type('C', (), dict(pose=Pose2(2.0, 0.0), size=(0.1, 0.1), radius=0.05))()
        ranges = laser.Laser([leg], 1).scan(Pose2())
        self.assertAlmostEqual(ranges[319], 1.95 - laser.FORWARD, delta=5 * laser.NOISE)

    def test_map_and_world_may_lie_elsewhere(self):
        X_MW = Pose2(1.0, 2.0, math.pi / 2)
        plain, moved = Scene(WORLD), Scene(WORLD, X_MW)
        here, there = plain.shapes[0].pose, moved.shapes[0].pose
        self.assertAlmostEqual(there.x, 1.0 - here.y)
        self.assertAlmostEqual(there.y, 2.0 + here.x)

    def test_a_route_leads_around_the_tables_and_is_followed(self):
        scene = Scene(WORLD)
        shapes = scene.within(0.08, 1.35)
        router = Router(map_of(Grid(scene.slice(laser.HEIGHT))), shapes)
        start, goal = Pose2(12.5, 9.8, 2.0), Pose2(7.81, 12.79, -1.57)
        points = router.plan(start, goal)
        follower = Follower(points, goal)
        limits = dict(max_vel_x=0.55, max_vel_trans=0.55, min_vel_trans=0.1, max_vel_theta=1.0,
                      min_vel_theta=0.3, acc_lim_x=2.5, acc_lim_theta=3.2, xy_goal_tolerance=0.2,
                      yaw_goal_tolerance=0.17)
        pose, fastest = start, 0.0
        for i in range(600):
            velocity = follower.update(pose, limits, 0.1)
            if velocity is None:
                break
            fastest = max(fastest, velocity[0])
            pose = pose * Pose2(velocity[0] * 0.1, 0.0, velocity[1] * 0.1)
            clearance = min(shape.distance(pose.x, pose.y) for shape in shapes)
            self.assertGreater(clearance, 0.3, 'step %d' % i)
        self.assertIsNone(velocity)
        self.assertLess(math.hypot(pose.x - goal.x, pose.y - goal.y), 0.2)
        self.assertLessEqual(fastest, 0.55)

    def test_there_is_no_route_under_the_counter(self):
        scene = Scene(WORLD)
        router = Router(map_of(Grid(scene.slice(laser.HEIGHT))), scene.within(0.08, 1.35))
        self.assertIsNone(router.plan(Pose2(12.5, 9.8), Pose2(5.3, 10.07)))


def map_of(grid):
    """What a router reads of a nav_msgs/OccupancyGrid."""
    position = type('P', (), dict(x=grid.x, y=grid.y))()
    info = type('I', (), dict(resolution=grid.resolution, width=grid.width, height=grid.height,
                              origin=type('O', (), dict(position=position))()))()
    return type('M', (), dict(info=info, data=(grid.is_occupied * 100).ravel().tolist()))()


if __name__ == '__main__':
    unittest.main()
