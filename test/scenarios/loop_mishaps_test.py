#!/usr/bin/env python3
"""What goes wrong in the world: a step never ends, an object slips off or vanishes, the robot is
pushed off its path. The monitor notices from what is observed, and what it says is true. Run alone,
or by `rostest hires loop_mishaps.test`."""

import math
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from closed_loop import SERVE  # noqa: E402
from loop_case import AT_COUNTER, BOTH, MUG, STILL, LoopCase  # noqa: E402
from test_run import run_test  # noqa: E402

THERE = 'carry_object_on_tray mug1 counter1 table1'
DRIVING = {'pose': [12.5, 9.8, 2.0], 'torso': 'torsodownposture',
           'arms': {'leftarm1': 'armtuckedposture', 'rightarm1': 'armtuckedposture'}}
TORSO_DOWN = dict(AT_COUNTER, torso='torsodownposture')
FAST = 0.3   # [m/s]
SKILL_WAITS = 35.0  # [s] that the skill itself waits for the torso, at least: it needs 22 s
OBSERVED_WITHIN = 0.2  # [s] at most, until the Blackboard knows
PUSH = 0.35  # [m] to the left of its way


class LoopMishapsTest(LoopCase):
    def act(self, service, kind, **fields):
        answer = self.loop.intervene(service, kind, **fields)
        self.assertTrue(answer.success, answer.message)

    def swallow(self, topic):
        """The robot's controller does not hear what it is told; somebody else does."""
        from trajectory_msgs.msg import JointTrajectory
        heard = []
        subscriber = self.loop.rospy.Subscriber(topic, JointTrajectory, heard.append)
        self.addCleanup(subscriber.unregister)
        self.loop.remaps['sim_robot'] = [topic + ':=nowhere']
        self.addCleanup(self.loop.remaps.clear)
        return heard

    def known_objects(self):
        """What the robot remembers; its last word comes last."""
        heard = []
        subscriber = self.loop.rospy.Subscriber(
            'known_objects', self.loop.msg.WorldState,
            lambda world: heard.append([o.name for o in world.objects]))
        self.addCleanup(subscriber.unregister)
        return heard

    def require_that_the_torso_is_given_up(self):
        at_first = self.truth.joint('torso_lift_joint')
        task = self.achieve(THERE)
        result = self.require(task, self.codes.FAILED, 'move_torso(torsoupposture): timed_out')
        self.assertAlmostEqual(self.truth.joint('torso_lift_joint'), at_first, delta=0.001)
        steps = self.steps_of(result, 'move_torso')
        for step in steps:
            self.assertEqual(step.phase, self.phases.FAILED)
            self.assertEqual(step.failure.code, self.loop.msg.Failure.TIMED_OUT)
        self.warned(task, 'move_torso(torsoupposture): timed_out')
        self.assertEqual(self.steps_of(result, 'move_base_blind'), [])
        self.wait_until_it_stands()
        return steps

    def test_a_step_that_never_ends_is_stopped_and_named(self):
        heard = self.swallow('torso_controller/command')
        with self.subTest('by its skill'):
            self.begin(TORSO_DOWN, MUG)
            self.require_that_the_torso_is_given_up()
            self.assertTrue(heard)
        with self.subTest('by the monitor, when it is overdue'):
            self.begin(TORSO_DOWN, MUG, overdue_factor=1.0, overdue_minimum=5.0)
            for step in self.require_that_the_torso_is_given_up():
                self.assertLess(step.finished - step.started, SKILL_WAITS)

    def test_an_object_that_slips_off_in_transit_is_noticed(self):
        self.begin(AT_COUNTER, MUG)
        task = self.achieve(THERE)
        self.wait_for_step(task, 'tuck_arms')
        self.loop.step_until(lambda t: t.speed() > FAST, 'the robot to drive')
        self.act('drop', self.loop.srv.ObjectRequest, name='mug1')
        # Played on by itself, the drive is over before a busy computer has seen anything.
        known = self.known_objects()
        self.loop.step_until(lambda t: known and 'mug1' not in known[-1],
                             'the loss to be seen', lag=OBSERVED_WITHIN)
        self.loop.step_until(lambda t: self.was_warned(task, 'on(mug1, trayarea1)'),
                             'the loss to be noticed', words=lambda: len(task.feedback))
        self.loop.hold(False)
        result = self.require(task, self.codes.NO_PLAN)
        # Of the drive, or of what comes after it where that was soon over.
        losses = [s.failure.subjects for s in result.steps
                  if s.failure.code == self.loop.msg.Failure.CONDITION_LOST]
        self.assertIn(['mug1', 'trayarea1'], losses)
        self.assertEqual(self.steps_of(result, 'place_object'), [])
        self.assertFalse(self.truth.stands('mug1'))
        self.assertLess(self.truth.position('mug1')[2], 0.2)
        self.wait_until_it_stands()

    def test_an_object_that_vanishes_is_noticed(self):
        self.begin(AT_COUNTER, BOTH)
        task = self.achieve(SERVE)
        self.wait_for_step(task, 'move_base_blind')
        self.act('remove_object', self.loop.srv.ObjectRequest, name='mug1')
        result = self.require(task, self.codes.NO_PLAN)
        self.assertEqual(self.steps_of(result, 'place_object'), [])
        self.assertEqual([o.attached_to for o in self.truth.world.objects], [''])
        on = [f for f in self.loop.fluents('On', now=True)]
        self.assertFalse(any('mug1' in f.instance.lower() for f in on))
        self.wait_until_it_stands()

    def test_a_robot_pushed_off_its_path_arrives_all_the_same(self):
        from geometry_msgs.msg import Pose2D
        self.begin(DRIVING, MUG)
        task = self.achieve(THERE)
        self.loop.step_until(lambda t: t.speed() > FAST, 'the robot to drive')
        self.act('push', self.loop.srv.PushRobot, offset=Pose2D(y=PUSH))
        self.loop.hold(False)
        self.wait_for_step(task, 'pick_up_object')
        base = self.truth.robot[-1].pose.position
        self.assertLess(math.hypot(base.x - 6.0, base.y - 10.11), 0.06)
        self.assertFalse(self.truth.summary.robot_collided, self.truth.summary.contact)
        task.cancel()
        self.require(task, self.codes.PREEMPTED)
        self.assertLess(self.truth.speed(), STILL)


if __name__ == '__main__':
    run_test('loop_mishaps', LoopMishapsTest)
