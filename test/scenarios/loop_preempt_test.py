#!/usr/bin/env python3
"""A task is preempted during each kind of step: the robot stands within a second, and what it
carries stays where it is; asked again, it goes on from there. Run alone, or by
`rostest hires loop_preempt.test`."""

import os
import re
import sys
import threading

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from closed_loop import SERVE, joint_speeds, speed_of  # noqa: E402
from loop_case import AT_COUNTER, MUG, ON_FLOOR, LoopCase, JOINT_STILL, STILL  # noqa: E402
from ros_processes import wait_until  # noqa: E402
from test_run import run_test  # noqa: E402

# A mug stands firmly: what makes it fall is not how the plan goes on, which has no time to imagine.
THERE = 'carry_object_on_tray mug1 counter1 table1'
MAY_TAKE = 1.0     # [s] simulated, from the middle layer's word until the robot stands
PIECE = 0.1        # [s] simulated, that is played at once until a step moves something
LONGEST_START = 10.0  # [s] simulated, from its begin until it does
WATCHED = 2.0      # [s] simulated, for which it is then watched
ARM_JOINT = re.compile('[lr]_(shoulder|upper_arm|elbow|forearm|wrist)')
# Hands hold on to what they hold, and the head looks around.
GOES_ON = re.compile('gripper|head')
BASE, TORSO, ARM = 0.05, 0.005, 0.1  # [m/s], [m/s], [rad/s]: the step is really at work


def is_at_work(name, truth):
    """Whether what this kind of step moves is in motion."""
    if name.startswith('move_base'):
        return truth.speed() > BASE
    speeds = truth.joint_speeds()
    if name == 'move_torso':
        return speeds.get('torso_lift_joint', 0.0) > TORSO
    return any(speed > ARM for joint, speed in speeds.items() if ARM_JOINT.match(joint))


class PreemptTest(LoopCase):
    def listen_to_steps(self):
        """Words of the middle layer about its goals, and a line to whoever stops time."""
        from actionlib_msgs.msg import GoalStatusArray
        from std_srvs.srv import SetBool
        self.loop.rospy.wait_for_service('sim_robot/hold', 60.0)
        self.holder = self.loop.rospy.ServiceProxy('sim_robot/hold', SetBool, persistent=True)
        self.addCleanup(self.holder.close)
        self.statuses = []
        subscriber = self.loop.rospy.Subscriber(
            'execute_action/status', GoalStatusArray, self.statuses.append, tcp_nodelay=True)
        self.addCleanup(subscriber.unregister)

    def running(self):
        """Goals that the middle layer is at, by its last word."""
        from actionlib_msgs.msg import GoalStatus
        return {s.goal_id.id for s in self.statuses[-1].status_list
                if s.status == GoalStatus.ACTIVE} if self.statuses else set()

    def hold(self, is_held):
        self.assertTrue(self.holder(data=is_held).success)

    def stop_time(self):
        self.hold(True)
        self.truth.wait(lambda t: t.num_repeated > 0, 'time to stand')

    def play_until_at_work(self, name):
        """In short pieces, after each of which all that happened was heard."""
        self.stop_time()
        begin = self.truth.now()
        while not is_at_work(name, self.truth):
            end = self.truth.now() + PIECE
            self.assertLess(end, begin + LONGEST_START, name + ' does not move')
            self.hold(False)
            self.truth.wait(lambda t: t.now() >= end, 'time to go on')
            self.stop_time()

    def preempt_during(self, text, name):
        """Of the first step of this name, while it moves the robot. Time stands from the first word
        of the step on, so that load on the machine does not count as time that the robot took: not
        until it moves, nor while the word goes from node to node."""
        is_held = threading.Event()

        def hold_when_it_begins(feedback):
            begun = any(s.action.name == name and s.phase == self.phases.RUNNING
                        for s in feedback.steps)
            if begun and not is_held.is_set():
                is_held.set()
                self.hold(True)

        task = self.achieve(text, on_feedback=hold_when_it_begins)
        self.wait_for_step(task, name)
        self.play_until_at_work(name)
        before = self.truth.now()
        self.assertTrue(self.running(), name + ' was over too early')
        task.cancel()
        wait_until(lambda: not self.running(), 'the middle layer to break off')
        self.hold(False)
        self.require(task, self.codes.PREEMPTED)
        self.assertEqual(task.state(), 2)  # actionlib's PREEMPTED
        self.truth.wait(lambda t: t.now() > before + MAY_TAKE + WATCHED, 'time to go on')
        self.assert_still(before + MAY_TAKE)
        self.assertEqual(self.truth.falls(), {}, name)
        self.assertFalse(self.truth.summary.robot_collided, self.truth.summary.contact)

    def assert_still(self, since):
        """From that moment [s] on."""
        after = [r for r in self.truth.robot if r.joints.header.stamp.to_sec() > since]
        self.assertLess(max(speed_of(r) for r in after), STILL)
        for before, now in zip(after, after[1:]):
            moving = {joint: speed for joint, speed in joint_speeds(before, now).items()
                      if speed > JOINT_STILL and not GOES_ON.search(joint)}
            self.assertEqual(moving, {}, now.joints.header.stamp.to_sec() - since)

    def test_the_robot_stands_whatever_it_was_at_and_goes_on_when_asked_again(self):
        self.begin(ON_FLOOR, MUG)
        self.listen_to_steps()
        for name in ('tuck_arms', 'move_base', 'move_torso', 'move_arm_to_side', 'move_base_blind',
                     'pick_up_object', 'place_on_tray', 'move_base_param', 'pick_up_from_tray',
                     'place_object'):
            with self.subTest(name):
                self.preempt_during(THERE, name)
        self.require(self.achieve(THERE), self.codes.SUCCEEDED)
        self.assert_on_table1('mug1')

    def test_a_mug_in_the_hand_stays_there(self):
        self.begin(AT_COUNTER, MUG)
        self.listen_to_steps()
        for name in ('move_arms_to_carryposture', 'move_base'):
            with self.subTest(name):
                self.preempt_during(SERVE, name)
                self.assertTrue(self.truth.object('mug1').attached_to, name)


if __name__ == '__main__':
    run_test('loop_preempt', PreemptTest)
