#!/usr/bin/env python3
"""A worker that answers nonsense, beside one that does its work: the request gets the answer that
the good one alone would give, and the client lives. Run alone, or by `rostest hires
imagination_rogue_worker.test`."""

import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from imagination_system import ImaginationSystem  # noqa: E402
from test_run import run_test  # noqa: E402

ROLLOUTS = 12


class RogueWorker:
    """Serves /worker_2/rollout and answers each goal as it is told."""

    def __init__(self):
        import actionlib
        from hires import msg
        self.msg = msg
        self.answer = self.abort
        self.num_goals = 0
        self._server = actionlib.ActionServer('/worker_2/rollout', msg.RolloutAction, self._on_goal,
                                              lambda goal: None, auto_start=False)
        self._server.start()

    def _on_goal(self, goal):
        self.num_goals += 1
        self.answer(goal, goal.get_goal())

    def record(self, wanted):
        record = self.msg.RolloutRecord(index=wanted.first, duration=4.0, action_finished=True,
                                        simulated=4.5, depends_on_everything=True)
        record.counts.notopple = 80
        return record

    def finish(self, goal, record):
        """Accepts, sends one rollout, and is done."""
        goal.set_accepted()
        goal.publish_feedback(self.msg.RolloutFeedback(result=record))
        goal.set_succeeded(self.msg.RolloutResult(results=[record]))

    # Ways to answer.

    def abort(self, goal, wanted):
        goal.set_accepted()
        goal.set_aborted(self.msg.RolloutResult(code=1, why='no mood'))

    def reject(self, goal, wanted):
        goal.set_rejected(self.msg.RolloutResult(), 'no time')

    def do_nothing(self, goal, wanted):
        goal.set_accepted()
        goal.set_succeeded(self.msg.RolloutResult())

    def answer_another_index(self, goal, wanted):
        record = self.record(wanted)
        record.index += 100000
        self.finish(goal, record)

    def take_no_number_for_a_duration(self, goal, wanted):
        record = self.record(wanted)
        record.duration = float('nan')
        self.finish(goal, record)

    def take_a_negative_tilt(self, goal, wanted):
        record = self.record(wanted)
        record.max_tilt = -1.0
        self.finish(goal, record)

    def depend_on_nothing(self, goal, wanted):
        record = self.record(wanted)
        record.depends_on_everything = False  # and no disc
        self.finish(goal, record)

    def send_joints_that_do_not_pair_up(self, goal, wanted):
        record = self.record(wanted)
        record.final_robot.joints.name = ['torso_lift_joint']
        self.finish(goal, record)

    def send_an_unknown_outcome_without_a_reason(self, goal, wanted):
        record = self.record(wanted)
        record.outcome = 77
        self.finish(goal, record)


class ImaginationRogueWorkerTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.system = ImaginationSystem(workers=2)
        cls.addClassCleanup(cls.system.destroy)
        os.environ.update(ROS_MASTER_URI=cls.system.main.uri, ROS_IP='127.0.0.1',
                          ROS_LOG_DIR=cls.system.processes.folder.name)
        os.environ.pop('ROS_HOSTNAME', None)
        import rospy
        rospy.init_node('rogue_worker', disable_signals=True)
        cls.rogue = RogueWorker()
        cls.system.start_client()
        cls.system.start_host(1)
        for k in (1, 2):
            cls.system.wait_until_joined(k)
        cls.expected = cls.system.ask('--local', rollouts=ROLLOUTS).answer().content()

    def test_no_nonsense_of_a_worker_finds_its_way_into_the_answer(self):
        for answer in (self.rogue.abort, self.rogue.reject, self.rogue.do_nothing,
                       self.rogue.answer_another_index, self.rogue.take_no_number_for_a_duration,
                       self.rogue.take_a_negative_tilt, self.rogue.depend_on_nothing,
                       self.rogue.send_joints_that_do_not_pair_up,
                       self.rogue.send_an_unknown_outcome_without_a_reason):
            with self.subTest(worker=answer.__name__):
                self.rogue.answer = answer
                before = self.rogue.num_goals
                result = self.system.ask(rollouts=ROLLOUTS).answer()
                self.assertTrue(self.system.client.is_running(), self.system.client.output())
                self.assertEqual(result.code, 0, result.output)
                self.assertEqual(result.content(), self.expected)
                self.assertGreater(self.rogue.num_goals, before)


if __name__ == '__main__':
    run_test('imagination_rogue_worker', ImaginationRogueWorkerTest)
