#!/usr/bin/env python3
"""The execution monitor as a real node, with the real planner and Blackboard, and fakes of robot,
translator and imagination: whole plans, imagination, preempting, and whatever dies on the way. Run
alone, or by `rostest hires execution_monitor.test`."""

import os
import signal
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

import failures  # noqa: E402
from diagnostics import diagnostics  # noqa: E402
from execution_system import CARRY, SERVE, ExecutionSystem, text_of  # noqa: E402
from ros_processes import executable, wait_until  # noqa: E402
from test_run import long_case, run_test  # noqa: E402

NORTH = 'premanipulationareanorthtable1'
MOST_REACTION = 50.0  # [ms] from an event to what is dispatched for it


class ExecutionMonitorTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.system = ExecutionSystem()
        cls.addClassCleanup(cls.system.destroy)
        cls.system.start()
        cls.system.connect()
        cls.codes = cls.system.msg.AchieveResult
        cls.phases = cls.system.msg.StepStatus

    def setUp(self):
        self.system.reset()

    def tearDown(self):
        self.assertTrue(self.system.nodes['monitor'].is_running(),
                        self.system.nodes['monitor'].output())

    def achieve(self, task, **fields):
        task = self.system.achieve(task, **fields)
        self.addCleanup(task.give_up)
        return task

    def require(self, task, code, text=''):
        result = task.result()
        self.assertEqual(result.code, code, '%d: %s\n%s' % (
            result.code, result.reason, '\n'.join(self.system.nodes['monitor'].lines[-30:])))
        self.assertIn(text, result.reason)
        return result

    def ended_after(self, episode, count):
        """Outcomes of the episodes after this one, once so many have ended."""
        outcomes = [e.outcome for e in self.system.episodes() if e.id > episode]
        return outcomes if len(outcomes) == count and all(outcomes) else None

    def wait_for_step(self, name):
        """Until the fake robot is told to do this."""
        return wait_until(lambda: self.system.done(name), name)

    def carry_when_imagination_is_answered(self):
        """The fake robot does all at once: it waits, so that the answer is not too late."""
        self.system.behave('move_base', hang=True)
        task = self.achieve(CARRY)
        task.wait_for_feedback(lambda f: f.imaginations and f.imaginations[0].outcome, 'an answer')
        self.system.free('move_base')
        return task, self.require(task, self.codes.SUCCEEDED)

    # Whole plans.

    def test_an_object_is_carried_as_imagination_recommends(self):
        self.system.behave('imagine', answer='ranked', recommend='slow')
        _, result = self.carry_when_imagination_is_answered()
        self.assertEqual(result.replans, 0)
        self.assertEqual(self.system.done('move_base_param'),
                         ['move_base_param(%s, slow)' % NORTH])
        imagined = result.imaginations[0]
        self.assertEqual(imagined.outcome, 'ranked')
        self.assertEqual(len(imagined.predictions), 2)
        self.assertLess(imagined.answered, imagined.dispatch)
        step = [s for s in result.steps if s.action.name == 'move_base_param'][0]
        self.assertEqual((imagined.plan, imagined.step), (step.plan, step.index))
        self.assertEqual(step.started, imagined.dispatch)
        self.assertTrue(all(s.phase == self.phases.DONE for s in result.steps), result.steps)

    def test_the_blackboard_has_the_episode_and_what_was_done(self):
        self.require(self.achieve(CARRY), self.codes.SUCCEEDED)
        episode = wait_until(
            lambda: [e for e in self.system.episodes()[-1:] if e.outcome], 'the end of the episode')
        self.assertEqual(episode[0].task, CARRY)
        self.assertEqual(episode[0].outcome.split(':')[0], 'succeeded')
        drives = self.system.fluents('MoveBaseParamActivity', in_episode=True,
                                     episode=episode[0].id)
        drives = [d for d in drives if text_of(d, 'hasResult')]
        self.assertEqual([text_of(d, 'hasResult') for d in drives], ['succeeded'])
        self.assertLess(drives[0].finish_latest, float('inf'))
        self.assertEqual(self.system.fluents('RobotActivity', now=True), [])

    def test_feedback_shows_every_step_and_comes_with_each_change(self):
        task = self.achieve(CARRY)
        result = self.require(task, self.codes.SUCCEEDED)
        last = max(step.finished for step in result.steps)
        for step in result.steps:
            if step.finished > last - 0.1:
                continue  # the result may be there before
            seen = {s.phase for feedback in task.feedback for s in feedback.steps
                    if (s.plan, s.index) == (step.plan, step.index)}
            self.assertIn(self.phases.DONE, seen, step.action)

    def test_coffee_is_served_beside_what_imagination_found_to_fail(self):
        self.system.put_wish()
        self.system.behave('imagine', answer='all_failed')
        # Under way until it is told to stop: or it might be there before the answers are.
        self.system.behave('move_base', hang=True)
        result = self.achieve(SERVE).result()
        # Every place fails in imagination: no way is left, and nothing was put anywhere.
        self.assertEqual(result.code, self.codes.NO_PLAN, result.reason)
        self.assertEqual(failures.text_of(result.failure), 'imagined_failure: area_occupied')
        self.assertEqual(self.system.done('place_object'), [])
        self.assertGreater(result.replans, 0)

    def test_steps_run_side_by_side_where_the_plan_allows(self):
        self.system.behave('move_torso', hang_for='torsoupposture', times=1)
        task = self.achieve(CARRY)
        self.wait_for_step('move_arm_to_side')  # while the torso still moves
        task.cancel()
        self.require(task, self.codes.PREEMPTED)

    # Bad tasks.

    def test_tasks_that_are_none_are_refused(self):
        for text, *words in (('', 'names no task'), ('serve_coffe_to_guest guest1', 'serve_coffee'),
                             ('serve_coffee_to_guest', 'serve_coffee_to_guest'),
                             ('(serve_coffee_to_guest guest1', 'task:1:1'), ('(' * 100000, 'task:1')):
            with self.subTest(task=text[:40]):
                result = self.require(self.achieve(text), self.codes.INVALID)
                for word in words:
                    self.assertIn(word, result.reason)

    def test_an_unknown_policy_is_refused(self):
        self.require(self.achieve(CARRY, imagination='sometimes'), self.codes.INVALID, 'sometimes')

    def test_one_task_at_a_time(self):
        self.system.behave('move_base', hang=True)
        first = self.achieve(CARRY)
        self.wait_for_step('move_base')
        self.require(self.achieve(SERVE), self.codes.BUSY, CARRY)
        first.cancel()
        self.require(first, self.codes.PREEMPTED)

    # Policies.

    def test_imagination_may_be_off(self):
        self.require(self.achieve(CARRY, imagination='off'), self.codes.SUCCEEDED)
        self.assertNotIn('imagine move_base_param', self.system.log())
        self.assertEqual(self.system.done('move_base_param'),
                         ['move_base_param(%s, slow)' % NORTH])

    def test_the_policy_of_the_thesis_takes_the_default_where_all_fail(self):
        self.system.behave('imagine', answer='all_failed')
        self.require(self.achieve(CARRY, imagination='thesis'), self.codes.SUCCEEDED)
        self.assertEqual(self.system.done('move_base_param'),
                         ['move_base_param(%s, slow)' % NORTH])

    # Preempting.

    def test_preempted_during_a_step_the_robot_is_stopped(self):
        self.system.behave('move_base', hang=True)
        task = self.achieve(CARRY)
        self.wait_for_step('move_base')
        task.cancel()
        result = self.require(task, self.codes.PREEMPTED)
        self.assertEqual(task.state(), 2)  # actionlib's PREEMPTED
        self.assertIn('preempted move_base', self.system.log())
        self.assertGreater(result.episode, 0)

    def test_a_task_whose_client_was_killed_is_preempted(self):
        self.system.behave('move_base', hang=True)
        verb = self.hires(CARRY)
        self.wait_for_step('move_base')
        verb.signal(signal.SIGKILL)
        wait_until(lambda: 'preempted move_base' in self.system.log(), 'the robot to be stopped')

    @long_case
    def test_a_client_that_is_slow_to_answer_is_waited_for(self):
        self.system.behave('move_base', hang=True)
        verb = self.hires(CARRY)
        self.wait_for_step('move_base')
        verb.signal(signal.SIGSTOP)
        wait_until(lambda: 'slow to answer' in self.system.nodes['monitor'].output(), 'a warning')
        verb.signal(signal.SIGCONT)
        self.assertNotIn('preempted', self.system.log())
        verb.signal(signal.SIGINT)
        wait_until(lambda: 'preempted move_base' in self.system.log(), 'the robot to be stopped')

    def test_preempted_while_it_is_planned(self):
        self.system.nodes['planner'].signal(signal.SIGSTOP)
        self.addCleanup(self.system.nodes['planner'].signal, signal.SIGCONT)
        task = self.achieve(CARRY)
        task.cancel()
        self.require(task, self.codes.PREEMPTED)
        self.assertEqual(self.system.done('tuck_arms'), [])

    @long_case
    def test_preempted_while_effects_are_awaited(self):
        self.system.behave('tuck_arms', silent=True)
        task = self.achieve(CARRY)
        task.wait_for_feedback(lambda f: any(s.phase == self.phases.CHECKING for s in f.steps), 'checking')
        task.cancel()
        self.require(task, self.codes.PREEMPTED)

    def test_preempted_while_it_is_imagined(self):
        self.system.behave('imagine', answer='hang')
        self.system.behave('move_base_param', hang=True)
        self.system.behave('move_base', hang=True)
        task = self.achieve(CARRY)
        wait_until(lambda: 'imagine move_base_param' in self.system.log(), 'imagination')
        task.cancel()
        self.require(task, self.codes.PREEMPTED)

    @long_case
    def test_what_was_imagined_for_a_request_that_is_cancelled_counts(self):
        self.system.behave('imagine', answer='hang')
        self.system.behave('move_base', hang=True)
        task = self.achieve(CARRY)
        wait_until(lambda: 'imagine move_base_param' in self.system.log(), 'imagination')
        self.wait_for_step('move_base')
        self.system.behave('imagine', answer='ranked', recommend='slow')  # of the next request
        self.system.put('mug2', 'placingAreaNorthLeftTable2')  # the drive will begin in another state
        wait_until(lambda: 'imagining ended' in self.system.log(), 'the end of the first request')
        task.wait_for_feedback(lambda f: len(f.imaginations) > 1 and f.imaginations[1].outcome,
                               'an answer')
        self.system.free('move_base')
        result = self.require(task, self.codes.SUCCEEDED)
        first, second = result.imaginations
        self.assertEqual((first.outcome, second.outcome), ('cancelled', 'ranked'))
        self.assertEqual([p.rollouts for p in first.predictions], [16, 16])
        self.assertEqual((first.simulated_seconds, first.wall_seconds), (30.0, 1.5))
        self.assertEqual((first.recommended, first.why), (-1, ''))

    def test_a_robot_that_does_not_stop_does_not_hold_the_task_for_ever(self):
        self.system.behave('move_base', hang=True, deaf=True)
        task = self.achieve(CARRY)
        self.wait_for_step('move_base')
        task.cancel()
        self.require(task, self.codes.PREEMPTED)

    # What fails.

    def test_a_step_that_fails_is_planned_around(self):
        self.system.behave('pick_up_object', reason='grasp_failed', times=1)
        task = self.achieve(CARRY)
        result = self.require(task, self.codes.SUCCEEDED)
        self.assertGreaterEqual(result.replans, 1)
        failed = [s for s in result.steps if s.phase == self.phases.FAILED]
        self.assertEqual([s.action.name for s in failed], ['pick_up_object'])
        self.assertEqual(failures.text_of(failed[0].failure), 'grasp_failed')
        self.assertIn('grasp_failed', failed[0].note)
        told = [text_of(f, 'hasFailure') for f in self.system.fluents(
            'MonitoredFailure', in_episode=True, episode=result.episode)]
        self.assertEqual(told, ['grasp_failed'])

    def test_effects_that_nobody_observes_are_noticed(self):
        self.system.behave('tuck_arms', silent=True, times=1)
        result = self.require(self.achieve(CARRY), self.codes.SUCCEEDED)
        self.assertGreater(len(self.system.done('tuck_arms')), 1)
        self.assertTrue(any(s.phase == self.phases.FAILED for s in result.steps))

    def test_effects_that_are_told_late_are_waited_for(self):
        now = self.system.rospy.Time.now()
        self.system.say_observed_until(now)
        self.addCleanup(self.system.say_observed_until, now + self.system.rospy.Duration(1e6))
        # Nobody has been told so much.
        self.system.say_observed_until(now + self.system.rospy.Duration(1e6), sequence=10**9)
        self.system.behave('tuck_arms', silent=True, times=1)
        task = self.achieve(CARRY)
        wait_until(lambda: any('word of what is observed' in text for text in task.warnings()),
                   'the warning')
        self.system.observe(self.system.done('tuck_arms')[0])
        result = self.require(task, self.codes.SUCCEEDED)
        self.assertEqual(result.replans, 0)
        self.assertEqual([s for s in result.steps if s.phase == self.phases.FAILED], [])

    # Who dies.

    def test_without_imagination_client_the_default_is_taken_and_a_warning_says_so(self):
        self.system.kill('imagination')
        self.addCleanup(self.system.start_fake, 'imagination')
        task, result = self.carry_when_imagination_is_answered()
        self.assertEqual(self.system.done('move_base_param'),
                         ['move_base_param(%s, slow)' % NORTH])
        self.assertEqual(result.imaginations[0].outcome, 'unavailable')
        self.assertTrue(task.warnings())

    def test_without_translator_the_default_is_taken(self):
        self.system.kill('translator')
        self.addCleanup(self.system.start_fake, 'translator')
        _, result = self.carry_when_imagination_is_answered()
        self.assertIn('translator', result.imaginations[0].why)

    def test_what_cannot_be_translated_is_told(self):
        self.system.behave('translator', error='area moon is unknown')
        result = self.require(self.achieve(CARRY), self.codes.SUCCEEDED)
        self.assertEqual(result.imaginations[0].outcome, 'invalid')
        self.assertIn('area moon is unknown', result.imaginations[0].why)

    def test_a_planner_that_is_away_at_first(self):
        self.system.kill('planner')
        self.addCleanup(self.system.start_planner)
        result = self.achieve(CARRY).result()
        self.assertIn(result.code, (self.codes.FAILED, self.codes.NO_PLAN))
        self.assertIn('plan', result.reason)
        self.assertEqual(self.system.done('tuck_arms'), [])

    @long_case
    def test_a_planner_that_dies_before_a_repair(self):
        self.system.behave('move_base', hang=True)
        task = self.achieve(CARRY)
        self.wait_for_step('move_base')
        self.system.kill('planner')
        self.addCleanup(self.system.start_planner)
        self.system.behave('move_base', reason='no_path')
        self.system.kill('middle_layer')
        self.system.start_fake('middle_layer')
        result = task.result()
        self.assertIn(result.code, (self.codes.FAILED, self.codes.NO_PLAN))

    def test_a_middle_layer_that_dies_in_a_step_and_comes_back(self):
        self.system.behave('move_base', hang=True, times=1)
        task = self.achieve(CARRY)
        self.wait_for_step('move_base')
        self.system.kill('middle_layer')
        self.system.behave('move_base')
        self.system.start_fake('middle_layer')
        result = task.result()  # whatever it is, it comes
        self.assertIn(result.code, (self.codes.SUCCEEDED, self.codes.FAILED), result.reason)
        self.assertTrue(any(s.phase == self.phases.FAILED for s in result.steps))
        # A server that has just started may send a result before anybody is there to hear it: that
        # is noticed, and not waited for until the step is overdue.
        self.assertEqual([s.note for s in result.steps if 'timed_out' in s.note], [])

    def test_a_middle_layer_that_is_gone(self):
        self.system.behave('move_base', hang=True)
        task = self.achieve(CARRY)
        self.wait_for_step('move_base')
        self.system.kill('middle_layer')
        self.addCleanup(self.system.start_fake, 'middle_layer')
        self.require(task, self.codes.FAILED)

    def test_the_blackboard_restarted_in_the_middle_loses_nothing(self):
        self.system.behave('move_base', hang=True)
        task = self.achieve(CARRY)
        self.wait_for_step('move_base')
        before = wait_until(lambda: [e.id for e in self.system.episodes() if not e.outcome],
                            'the episode')[-1]
        self.system.kill('blackboard')
        self.system.behave('move_base')
        self.system.free('move_base')
        self.system.start_blackboard()
        result = self.require(task, self.codes.SUCCEEDED)
        self.assertEqual(result.episode, before)
        wait_until(lambda: self.system.episodes()[-1].outcome, 'the end of the episode')
        ended = [text_of(f, 'hasResult') for f in self.system.fluents(
            'RobotActivity', in_episode=True, episode=before)]
        begun = [s for s in result.steps
                 if s.started == s.started and s.action.name != 'imagine']
        self.assertEqual(len([e for e in ended if e]), len(begun))

    @long_case
    def test_tasks_in_quick_succession_each_have_their_episode(self):
        before = self.system.episodes()[-1].id if self.system.episodes() else 0
        self.system.behave('tuck_arms', hang=True)
        for _ in range(10):
            task = self.achieve(CARRY)
            task.wait_for_feedback(lambda f: f.steps, 'a plan')
            task.cancel()
            self.require(task, self.codes.PREEMPTED)
        outcomes = wait_until(lambda: self.ended_after(before, 10), 'the end of ten episodes')
        self.assertEqual(outcomes, 10 * ['preempted: preempted'])

    @long_case
    def test_without_a_blackboard_a_task_is_refused_at_first_only(self):
        self.system.kill('monitor')
        self.system.kill('blackboard')
        self.system.start_monitor()
        self.system.require_server()
        self.require(self.achieve(CARRY), self.codes.FAILED, 'Blackboard')
        self.system.start_blackboard()
        self.system.reset()
        self.require(self.achieve(CARRY), self.codes.SUCCEEDED)

    def test_a_monitor_that_died_leaves_no_step_going_on(self):
        """What somebody else has the robot do goes on."""
        self.system.behave('move_base', hang=True)
        self.system.behave('move_torso', hang_for='torsomiddleposture')
        other = self.system.execute('move_torso', 'torsomiddleposture')
        self.addCleanup(other.give_up)
        self.achieve(CARRY)
        self.wait_for_step('move_base')
        self.system.kill('monitor')
        self.system.start_monitor()
        self.system.require_server()
        wait_until(lambda: 'preempted move_base' in self.system.log(), 'the robot to be stopped')
        self.system.free('move_torso')
        result = other.result()
        self.assertEqual(result.code, result.SUCCEEDED, self.system.log())

    # Numbers.

    def test_it_reacts_within_50_ms(self):
        self.require(self.achieve(CARRY), self.codes.SUCCEEDED)
        values = diagnostics(self.system.rospy, 'execution_monitor',
                             lambda v: int(v['reactions']) > 15)
        self.assertLess(float(values['reaction_p99_ms']), MOST_REACTION, values)
        self.assertEqual(values['records_refused'], '0', [
            line for line in self.system.nodes['monitor'].lines if 'record=refused' in line])
        self.assertEqual(values['planner'], 'there')

    # The command line.

    def hires(self, *arguments):
        return self.system.processes.start([executable('hires'), 'achieve', *arguments],
                                           self.system.main)

    def test_the_verb_shows_steps_and_writes_a_timeline(self):
        csv = os.path.join(self.system.processes.folder.name, 'run.csv')
        verb = self.hires(CARRY, '--timeline', csv)
        self.assertEqual(verb.wait(), 0, verb.output())
        self.assertIn('done      move_base_param(%s, slow)' % NORTH, verb.output())
        self.assertRegex(verb.output(), '~ move_base_param.* ranked')
        self.assertIn('succeeded', verb.output())
        with open(csv) as file:
            self.assertEqual(len(file.readlines()), 2 + 1 + len(self.system.robot_steps()))

    def test_the_verbs_exit_codes(self):
        self.system.put_wish()
        self.system.behave('imagine', answer='all_failed')
        verb = self.hires(SERVE)
        self.assertEqual(verb.wait(), 2, verb.output())
        self.assertEqual(self.hires('no_such_task').wait(), 1)

    def test_the_verb_preempts_on_interrupt_and_waits(self):
        self.system.behave('move_base', hang=True)
        verb = self.hires(CARRY)
        self.wait_for_step('move_base')
        verb.signal(signal.SIGINT)
        self.assertEqual(verb.wait(), 3, verb.output())
        self.assertIn('preempted move_base', self.system.log())


if __name__ == '__main__':
    run_test('execution_monitor_node', ExecutionMonitorTest)
