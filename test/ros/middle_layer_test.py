#!/usr/bin/env python3
"""The middle layer and the simulated robot as real processes: driving, arms and hands, breaking off, a
robot that is pushed, objects that vanish or slip, goals that make no sense, goals side by side, the
end of the node. In lockstep, as fast as it goes. Run alone, or by `rostest hires middle_layer.test`.
"""

import math
import os
import re
import signal
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from failures import text_of  # noqa: E402
from robot_system import COUNTER, MUG, RobotSystem  # noqa: E402
from ros_processes import wait_until  # noqa: E402
from test_run import long_case, run_test  # noqa: E402

# Poses of areas in worlds/restaurant.world: x, y [m], yaw [rad].
EAST_TABLE_2 = (11.78, 11.49, 3.14)
START = (12.5, 11.8, 3.14)
TORSO_MIDDLE = 0.2  # [m]
ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..'))
TOPPLE = os.path.join(ROOT, 'config', 'scenarios', 'topple.yaml')
WEST_TABLE_2 = (9.0, 11.49, 0.0)
TABLE_2 = (10.28, 11.49)  # its centre
TABLE_EDGE = 0.7  # [m]; it stands along the axes
XY_TOLERANCE, YAW_TOLERANCE = 0.2, 0.17  # config/scene.yaml
STOPPING = 0.08  # [m] the base rolls on a little after it counts as arrived


def distance(state, pose):
    return math.hypot(state.pose.position.x - pose[0], state.pose.position.y - pose[1])


def speed(state):
    return math.hypot(state.twist.linear.x, state.twist.linear.y)


class DriveWatch:
    """What is shown of drives from now on: paths and costmaps in order."""

    def __init__(self, rospy):
        from nav_msgs.msg import OccupancyGrid, Path
        self.paths, self.costmaps = [], []
        self._subscribers = [
            rospy.Subscriber('navigation/plan', Path, self.paths.append),
            rospy.Subscriber('navigation/local_costmap', OccupancyGrid, self.costmaps.append)]
        wait_until(lambda: all(s.get_num_connections() for s in self._subscribers),
                   'what is shown of drives')

    def stop(self):
        for subscriber in self._subscribers:
            subscriber.unregister()

    def has_begun(self):
        return bool(self.paths and self.costmaps)

    def is_over(self):
        return (self.has_begun() and not self.paths[-1].poses and
                self.costmaps[-1].data == (-1,))


def cells_of(grid):
    """(x, y of the centre [m], value) of a grid along the axes."""
    resolution, origin = grid.info.resolution, grid.info.origin.position
    for index, value in enumerate(grid.data):
        row, column = divmod(index, grid.info.width)
        yield (origin.x + (column + 0.5) * resolution, origin.y + (row + 0.5) * resolution, value)


def documented_topics(section):
    """{topic: type} that a table of docs/ros_api.md says a node publishes."""
    with open(os.path.join(ROOT, 'docs', 'ros_api.md'), encoding='utf-8') as page:
        text = page.read().split('\n## %s\n' % section)[1].split('\n## ')[0]
    topics = {}
    for row in re.findall(r'^\|(.*)\|$', text, re.MULTILINE):
        names, kind, types = row.split('|')[:3]
        kinds = [word.strip() for word in kind.split(',') if word.strip() != 'latched']
        names, types = re.findall(r'`([\w/{},~]+)`', names), re.findall(r'`(\w+/\w+)`', types)
        names = [name for name in names if not name.startswith('~')]
        for index, name in enumerate(names):
            if (kinds * len(names))[index] == 'publishes':
                for side in ('l', 'r'):
                    topics['/' + name.lstrip('/').replace('{l,r}', side)] = (types * len(names))[index]
    return topics


class MiddleLayerTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.system = RobotSystem(uncertainty='none', lockstep=True, pace=0.0)
        cls.addClassCleanup(cls.system.stop)
        cls.system.connect('middle_layer_test')
        cls.codes = cls.system.codes

    def setUp(self):
        self.begin()

    def begin(self, **robot):
        self.system.end_processes()
        self.system.start_robot(**robot)
        self.system.start_middle_layer()
        self.system.require_ready()

    def begin_at_counter(self):
        """Ready to grasp the mug, which stands before the robot."""
        self.system.tell({'mug1': ('coffee_cup', *MUG)})
        self.begin(scenario=self.system.processes.write('counter.yaml', COUNTER))

    def tearDown(self):
        self.assertTrue(self.system.robot.is_running(), self.system.robot.output())
        self.system.end_processes()

    def require(self, result, code, reason=''):
        self.assertEqual((result.code, text_of(result.failure)), (code, reason), self.system.output())
        return result

    def require_arrival(self, pose, tolerance):
        self.system.wait_for_truth(
            lambda s: speed(s) < 0.02 and distance(s, pose) < tolerance,
            'the robot to stand within %g m of %s' % (tolerance, pose))

    def path_from(self, first):
        return [state for _, state in self.system.truth[first:]]

    def execute_until(self, condition, what, *words):
        """An action that is at work, in a world that is held from then on.
        @param condition  of the robot's true state."""
        self.system.hold(True)
        goal = self.system.execute(*words).wait_for_active()
        self.system.step_until(condition, what)
        return goal

    def preempt(self, goal):
        """In a world that is held until the cancel was taken."""
        goal.cancel().wait_until_cancelling()
        self.system.hold(False)
        self.require(goal.result(), self.codes.PREEMPTED)

    # Driving

    def watch_drive(self):
        watch = DriveWatch(self.system.rospy)
        self.addCleanup(watch.stop)
        return watch

    def require_path(self, path, start, goal):
        """From where the robot stood to its goal, in the map."""
        self.assertEqual(path.header.frame_id, 'map')
        first, last = path.poses[0].pose, path.poses[-1].pose
        self.assertLess(math.hypot(first.position.x - start[0], first.position.y - start[1]), 0.05)
        self.assertLess(math.hypot(last.position.x - goal[0], last.position.y - goal[1]),
                        XY_TOLERANCE)
        yaw = 2.0 * math.atan2(last.orientation.z, last.orientation.w)
        self.assertLess(abs(math.remainder(yaw - goal[2], 2.0 * math.pi)), YAW_TOLERANCE)

    def require_table_2(self, costmap):
        """Obstacles are where the table is, to a cell, and not west and east of it; chairs stand to
        its north and south."""
        self.assertEqual(costmap.header.frame_id, 'map')
        half, cell = TABLE_EDGE / 2, costmap.info.resolution
        inside = outside = 0
        for x, y, value in cells_of(costmap):
            if abs(y - TABLE_2[1]) > half - cell:
                continue
            off = abs(x - TABLE_2[0])
            if off < half - cell:
                inside += 1
                self.assertEqual(value, 100, (x, y))
            elif half + cell < off < half + 10 * cell:
                outside += 1
                self.assertTrue(0 <= value < 100, (x, y, value))
        self.assertGreaterEqual(inside, 100)
        self.assertGreaterEqual(outside, 100)

    def test_shows_its_path_and_costmap_until_it_is_broken_off(self):
        watch = self.watch_drive()
        goal = self.execute_until(lambda s: distance(s, START) > 0.5, 'the robot to be on its way',
                                  'move_base', 'preManipulationAreaWestTable2')
        wait_until(watch.has_begun, 'path and costmap')
        self.require_path(watch.paths[0], START, WEST_TABLE_2)
        self.require_table_2(watch.costmaps[0])
        self.preempt(goal)
        wait_until(watch.is_over, 'no path and no costmap')

    def test_publishes_only_what_is_documented(self):
        types = self.system.main.topic_types()
        published = {topic: types[topic] for topic, nodes in self.system.main.publishers().items()
                     if '/middle_layer' in nodes and topic != '/rosout' and
                     not topic.startswith('/execute_action/')}
        documented = documented_topics('middle_layer')
        # This robot's base has no guard and no multiplexer before it.
        documented['/base_controller/command'] = documented['/navigation/cmd_vel']
        self.assertEqual({topic: documented.get(topic) for topic in published}, published)
        self.assertLessEqual({'/navigation/plan', '/navigation/local_costmap'}, set(published))

    def test_drives_to_an_area_round_obstacles(self):
        watch = self.watch_drive()
        goal = self.system.execute('move_base', 'preManipulationAreaEastTable2')
        result = self.require(goal.result(), self.codes.SUCCEEDED)
        self.require_arrival(EAST_TABLE_2, XY_TOLERANCE + STOPPING)
        self.assertGreater(result.duration, 1.0)
        wait_until(watch.is_over, 'no path and no costmap')
        self.require_path(watch.paths[0], START, EAST_TABLE_2)

    @long_case
    def test_motion_sets_bound_the_speed(self):
        fastest = {}
        for motion_set, area in (('slow', 'preManipulationAreaWestTable2'),
                                 ('fast', 'nearStartArea1')):
            first = len(self.system.truth)
            goal = self.system.execute('move_base_param', area, motion_set)
            self.require(goal.result(), self.codes.SUCCEEDED)
            fastest[motion_set] = max(map(speed, self.path_from(first)))
        self.assertLess(fastest['slow'], 0.33)
        self.assertGreater(fastest['fast'], 0.45)

    def test_drives_blindly(self):
        goal = self.system.execute('move_base_blind', 'home')
        self.require(goal.result(), self.codes.SUCCEEDED)
        self.require_arrival((13.0, 11.3), 0.05)

    @long_case
    def test_a_pushed_robot_plans_anew_and_arrives(self):
        goal = self.execute_until(lambda s: distance(s, START) > 0.5, 'the robot to be on its way',
                                  'move_base', 'preManipulationAreaWestTable2')
        answer = self.system.call('push', self.system.srv.PushRobot,
                                  offset=self.pose_2d(-0.2, 0.4, 0.5))
        self.assertTrue(answer.success, answer.message)
        self.system.hold(False)
        self.require(goal.result(), self.codes.SUCCEEDED)
        self.require_arrival((9.0, 11.49), XY_TOLERANCE + STOPPING)

    def pose_2d(self, x, y, theta):
        from geometry_msgs.msg import Pose2D
        return Pose2D(x=x, y=y, theta=theta)

    # Breaking off

    def test_preempting_a_drive_leaves_the_robot_standing(self):
        goal = self.execute_until(lambda s: speed(s) > 0.4, 'the robot to be fast',
                                  'move_base', 'preManipulationAreaEastCounter1')
        first = len(self.system.truth)
        self.preempt(goal)
        self.system.wait_for_truth(lambda s: speed(s) < 0.02, 'the robot to stand')
        after = self.path_from(first)
        braking = [(a, b) for a, b in zip(after, after[1:]) if speed(b) < speed(a)]
        # 1 m/s^2 as configured, in steps of 0.05 s; the base's velocity loop swings a little.
        self.assertLess(max(speed(a) - speed(b) for a, b in braking), 2.0 * 0.05)

    @long_case
    def test_preempting_a_blind_drive_leaves_the_robot_standing(self):
        goal = self.execute_until(lambda s: speed(s) > 0.1, 'the robot to move',
                                  'move_base_blind', 'preManipulationAreaEastTable2')
        self.preempt(goal)
        self.system.wait_for_truth(lambda s: speed(s) < 0.02, 'the robot to stand')

    @long_case
    def test_the_time_limit_ends_a_drive(self):
        goal = self.system.execute('move_base', 'preManipulationAreaEastCounter1', limit=2.0)
        result = self.require(goal.result(), self.codes.FAILED, 'timed_out')
        self.assertGreater(result.duration, 2.0)
        self.system.wait_for_truth(lambda s: speed(s) < 0.02, 'the robot to stand')

    def test_the_robot_stands_when_the_node_ends(self):
        for number in (signal.SIGINT, signal.SIGKILL):
            with self.subTest(signal=number):
                self.execute_until(lambda s: speed(s) > 0.3, 'the robot to be fast',
                                   'move_base', 'preManipulationAreaEastCounter1')
                self.system.middle_layer.signal(number)
                self.system.middle_layer.wait()
                self.system.hold(False)
                self.system.wait_for_truth(lambda s: speed(s) < 0.02, 'the robot to stand')
                self.system.start_middle_layer()
                self.system.require_server()

    # Arms and hands

    def joints(self):
        state = self.system.truth[-1][1]
        return dict(zip(state.joints.name, state.joints.position))

    def require_standing_joints(self):
        """Within a second no joint moves any more."""
        since = self.system.truth[-1][0] + 10 ** 9
        self.system.wait_for_truth(lambda _: self.system.truth[-1][0] > since + 10 ** 9 // 2,
                                   'time to go on')
        states = [state.joints.position for stamp, state in self.system.truth if stamp > since]
        for state in states[1:]:
            for before, after in zip(states[0], state):
                self.assertAlmostEqual(before, after, delta=1e-3)

    def test_what_needs_different_joints_runs_side_by_side(self):
        self.begin(scenario=TOPPLE)
        self.system.wait_for_truth(lambda s: True, 'the truth')
        self.system.hold(True)  # all begin at one moment
        goals = [self.system.execute(*words).wait_for_active() for words in (
            ('move_base', 'preManipulationAreaEastTable2'),
            ('tuck_arms', 'armTuckedPosture', 'armTuckedPosture'),
            ('move_torso', 'torsoMiddlePosture'))]
        first = len(self.system.truth)
        self.system.hold(False)
        durations = [self.require(goal.result(), self.codes.SUCCEEDED).duration for goal in goals]

        def is_done(state):
            torso = dict(zip(state.joints.name, state.joints.position))['torso_lift_joint']
            return (abs(torso - TORSO_MIDDLE) < 0.02 and
                    distance(state, EAST_TABLE_2) < XY_TOLERANCE + STOPPING)
        self.system.wait_for_truth(is_done, 'the robot to be there with its torso up')
        took = next(stamp for stamp, state in self.system.truth[first:] if is_done(state))
        took -= self.system.truth[first - 1][0]
        self.assertLess(took * 1e-9, sum(durations))

    @long_case
    def test_preempting_the_torso_leaves_it_where_it_is(self):
        self.begin(scenario=TOPPLE)
        goal = self.execute_until(lambda s: self.joints()['torso_lift_joint'] > 0.05,
                                  'the torso to rise', 'move_torso', 'torsoUpPosture')
        self.preempt(goal)
        self.require_standing_joints()
        self.assertLess(self.joints()['torso_lift_joint'], 0.29)

    @long_case
    def test_preempting_arms_leaves_them_where_they_are(self):
        self.begin(scenario=TOPPLE)
        goal = self.execute_until(lambda s: self.joints()['r_shoulder_lift_joint'] < 0.7,
                                  'the right arm to move',
                                  'tuck_arms', 'armTuckedPosture', 'armTuckedPosture')
        self.preempt(goal)
        self.require_standing_joints()

    def held(self):
        """{object: link}, as it really is."""
        return {o.name: o.attached_to for o in self.world.objects if o.attached_to}

    def watch_world(self):
        from hires.msg import WorldState

        def note(world):
            self.world = world
        subscriber = self.system.rospy.Subscriber('ground_truth/world_state', WorldState, note)
        self.addCleanup(subscriber.unregister)

    def pick_up_until(self, phase):
        """The goal, in a world that is held."""
        self.system.hold(True)
        goal = self.system.execute('pick_up_object', 'mug1', 'rightArm1').wait_for_active()
        self.system.step_until(lambda _: any(f.phase == phase for f in goal.feedback), phase)
        return goal

    def test_picks_up_and_places(self):
        self.begin_at_counter()
        self.watch_world()
        goal = self.system.execute('pick_up_object', 'mug1', 'rightArm1')
        self.require(goal.result(), self.codes.SUCCEEDED)
        wait_until(lambda: self.held() == {'mug1': 'r_gripper_palm_link'}, 'the mug to be held')
        phases = [feedback.phase for feedback in goal.feedback]
        self.assertIn('close_gripper', phases)
        goal = self.system.execute('place_object', 'mug1', 'rightArm1',
                                   'placingAreaEastRightCounter1')
        self.require(goal.result(), self.codes.SUCCEEDED)
        wait_until(lambda: not self.held(), 'the mug to be let go')

    @long_case
    def test_preempting_while_holding_keeps_what_is_held(self):
        self.begin_at_counter()
        self.watch_world()
        self.preempt(self.pick_up_until('lift'))
        self.require_standing_joints()
        self.assertEqual(self.held(), {'mug1': 'r_gripper_palm_link'})
        goal = self.system.execute('place_object', 'mug1', 'rightArm1',
                                   'placingAreaEastRightCounter1')
        goal.result()  # whatever it can do from there: the next one is taken

    @long_case
    def test_an_object_that_vanishes_before_it_is_grasped_is_missed(self):
        self.begin_at_counter()
        goal = self.pick_up_until('reach')
        answer = self.system.call('remove_object', self.system.srv.ObjectRequest, name='mug1')
        self.assertTrue(answer.success, answer.message)
        self.system.hold(False)
        result = goal.result()
        self.assertEqual(result.code, self.codes.FAILED)
        self.assertIn(text_of(result.failure), ('grasp_failed', 'object_not_seen', 'object_slipped'))

    @long_case
    def test_an_object_that_slips_away_is_missed_when_it_is_placed(self):
        self.begin_at_counter()
        goal = self.system.execute('pick_up_object', 'mug1', 'rightArm1')
        self.require(goal.result(), self.codes.SUCCEEDED)
        answer = self.system.call('drop', self.system.srv.ObjectRequest, name='mug1')
        self.assertTrue(answer.success, answer.message)
        result = self.system.execute('place_object', 'mug1', 'rightArm1',
                                     'placingAreaEastRightCounter1').result()
        self.assertEqual((result.code, text_of(result.failure)), (self.codes.FAILED, 'object_slipped'))

    # Goals

    def test_goals_that_make_no_sense_are_refused_with_the_reason(self):
        bad = [
            (('juggle', 'mug1'), 'juggle'),
            (('move_base',), '1 (area)'),
            (('move_base', 'a', 'b'), '1 (area)'),
            (('move_base', 'preManipulationAreaNorthCounter1'), 'preManipulationAreaNorthCounter1'),
            (('move_base_param', 'home', 'sideways'), 'sideways'),
            (('', ), "action ''"),
        ]
        for words, expected in bad:
            with self.subTest(goal=words):
                result = self.system.execute(*words).result()
                self.assertEqual(result.code, self.codes.INVALID, text_of(result.failure))
                self.assertIn(expected.lower(), text_of(result.failure).lower())
        result = self.system.execute('move_base', 'home', limit=-1.0).result()
        self.assertEqual(result.code, self.codes.INVALID)
        self.assertIn('time_limit', text_of(result.failure))

    def test_a_conflicting_goal_is_refused_and_disturbs_nobody(self):
        self.system.hold(True)
        first = self.system.execute('move_base', 'preManipulationAreaEastTable2').wait_for_active()
        second = self.system.execute('move_base_blind', 'home').result()
        self.system.hold(False)
        self.assertEqual(second.code, self.codes.INVALID)
        self.assertEqual(text_of(second.failure),
                         'busy: move_base(preManipulationAreaEastTable2) needs base')
        self.require(first.result(), self.codes.SUCCEEDED)

    def test_feedback_tells_how_long_it_runs(self):
        goal = self.system.execute('move_base', 'preManipulationAreaEastTable2')
        result = self.require(goal.result(), self.codes.SUCCEEDED)
        elapsed = [feedback.elapsed for feedback in goal.feedback]
        self.assertEqual(elapsed, sorted(elapsed))
        self.assertGreater(len(elapsed), 5)
        self.assertLessEqual(elapsed[-1], result.duration)

    def test_diagnostics_say_what_runs(self):
        from diagnostic_msgs.msg import DiagnosticArray
        seen = []
        subscriber = self.system.rospy.Subscriber('/diagnostics', DiagnosticArray, seen.append)
        self.addCleanup(subscriber.unregister)
        self.system.hold(True)
        goal = self.system.execute('move_base', 'preManipulationAreaEastCounter1')

        def is_told():
            return any(value.key == 'running' and 'move_base' in value.value
                       for array in list(seen) for status in array.status
                       for value in status.values)
        wait_until(is_told, 'the diagnostics to name the action')
        self.preempt(goal)


if __name__ == '__main__':
    run_test('middle_layer_node', MiddleLayerTest)
