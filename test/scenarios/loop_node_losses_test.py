#!/usr/bin/env python3
"""Planner, Blackboard and middle layer are killed in the middle, the tracker is held up: the run
completes, or the robot stands and it is said why. Run alone, or by `rostest hires loop_node_losses.test`."""

import collections
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from closed_loop import link_of, text_of  # noqa: E402
from loop_case import AT_COUNTER, MUG, STILL, LoopCase  # noqa: E402
from ros_processes import wait_until  # noqa: E402
from test_run import run_test  # noqa: E402

LOAD = 'load_tray mug1 counter1'  # most kinds of steps; a whole delivery is loop_preempt's
BACK_TO_DRIVING_AREA = -0.8  # [m] from where it picks up to where it came from
DRIVING = {'pose': [12.5, 9.8, 2.0], 'torso': 'torsodownposture',
           'arms': {'leftarm1': 'armtuckedposture', 'rightarm1': 'armtuckedposture'}}
FAST = 0.3      # [m/s]
# [s] simulated: long enough for a program to start again, though the robot is ten times as fast.
PATIENCE = {'planning_timeout': 60.0}
MAY_TAKE = 1.0  # [s] simulated, from the last command until the base stands
HELD_UP = 5.0   # [s] simulated, half a second of the computer's
ABOVE_FLOOR, BELOW_FURNITURE = 0.3, 0.5  # [m] between them is the tray alone
OPEN = 0.088     # [m] between the fingers that are about to grasp: they open to 0.09,
CLOSING = 0.085  # [m] and this is well before they touch a mug


class NodeLossesTest(LoopCase):
    def push(self, x):
        from geometry_msgs.msg import Pose2D
        answer = self.loop.intervene('push', self.loop.srv.PushRobot, offset=Pose2D(x=x))
        self.assertTrue(answer.success, answer.message)

    def assert_on_tray(self, name):
        self.truth.wait(lambda t: t.stands(name), name + ' to stand, as the simulator tells')
        self.assertGreater(self.truth.position(name)[2], ABOVE_FLOOR)
        self.assertLess(self.truth.position(name)[2], BELOW_FURNITURE)

    def test_a_planner_that_dies_while_the_plan_is_mended(self):
        self.begin(AT_COUNTER, MUG, **PATIENCE)
        task = self.achieve(LOAD)
        self.wait_for_step(task, 'pick_up_object')
        self.loop.pause('planner')
        self.push(BACK_TO_DRIVING_AREA)
        self.assertTrue(
            task.sees(lambda f: any('is mended' in text for text in f.warnings), 'trouble'))
        self.loop.kill('planner')
        self.loop.start_node('planner')
        result = self.require(task, self.codes.SUCCEEDED)
        self.assertGreaterEqual(result.replans, 1)
        self.warned(task, 'pick_up_object')
        self.assert_on_tray('mug1')

    def assert_everything_is_in_the_store(self, result):
        """Every step that was begun, with its end, and every answer of imagination."""
        episode = wait_until(lambda: [e for e in self.loop.episodes()
                                      if e.id == result.episode and e.outcome], 'the episode')[0]
        self.assertEqual(episode.outcome, 'succeeded')
        begun = collections.Counter(s.action.name.replace('_', '') for s in result.steps
                                    if s.started == s.started and s.action.name != 'imagine')
        activities = [f for f in self.loop.fluents('RobotActivity', in_episode=True,
                                                   episode=episode.id)
                      if text_of(f, 'hasResult')]  # as it was before that is kept, too
        self.assertEqual(collections.Counter(
            a.concept_name.lower().replace('activity', '') for a in activities), begun)
        for activity in activities:
            self.assertLess(activity.finish_latest, float('inf'), activity.instance)
        self.assertEqual(self.loop.fluents('RobotActivity', now=True), [])
        on = {link_of(f, 'hasPhysicalEntity'): link_of(f, 'hasArea')
              for f in self.loop.fluents('On', now=True)}
        self.assertEqual(on['mug1'], 'trayarea1')

    def test_a_blackboard_killed_in_the_middle_has_everything_afterwards(self):
        self.begin(AT_COUNTER, MUG, **PATIENCE)
        task = self.achieve(LOAD)
        self.wait_for_step(task, 'pick_up_object')
        self.loop.kill('blackboard')
        self.wait_for_step(task, 'pick_up_object', self.phases.CHECKING)
        self.loop.start_node('blackboard')
        result = self.require(task, self.codes.SUCCEEDED)
        self.assertEqual(result.replans, 0)
        self.assert_on_tray('mug1')
        self.assert_everything_is_in_the_store(result)
        self.loop.kill('blackboard')
        self.loop.start_node('blackboard')
        self.assert_everything_is_in_the_store(result)
        refused = [line for line in self.loop.nodes['execution_monitor'].lines
                   if 'record=refused' in line]
        self.assertEqual(refused, [])

    def test_a_tracker_that_is_held_up_during_a_grasp_has_felt_it_afterwards(self):
        self.begin(AT_COUNTER, MUG)
        task = self.achieve(LOAD)
        self.wait_for_step(task, 'pick_up_object')
        self.truth.wait(lambda t: t.joint('r_gripper_joint') > OPEN, 'the hand to open')
        self.truth.wait(lambda t: t.joint('r_gripper_joint') < CLOSING, 'the hand to close')
        self.loop.pause('world_tracker')
        self.truth.wait(lambda t: t.object('mug1').attached_to, 'the mug to be held')
        held = self.truth.now()
        self.truth.wait(lambda t: t.now() > held + HELD_UP, 'the mug to be somewhere else')
        self.loop.unpause('world_tracker')
        self.wait_for_step(task, 'place_on_tray')
        of_the_grasp = [text for text in task.warnings() if text.startswith('pick_up_object')]
        self.assertEqual(of_the_grasp, [])

    def test_without_middle_layer_the_robot_stands_and_with_a_new_one_it_goes_on(self):
        self.begin(DRIVING, MUG, **PATIENCE)
        task = self.achieve(LOAD)
        self.wait_for_step(task, 'move_base')
        self.truth.wait(lambda t: t.speed() > FAST, 'the robot to drive')
        self.loop.kill('middle_layer')
        killed = self.truth.now()
        self.truth.wait(lambda t: t.now() > killed + MAY_TAKE, 'time to go on')
        self.assertLess(self.truth.speed(), STILL)
        self.require(task, self.codes.FAILED, 'move_base', "'execute_action'")
        self.assertLess(self.truth.speed(), STILL)
        self.loop.start_node('middle_layer')
        self.require(self.achieve(LOAD), self.codes.SUCCEEDED)
        self.assert_on_tray('mug1')


if __name__ == '__main__':
    run_test('loop_node_losses', NodeLossesTest)
