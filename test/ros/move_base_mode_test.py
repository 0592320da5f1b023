#!/usr/bin/env python3
"""Long ways driven by a robot's own move_base: middle layer, guard of the base, a move_base and a
PR2 that is none as real processes. Goals that are reached, given up, taken back or taken over by
somebody else; processes that are killed in the middle of a drive. Run alone, or by
`rostest hires move_base_mode.test`."""

import math
import os
import signal
import sys
import unittest

import yaml

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, 'support'))

from failures import text_of  # noqa: E402
from move_base_system import FAST, ROOT, SLOW, MoveBaseSystem, config_text  # noqa: E402
from action_goal import ActionGoal, require_server  # noqa: E402
from diagnostics import wait_for_guard, wait_for_middle_layer  # noqa: E402
from robot_system import SKILL_LIMIT  # noqa: E402
from ros_processes import LIMIT, Processes, executable, wait_until  # noqa: E402
from scene_file import read_scene  # noqa: E402
from test_run import run_test  # noqa: E402

# preManipulationAreaEastTable2 of worlds/restaurant.world: x, y [m], yaw [rad].
AREA, NAME = (11.78, 11.49, 3.14), 'preManipulationAreaEastTable2'
FAR = (13.28, 11.49, 3.14)
XY_TOLERANCE, YAW_TOLERANCE = 0.2, 0.17  # config/scene.yaml
LOCALISATION = 0.08  # [m] what the fake PR2's may be wrong by, and what it rolls on


class Base:
    """What the base does, and what it is told."""

    def __init__(self, rospy):
        from actionlib_msgs.msg import GoalID
        from geometry_msgs.msg import Twist
        from hires.msg import BaseGuardState
        from move_base_msgs.msg import MoveBaseActionGoal
        from nav_msgs.msg import Odometry
        self.truth = None
        self.commands, self.goals, self.cancels, self.guard_states = [], [], [], []

        def listen(topic, kind, callback):
            return rospy.Subscriber(topic, kind, callback, queue_size=1000, tcp_nodelay=True)
        listen('fake_pr2/truth', Odometry, self._note)
        listen('navigation/cmd_vel', Twist, self.commands.append)
        listen('base_guard/state', BaseGuardState, self.guard_states.append)
        self._asked = (listen('move_base/goal', MoveBaseActionGoal, self.goals.append),
                       listen('move_base/cancel', GoalID, self.cancels.append))

    def _note(self, truth):
        self.truth = truth

    def hears_who_asks(self):
        return all(subscriber.get_num_connections() > 0 for subscriber in self._asked)

    def forget(self):
        self.truth = None
        for heard in (self.commands, self.goals, self.cancels, self.guard_states):
            heard.clear()

    def guard_has_stopped(self):
        """That it let velocities pass, and does not any more."""
        has_passed = any(said.state == said.PASSING for said in self.guard_states)
        return has_passed and self.guard_states[-1].state == self.guard_states[-1].STANDING

    def speed(self):
        return math.hypot(self.truth.twist.twist.linear.x, self.truth.twist.twist.linear.y)

    def distance_to(self, pose):
        here = self.truth.pose.pose.position
        return math.hypot(here.x - pose[0], here.y - pose[1])


def patient_scene():
    """The configured scene, from any folder; a loaded computer may keep sensors waiting."""
    scene = read_scene()
    scene['sensing']['robot_state']['stale_after'] = 3.0
    return yaml.safe_dump(scene)


class MoveBaseModeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.processes = Processes()
        cls.addClassCleanup(cls.processes.stop_all)
        cls.main = cls.processes.master()
        os.environ.update(ROS_MASTER_URI=cls.main.uri, ROS_IP='127.0.0.1')
        os.environ.pop('ROS_HOSTNAME', None)
        import actionlib
        import rospy
        from hires import msg
        cls.actionlib, cls.rospy, cls.msg = actionlib, rospy, msg
        cls.codes = msg.ExecuteActionResult
        rospy.init_node('move_base_mode_test', disable_signals=True)
        cls.base = Base(rospy)
        cls.system = MoveBaseSystem(cls.processes, cls.main, rospy)
        cls.client = actionlib.ActionClient('execute_action', msg.ExecuteActionAction)
        text = config_text('middle_layer.yaml')
        scene = cls.processes.write('scene.yaml', patient_scene())
        for key, file, path in (('scene', 'scene.yaml', scene),
                                ('config', 'base_guard.yaml',
                                 os.path.join(ROOT, 'config', 'base_guard.yaml'))):
            text = text.replace('%s: %s' % (key, file), '%s: %s' % (key, path))
        cls.config = cls.processes.write('middle_layer.yaml', text)

    def setUp(self):
        self.base.forget()
        self.started = []
        self.journal = os.path.join(self.processes.folder.name, 'journal_%s.yaml' % self.id())

    def tearDown(self):
        for process in reversed(self.started):
            process.signal(signal.SIGCONT)
            process.destroy()

    # What is started.

    def begin(self, pose, **move_base):
        self.start_pr2(pose)
        self.move_base = self.keep(self.system.start_move_base(
            'cmd_vel:=base_guard/cmd_vel', **move_base))
        self.guard = self.keep(self.system.start_guard(self.journal))
        self.start_middle_layer()

    def keep(self, process):
        self.started.append(process)
        return process

    def start_pr2(self, pose):
        for name, value in (('world', os.path.join(ROOT, 'worlds', 'restaurant.world')),
                            ('urdf', os.path.join(ROOT, 'urdf', 'pr2_tray.urdf')),
                            ('pose', list(pose))):
            self.rospy.set_param('/fake_pr2/' + name, value)
        self.pr2 = self.keep(self.processes.start(
            [sys.executable, os.path.join(ROOT, 'test', 'pr2', 'fake_pr2.py')], self.main))
        self.wait_for(lambda: self.base.truth, 'the fake PR2')

    def start_middle_layer(self):
        self.middle_layer = self.keep(self.processes.start(
            [executable('middle_layer'), '_config:=' + self.config, '_guard:=true',
             '_navigation:=move_base'], self.main))
        require_server(self.client, self.output)
        self.wait_for(self.base.hears_who_asks, 'the middle layer')
        wait_for_middle_layer(self.rospy)
        wait_for_guard(self.rospy)

    def wait_for(self, condition, what):
        """With what everybody said where it is in vain."""
        try:
            wait_until(condition, what)
        except AssertionError as error:
            self.fail('%s\n%s' % (error, self.output()))

    # What is asked for.

    def execute(self, name=NAME, motion_set='slow'):
        goal = self.msg.ExecuteActionGoal()
        goal.action.name, goal.action.arguments = 'move_base_param', [name, motion_set]
        return ActionGoal(self.client, goal, SKILL_LIMIT)

    def drive(self):
        """On its way by a move_base that would never arrive."""
        self.begin(FAR, behaviour='drive')
        goal = self.execute()
        self.wait_for(lambda: self.base.speed() > 0.15, 'the base to move')
        self.assertEqual(self.system.values(), SLOW)
        return goal

    def require(self, goal, code, pattern='^'):
        result = goal.result()
        self.assertEqual(result.code, code, '%s\n%s' % (result, self.output()))
        self.assertRegex(text_of(result.failure), pattern)

    def require_stand(self):
        self.wait_for(lambda: self.base.speed() < 0.01, 'the base to stand')

    def output(self):
        return '\n'.join(process.output() for process in self.started)

    # Tests.

    def test_a_goal_goes_to_move_base_with_the_set_and_the_rest_is_driven_straight(self):
        self.begin((12.13, 11.49, 3.14), behaviour='arrive')  # 0.35 m short, and it says it is there
        goal = self.execute()
        goal.wait_for_feedback(lambda f: f.phase == 'last_stretch', 'the last stretch')
        self.assertEqual(self.system.values(), SLOW)
        self.require(goal, self.codes.SUCCEEDED)
        self.assertLess(self.base.distance_to(AREA), LOCALISATION)
        self.system.await_values(FAST)
        self.assertEqual(len(self.base.goals), 1)
        pose = self.base.goals[0].goal.target_pose
        self.assertEqual(pose.header.frame_id, 'map')
        self.assertAlmostEqual(pose.pose.position.x, AREA[0])
        self.assertAlmostEqual(pose.pose.position.y, AREA[1])
        self.assertAlmostEqual(2 * math.atan2(pose.pose.orientation.z, pose.pose.orientation.w),
                               AREA[2])
        self.assertLessEqual(max(math.hypot(c.linear.x, c.linear.y) for c in self.base.commands),
                             SLOW[0] + 1e-9)

    def test_an_arrival_within_our_tolerances_is_one(self):
        self.begin((11.90, 11.49, 3.14), behaviour='arrive')
        self.require(self.execute(), self.codes.SUCCEEDED)
        self.assertEqual([c.linear.x for c in self.base.commands if c.linear.x], [])

    def test_an_arrival_far_off_is_none(self):
        self.begin(FAR, behaviour='arrive')
        self.require(self.execute(), self.codes.FAILED, r'^goal_missed: 1\.[45]')
        self.system.await_values(FAST)

    def test_what_move_base_gives_up_for_is_the_reason_and_the_set_is_gone_after(self):
        still = ' Even after executing recovery behaviors.'
        self.begin(FAR, behaviour='abort')
        for text, reason in (('Failed to find a valid plan.', '^unreachable$'),
                             ('Failed to find a valid control.', '^stuck$')):
            self.rospy.set_param('/move_base_node/text', text + still)
            self.require(self.execute(), self.codes.FAILED, reason)
            self.system.await_values(FAST)

    def test_a_goal_that_is_taken_back_is_so_at_move_base_too(self):
        goal = self.drive()
        goal.cancel()
        self.require(goal, self.codes.PREEMPTED)
        self.require_stand()
        taken_back = self.base.goals[0].goal_id.id
        wait_until(lambda: taken_back in [c.id for c in self.base.cancels],
                   'move_base to be told')
        self.system.await_values(FAST)

    def test_somebody_else_who_takes_move_base_moves_nothing(self):
        from move_base_msgs.msg import MoveBaseAction, MoveBaseGoal
        goal = self.drive()
        other = self.actionlib.ActionClient('move_base', MoveBaseAction)
        # Not only a connection: we listen to these goals ourselves.
        self.assertTrue(other.wait_for_server(self.rospy.Duration(LIMIT)))
        theirs = ActionGoal(other, MoveBaseGoal())
        self.require(goal, self.codes.FAILED, '^interrupted$')
        # Until the guard hears of that their velocities may pass; between two goals the base may stand.
        self.wait_for(self.base.guard_has_stopped, 'the guard to let nothing pass')
        self.require_stand()
        stood = self.base.truth.pose.pose.position
        theirs.result()  # the guard takes it back
        self.assertLess(self.base.speed(), 0.01)
        self.assertLess(self.base.distance_to((stood.x, stood.y)), 0.01)
        self.system.await_values(FAST)

    def test_a_killed_middle_layer_leaves_a_robot_that_stands_and_a_planner_with_its_own_values(self):
        self.drive()
        self.middle_layer.kill()
        self.require_stand()
        self.system.await_values(FAST)
        self.wait_for(lambda: self.base.cancels, 'the goal to be taken back')
        self.start_middle_layer()
        self.rospy.set_param('/move_base_node/behaviour', 'abort')
        self.rospy.set_param('/move_base_node/text', 'no')
        self.require(self.execute(), self.codes.FAILED, '^unreachable$')

    def test_a_killed_guard_leaves_a_robot_that_stands_and_its_successor_puts_back(self):
        goal = self.drive()
        self.guard.kill()
        self.require(goal, self.codes.FAILED)
        self.require_stand()
        self.assertEqual(self.system.values(), SLOW)
        self.guard = self.keep(self.system.start_guard(self.journal))
        self.system.await_values(FAST)
        self.rospy.set_param('/move_base_node/behaviour', 'abort')
        self.rospy.set_param('/move_base_node/text', 'no')
        wait_for_guard(self.rospy)
        self.require(self.execute(), self.codes.FAILED, '^unreachable$')

    def test_a_killed_move_base_is_named_and_gets_its_own_values_when_it_is_back(self):
        goal = self.drive()
        self.move_base.kill()
        self.require(goal, self.codes.FAILED, '^no_controller: move_base$')
        self.require_stand()
        # The parameter server has kept what was in force, so that is what the next one begins with.
        self.keep(self.system.start_move_base('cmd_vel:=base_guard/cmd_vel', is_new=False))
        self.system.await_values(FAST)

    def test_a_planner_that_does_not_take_the_set_ends_the_action_before_a_goal(self):
        self.begin(FAR, behaviour='drive', lower={'max_vel_x': 0.4})
        self.require(self.execute(), self.codes.FAILED, 'max_vel_x is 0.4, wanted 0.3')
        self.assertEqual(self.base.goals, [])
        self.assertEqual([c.linear.x for c in self.base.commands if c.linear.x], [])
        self.require(self.execute(motion_set='slow'), self.codes.FAILED, 'max_vel_x')

    def test_without_a_guard_nobody_drives_by_move_base(self):
        alone = self.keep(self.processes.start(
            [executable('middle_layer'), '__name:=unguarded', '_config:=' + self.config,
             '_navigation:=move_base'], self.main))
        self.assertEqual(alone.wait(), 1)
        self.assertIn('without a guard', alone.output())


if __name__ == '__main__':
    run_test('move_base_mode', MoveBaseModeTest)
