#!/usr/bin/env python3
"""The planner as a real node under a main master of its own: plans, limits, ten requests at once,
cancelling, bad requests, restarts. Run alone, or by `rostest hires planner.test`."""

import os
import signal
import sys
import unittest

import yaml

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from action_goal import ActionGoal, require_server  # noqa: E402
from ros_processes import LIMIT, Processes, executable, wait_until  # noqa: E402
from test_run import run_test  # noqa: E402

# Somebody gets something; and forty choices whose every way ends in vain.
DOMAIN = """(defdomain delivery (
  (:operator (!walk ?from ?to) ((at ?from)) ((at ?from)) ((at ?to)) 5)
  (:operator (!ride ?from ?to) ((at ?from)) ((at ?from)) ((at ?to)) 2)
  (:operator (!!note ?what) () () () 0)
  (:operator (!hand_over ?thing ?who)
    ((has ?thing) (lives ?who ?place) (at ?place)) ((has ?thing)) ((given ?thing ?who)))
  (:operator (!mark ?n ?bit) () ((marked ?n ?bit)))
  (:method (travel ?to) on_foot ((at ?from) (path ?from ?to)) ((!walk ?from ?to)))
  (:method (travel ?to) by_bus ((at ?from) (bus ?from ?to)) ((!ride ?from ?to)))
  (:method (deliver ?thing ?who)
    ((lives ?who ?place)) ((travel ?place) (!!note ?who) (!hand_over ?thing ?who)))
  (:method (choose ?n) ((bit ?bit)) ((!mark ?n ?bit)))
  (:method (finish) ((never)) ())))
"""
HOME = """(defproblem home delivery
  ((at home) (has parcel) (lives anna park) (path home park) (bus home park) (bit zero) (bit one))
  ((deliver parcel anna)))
(defproblem shop delivery ((at shop) (path shop park)) ((travel park)))
"""
ENDLESS = '(%s (finish))' % ' '.join('(choose n%d)' % i for i in range(40))
MANY = '(%s)' % ' '.join('(choose n%d)' % i for i in range(40))
MAX_WAITING = 120  # more than actionlib keeps messages by default
# Its thread says what it found; one that is slow to see that it is cancelled is not waited for.
SEARCHING = 'cancelled (after|during the search)'
PREEMPT_LIMIT = 0.05  # [s] on the planner's own clock, for up to ten at once


def config(**changes):
    keys = dict(domain='domain.lisp', initial=['home.lisp'], threads=2, max_waiting=MAX_WAITING,
                time_limit=600.0, memory_limit=500.0, max_depth=100000, max_plans=100,
                feedback_period=0.2)
    keys.update(changes)
    return yaml.safe_dump(keys)


class PlannerTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.processes = Processes()
        cls.addClassCleanup(cls.processes.stop_all)
        cls.main = cls.processes.master()
        # actionlib's clients drop what they send in a burst beyond 10 messages.
        cls.main.set_param('/actionlib_client_pub_queue_size', 2 * MAX_WAITING)
        cls.processes.write('domain.lisp', DOMAIN)
        cls.processes.write('home.lisp', HOME)
        cls.config = cls.processes.write('planner.yaml', config())
        cls.node = cls.start_node()
        os.environ.update(ROS_MASTER_URI=cls.main.uri, ROS_IP='127.0.0.1',
                          ROS_LOG_DIR=cls.processes.folder.name)
        os.environ.pop('ROS_HOSTNAME', None)
        import actionlib
        import rospy
        from actionlib_msgs.msg import GoalStatus
        from hires import msg
        cls.rospy, cls.msg, cls.status = rospy, msg, GoalStatus
        cls.outcomes = msg.PlanResult
        rospy.init_node('planner_test', disable_signals=True)
        cls.client = actionlib.ActionClient('plan', msg.PlanAction)
        cls.require_server()

    @classmethod
    def start_node(cls, *arguments, config=None):
        return cls.processes.start(
            [executable('planner'), '_config:=' + (config or cls.config), *arguments], cls.main)

    @classmethod
    def require_server(cls):
        require_server(cls.client, cls.node.output)

    def tearDown(self):
        """The node lives, and answers."""
        self.assertTrue(self.node.is_running(), self.node.output())
        self.require_usual_plan(self.ask(self.goal('deliver parcel anna')))

    def goal(self, task='', **fields):
        goal = self.msg.PlanGoal(task=task)
        for field, value in fields.items():
            setattr(goal, field, value)
        return goal

    def send(self, goal):
        request = ActionGoal(self.client, goal)
        self.addCleanup(request.abandon)
        return request

    def ask(self, goal):
        return self.send(goal).result()

    def atoms(self, *atoms):
        return [self.msg.Atom(predicate, list(arguments)) for predicate, *arguments in atoms]

    def tasks_of(self, result):
        return [[step.task for step in plan.steps] for plan in result.plans]

    def require_usual_plan(self, result):
        self.assertEqual(result.outcome, self.outcomes.FOUND, result.why)
        self.assertEqual(self.tasks_of(result), [
            ['(!walk home park)', '(!!note anna)', '(!hand_over parcel anna)']])

    def require(self, goal, outcome, *texts):
        request = self.send(goal)
        result = request.result()
        self.assertEqual(result.outcome, outcome, result.why)
        self.assertEqual(request.state(), self.status.ABORTED)
        self.assertEqual(request.status_text(), result.why)
        self.assertEqual(result.plans, [])
        for text in texts:
            self.assertIn(text, result.why)
        return result

    # What is found.

    def test_a_plan_comes_with_all_that_its_steps_rest_on(self):
        request = self.send(self.goal('deliver parcel anna'))
        result = request.result()
        self.assertEqual(request.state(), self.status.SUCCEEDED)
        self.require_usual_plan(result)
        self.assertEqual(result.why, '1 plan, 3 steps, cost 6')
        self.assertEqual(result.expansions, 5)  # deliver, travel and three steps
        self.assertGreater(result.inferences, 0)
        self.assertEqual(result.seconds_to_stop, 0.0)
        plan = result.plans[0]
        self.assertEqual(plan.cost, 6.0)
        walk, note, hand_over = plan.steps
        self.assertEqual((walk.action.name, walk.action.arguments), ('walk', ['home', 'park']))
        self.assertEqual((walk.cost, walk.path), (5.0, 'deliver/travel'))
        self.assertEqual([step.bookkeeping for step in plan.steps], [False, True, False])
        self.assertEqual(note.action.name, 'note')
        self.assertEqual(walk.deletes, self.atoms(('at', 'home')))
        self.assertEqual(walk.adds, self.atoms(('at', 'park')))
        self.assertEqual([(p.atom, p.holds) for p in hand_over.preconditions], [
            (atom, True) for atom in self.atoms(('has', 'parcel'), ('lives', 'anna', 'park'),
                                                ('at', 'park'))])
        initial = self.msg.CausalLink.INITIAL
        self.assertEqual([(link.producer, link.precondition) for link in hand_over.links],
                         [(initial, 0), (initial, 1), (0, 2)])
        # Its subtasks are ordered, though no link joins the note to the walk.
        self.assertEqual([list(step.after) for step in plan.steps], [[], [0], [1]])

    def test_all_plans_and_the_cheapest(self):
        result = self.ask(self.goal('deliver parcel anna', which=self.msg.PlanGoal.ALL))
        self.assertEqual([plan.cost for plan in result.plans], [6.0, 3.0])
        self.assertTrue(result.exhausted)
        result = self.ask(self.goal('deliver parcel anna', which=self.msg.PlanGoal.BEST))
        self.assertEqual([plan.cost for plan in result.plans], [3.0])
        result = self.ask(self.goal(MANY, which=self.msg.PlanGoal.ALL, max_plans=7))
        self.assertEqual((len(result.plans), result.exhausted), (7, False))

    def test_a_task_network(self):
        result = self.ask(self.goal('((travel park) (!!note (a b)))'))
        self.assertEqual(self.tasks_of(result), [['(!walk home park)', '(!!note (a b))']])
        self.assertEqual(result.plans[0].steps[1].action.arguments, ['(a b)'])

    def test_a_problem_by_its_name(self):
        self.assertEqual(self.tasks_of(self.ask(self.goal(problem='Shop'))),
                         [['(!walk shop park)']])
        self.assertEqual(self.tasks_of(self.ask(self.goal('!!note x', problem='shop'))),
                         [['(!!note x)']])

    def test_a_state_replaces_the_facts(self):
        result = self.ask(self.goal('deliver (parcel 2) bert', state=self.atoms(
            ('At', 'Moon'), ('has', '(parcel 2)'), ('lives', 'bert', 'mars'),
            ('bus', 'moon', 'mars'))))
        self.assertEqual(self.tasks_of(result), [
            ['(!ride moon mars)', '(!!note bert)', '(!hand_over (parcel 2) bert)']])
        self.require(self.goal('deliver parcel anna', state=self.atoms(('at', 'home'))),
                     self.outcomes.NO_PLAN, 'there is no plan')

    def test_excluded_steps_are_not_taken_until_none_remains(self):
        no_walk = self.atoms(('imagined_failure', '!walk', 'home', 'park'))
        result = self.ask(self.goal('travel park', more_facts=no_walk))
        self.assertEqual(self.tasks_of(result), [['(!ride home park)']])
        no_ride = self.atoms(('imagined_failure', 'ride', 'home', 'park'))
        result = self.require(
            self.goal('travel park', more_facts=no_walk + no_ride, max_trace=100),
            self.outcomes.NO_PLAN, 'every way was tried')
        self.assertTrue(result.exhausted)
        self.assertTrue(any('(!walk home park)' in line for line in result.trace), result.trace)

    # Limits.

    def test_each_limit_has_an_outcome_of_its_own(self):
        self.require(self.goal(ENDLESS, time_limit=self.rospy.Duration(0.1)),
                     self.outcomes.LIMIT_TIME, 'stopped at the time limit')
        self.require(self.goal(ENDLESS, memory_limit=0.001), self.outcomes.LIMIT_MEMORY,
                     'stopped at the memory limit')

    def test_at_the_time_limit_the_cheapest_so_far_is_given(self):
        request = self.send(self.goal(MANY, which=self.msg.PlanGoal.BEST,
                                      time_limit=self.rospy.Duration(0.5)))
        result = request.result()
        self.assertEqual(result.outcome, self.outcomes.LIMIT_TIME, result.why)
        self.assertEqual(request.state(), self.status.ABORTED)
        self.assertEqual([len(plan.steps) for plan in result.plans], [40])
        self.assertTrue(any(f.best_cost == 40.0 for f in request.feedback))

    def test_feedback_tells_how_far_the_search_is_at_its_period(self):
        request = self.send(self.goal(ENDLESS))
        wait_until(lambda: len(request.feedback) >= 4, 'feedback')
        request.cancel()
        request.result()
        told = [f for f in request.feedback if not f.waiting]
        for a, b in zip(told, told[1:]):
            self.assertGreater(b.expansions, a.expansions)
            self.assertGreaterEqual(a.seconds_left - b.seconds_left, 0.199)
        self.assertTrue(0 < told[-1].depth < 1000, told[-1])
        self.assertEqual((told[-1].plans, told[-1].best_cost), (0, float('inf')))

    # Many, and cancelling.

    def begin_endless(self):
        request = self.send(self.goal(ENDLESS))
        request.wait_for_feedback(lambda f: f.expansions > 0, 'the search to be under way')
        return request

    def require_cancelled(self, request, text):
        """Answered as cancelled, and in time."""
        result = self.require_answered_as_cancelled(request, text)
        self.assertLess(result.seconds_to_stop, PREEMPT_LIMIT)
        return result

    def require_answered_as_cancelled(self, request, text):
        result = request.result()
        self.assertEqual(result.outcome, self.outcomes.CANCELLED, result.why)
        self.assertEqual(request.state(), self.status.PREEMPTED)
        self.assertRegex(result.why, text)
        self.assertEqual(result.plans, [])
        self.assertGreaterEqual(result.seconds_to_stop, 0.0)
        return result

    def test_ten_requests_at_once_are_all_answered(self):
        names = ['guest%d' % i for i in range(10)]
        requests = [self.send(self.goal('deliver parcel ' + name, more_facts=self.atoms(
            ('lives', name, 'park')))) for name in names]
        for name, request in zip(names, requests):
            result = request.result()
            self.assertEqual(result.outcome, self.outcomes.FOUND, result.why)
            self.assertEqual(self.tasks_of(result), [
                ['(!walk home park)', '(!!note %s)' % name, '(!hand_over parcel %s)' % name]])

    def test_a_running_search_is_cancelled_within_50_ms(self):
        for _ in range(5):
            request = self.begin_endless()
            request.cancel()
            result = self.require_cancelled(request, SEARCHING)
            self.assertGreater(result.expansions, 0)

    def test_a_waiting_request_is_cancelled_within_50_ms_and_the_others_go_on(self):
        running = [self.begin_endless() for _ in range(2)]
        waiting = [self.send(self.goal(ENDLESS)) for _ in range(8)]
        for request in waiting:
            request.wait_for_feedback(lambda f: f.waiting, 'word that it waits')
            request.cancel()
        for request in waiting:
            self.require_cancelled(request, 'cancelled while it waited')
        for request in running:
            told = len(request.feedback)
            wait_until(lambda: len(request.feedback) > told, 'the search to go on')
            request.cancel()
            self.require_cancelled(request, SEARCHING)

    def test_ten_searches_are_cancelled_at_once(self):
        requests = [self.send(self.goal(ENDLESS)) for _ in range(10)]
        for request in requests:
            request.wait_for_active()
        self.client.cancel_all_goals()
        for request in requests:
            self.require_cancelled(request, 'cancelled')

    def test_a_cancelled_search_for_all_gives_no_half_answer(self):
        request = self.send(self.goal(MANY, which=self.msg.PlanGoal.BEST))
        request.wait_for_feedback(lambda f: f.plans > 0, 'a plan')
        request.cancel()
        result = self.require_cancelled(request, SEARCHING)
        if 'after' in result.why:
            self.assertIn('cost 40 so far', result.why)

    def test_time_runs_while_a_request_waits(self):
        running = [self.begin_endless() for _ in range(2)]
        result = self.require(
            self.goal('travel park', time_limit=self.rospy.Duration(0.1)),
            self.outcomes.LIMIT_TIME, 'while 2 other searches were under way')
        self.assertGreaterEqual(result.seconds_waiting, 0.1)
        for request in running:
            request.cancel()
            request.result()

    def test_more_than_may_wait_are_turned_away(self):
        # All are answered when all are cancelled at once. How soon is not promised for so many:
        # each answer publishes the status of all.
        running = [self.begin_endless() for _ in range(2)]
        waiting = [self.send(self.goal(ENDLESS)) for _ in range(MAX_WAITING)]
        for request in waiting:
            request.wait_for_feedback(lambda f: f.waiting, 'word that it waits')
        self.require(self.goal('travel park'), self.outcomes.BUSY,
                     '%d requests wait already' % MAX_WAITING)
        for request in running + waiting:
            request.wait_for_active()
        self.client.cancel_all_goals()
        for request in running + waiting:
            self.require_answered_as_cancelled(request, 'cancelled')

    # Bad requests.

    def require_invalid(self, goal, *texts):
        self.require(goal, self.outcomes.INVALID, *texts)

    def test_tasks_that_are_none(self):
        for task, *texts in (('', 'task and problem are both empty'),
                             ('; nothing', 'names no task'),
                             ('(deliver parcel', 'task:1:1'),
                             ('deliver parcel anna)', 'task:1:20'),
                             ('delivr parcel anna', "'deliver'"),
                             ('deliver parcel', 'deliver'),
                             ('!fly moon', 'fly'),
                             ('3', 'task:'),
                             ('(' * 100000, 'task:1:'),
                             ('x' * 100000, 'task:1:1')):
            with self.subTest(task=task[:40]):
                self.require_invalid(self.goal(task), *texts)

    def test_a_problem_that_is_unknown(self):
        self.require_invalid(self.goal(problem='hoem'), "problem 'hoem' is unknown", "'home'")

    def test_atoms_that_are_none(self):
        for atom, *texts in ((('at', '?x'), 'state[1].arguments[0]', '?x has a variable'),
                             (('at', ''), 'state[1].arguments[0]', 'has 0 terms'),
                             (('at', 'a b'), 'state[1].arguments[0]', 'has 2 terms'),
                             (('at', '(a'), 'state[1].arguments[0]:1:1'),
                             (('',), 'state[1].predicate', 'has 0 terms'),
                             (('3', 'a'), 'state[1].predicate', 'is 3, wanted a name'),
                             (('(at)', 'a'), 'state[1].predicate', 'wanted a name'),
                             (('at', 'a\x00b)('), 'state[1].arguments[0]')):
            with self.subTest(atom=atom):
                self.require_invalid(
                    self.goal('travel park', state=self.atoms(('at', 'home'), atom)), *texts)
        self.require_invalid(self.goal('travel park', more_facts=self.atoms(('at', '?x'))),
                             'more_facts[0].arguments[0]')

    def test_numbers_out_of_range(self):
        nan = float('nan')
        for fields, text in ((dict(which=3), 'which is 3'),
                             (dict(time_limit=self.rospy.Duration(-1)), 'time_limit is -1 s'),
                             (dict(time_limit=self.rospy.Duration(601)), 'at most 600 s'),
                             (dict(memory_limit=nan), 'memory_limit is nan MB'),
                             (dict(memory_limit=-1.0), 'memory_limit is -1 MB'),
                             (dict(memory_limit=501.0), 'at most 500 MB'),
                             (dict(max_plans=101), 'max_plans is 101, wanted at most 100'),
                             (dict(max_trace=4294967295), 'max_trace')):
            with self.subTest(text=text):
                self.require_invalid(self.goal('travel park', **fields), text)

    def test_answers_to_endless_text_are_short(self):
        for task in ('x' * 1000000, '{0} %s %n', '\u00e4\u2603', 'a\nb'):
            result = self.ask(self.goal(task))
            self.assertEqual(result.outcome, self.outcomes.INVALID)
            self.assertLess(len(result.why), 3000)

    # The node itself.

    def test_a_killed_planner_can_be_started_again(self):
        self.begin_endless()
        self.node.kill()
        self.start_again()

    def test_a_planner_that_is_stopped_during_a_search_ends_in_good_order(self):
        self.begin_endless()
        self.node.signal(signal.SIGTERM)
        self.assertEqual(self.node.wait(), 0)
        self.start_again()

    def start_again(self):
        type(self).node = self.start_node()
        self.node.wait_for('domain=delivery')
        self.reconnect()

    def reconnect(self):
        """A client that has talked to an earlier planner may take the first goal for lost."""
        import actionlib
        type(self).client = actionlib.ActionClient('plan', self.msg.PlanAction)
        wait_until(lambda: self.main.publishers('/plan/result') == ['/planner'], 'the planner')
        self.require_server()

    def test_diagnostics_tell_the_domain(self):
        from diagnostic_msgs.msg import DiagnosticArray
        array = self.rospy.wait_for_message('/diagnostics', DiagnosticArray, LIMIT)
        told = {pair.key: pair.value for status in array.status for pair in status.values}
        self.assertEqual(told['domain'], 'delivery')
        self.assertIn('of 2 threads', array.status[0].message)

    def test_files_that_are_wrong_end_the_start_with_their_name(self):
        broken = self.processes.write('broken.lisp', '(defdomain broken (')
        unclear = self.processes.write('unclear.yaml', config(thraeds=3))
        for arguments, text in ((['_domain:=' + broken], 'broken.lisp:1:'),
                                (['_domain:=/nowhere.lisp'], '/nowhere.lisp'),
                                (['_initial:=/nowhere.lisp'], '/nowhere.lisp'),
                                (['_threads:=0'], '~threads is 0'),
                                (['_thraeds:=3'], 'thraeds'),
                                (['_config:=' + unclear], 'thraeds')):
            with self.subTest(text=text):
                node = self.start_node('__name:=other_planner', 'plan:=other_plan', *arguments)
                self.assertEqual(node.wait(), 1, node.output())
                self.assertIn(text, node.output())
                self.main_forgets('/other_planner')

    def main_forgets(self, node):
        """Parameters of a node outlive it."""
        for key in ('config', 'domain', 'initial', 'threads', 'thraeds'):
            self.main._call('deleteParam', '%s/%s' % (node, key))

    # The command line.

    def test_an_interrupted_search_of_the_command_line_ends_in_good_order(self):
        endless = self.processes.write(
            'endless.lisp', '(defproblem endless delivery ((bit zero) (bit one)) %s)' % ENDLESS)
        domain = os.path.join(self.processes.folder.name, 'domain.lisp')
        process = self.processes.start(
            [executable('hires'), 'plan', '--domain', domain, '--problem', endless], self.main)
        wait_until(lambda: cpu_seconds(process.pid) > 0.5, 'the search to be under way')
        process.signal(signal.SIGINT)
        self.assertEqual(process.wait(), 130, process.output())
        self.assertIn('cancelled: cancelled after ', process.output())


def cpu_seconds(pid):
    """Processor time that a process has used."""
    with open('/proc/%d/stat' % pid) as file:
        fields = file.read().rsplit(')', 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')


if __name__ == '__main__':
    # Not 'planner': rostest gives the test's name to its node.
    run_test('planner_node', PlannerTest)
