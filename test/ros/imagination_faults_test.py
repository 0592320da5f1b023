#!/usr/bin/env python3
"""What becomes of a request when processes die, hang, come late or are stopped: with real ones. Run
alone, or by `rostest hires imagination_faults.test`.

Whatever happens, an answer is either the very one that an undisturbed run in one process gives, or
says what it lacks. Times to recover are printed, not judged: the machine may be busy.
"""

import os
import re
import signal
import sys
import time
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from imagination_system import ImaginationSystem  # noqa: E402
from ros_processes import executable, wait_until  # noqa: E402
from test_run import run_test  # noqa: E402

ROLLOUTS = 40  # long enough for something to happen in the middle
ENDLESS = 100 * ROLLOUTS  # not played to its end before what a test does to it
FEW = 16       # enough to see whether all still works
UNDER_WAY = r'feedback done=([2-7]\d|\d{3,}) '  # 20 of the 80 are in; of an endless one at least
FAMILY = ('worker_host', 'rosmaster', 'sim_worker', 'relay')  # of a worker, its supervisor included


class Shared:
    """The system with two workers that one case after the other disturbs. Each case must leave it
    as it was at first; after one that did not, the next gets a new one."""

    def __init__(self):
        self._system, self._is_well = None, True

    def take(self):
        if not self._is_well:
            self.destroy()
        self._is_well = False
        if self._system is None:
            self._system = ImaginationSystem(workers=2).start()
        return self._system

    def give_back(self):
        self._is_well = True

    def destroy(self):
        if self._system is not None:
            self._system.destroy()
            self._system = None


class FaultsCase(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.local = ImaginationSystem(workers=1)
        cls.addClassCleanup(cls.local.destroy)
        cls.expected = {}
        cls.shared = Shared()
        cls.addClassCleanup(cls.shared.destroy)
        # It gives up after 10 s, in which the other cases run.
        cls.unanswered = cls.local.ask()

    def system(self, workers=2):
        system = ImaginationSystem(workers)
        self.addCleanup(system.destroy)
        return system

    def start(self, workers=2, **scheduler):
        return self.system(workers).start(**scheduler)

    def report_time(self, what, seconds):
        # Past rosunit, which keeps standard output to itself.
        print('%s: %s: %.2f s' % (self.id().rsplit('.', 1)[1], what, seconds),
              file=sys.__stderr__, flush=True)

    def watch(self, system):
        watcher = system.watch()
        self.addCleanup(watcher.destroy)
        return watcher

    def begin(self, system, *more, rollouts=ROLLOUTS):
        """A request that is under way: (watcher, question)."""
        watcher = self.watch(system)
        question = system.ask(*more, rollouts=rollouts)
        watcher.wait_for(UNDER_WAY)
        return watcher, question

    def content_in_one_process(self, rollouts, seed):
        key = (rollouts, seed)
        if key not in self.expected:
            answer = self.local.ask('--local', rollouts=rollouts, seed=seed).answer()
            self.assertEqual(answer.code, 0, answer.output)
            self.expected[key] = answer.content()
        return self.expected[key]

    def require_expected(self, answer, seed=7, rollouts=ROLLOUTS):
        self.assertEqual(answer.code, 0, answer.output)
        self.assertEqual(answer.content(), self.content_in_one_process(rollouts, seed))

    def require_idle(self, watcher):
        """Waits until both workers have nothing to do. Nobody may be giving them work any more."""
        def is_idle(k):
            told = [line for line in list(watcher.lines) if line.startswith('worker=%d ' % k)]
            return told and told[-1].endswith(' active=0')
        for k in (1, 2):
            wait_until(lambda: is_idle(k), 'worker %d to be idle' % k)

    def require_next_works(self, system):
        self.require_expected(system.ask(rollouts=FEW).answer(), rollouts=FEW)

    def require_as_at_first(self, system):
        """The next request is answered; everybody is there, once, and nobody else."""
        self.require_next_works(system)
        for k in (1, 2):
            wait_until(lambda: self.last_told_of(system, k) == 'joined', 'worker %d to join' % k)
        wanted = sorted(('imagination_client',) + system.workers * FAMILY)
        wait_until(lambda: self.kinds(system) == wanted,
                   '%s alone to be there, not %s' % (wanted, system.alive()))
        self.shared.give_back()

    def last_told_of(self, system, k):
        """What the client said last of worker k: joined or lost."""
        return re.findall(r'worker=%d (joined|lost)' % k, system.client.output())[-1]

    def kinds(self, system):
        """Of all that lives and is no tool of the test."""
        programs = (command.replace('/usr/bin/python3 ', '').split()[0]
                    for command in system.alive().values())
        names = (os.path.basename(program) for program in programs)
        return sorted(name for name in names if name != 'imagination_watcher')

    # One worker of two.

    def kill_part_of_worker(self, kind):
        system = self.shared.take()
        joined = system.times_joined(1)
        _, question = self.begin(system)
        os.kill(system.pids_of_worker(1)[kind], signal.SIGKILL)
        killed = time.monotonic()
        system.wait_until_joined(1, times=joined + 1)
        self.report_time('from SIGKILL to joined', time.monotonic() - killed)
        self.require_expected(question.answer())
        self.require_as_at_first(system)


class ImaginationFaultsTest(FaultsCase):
    def test_a_request_ends_when_who_asked_is_killed(self):
        system = self.shared.take()
        watcher, question = self.begin(system, rollouts=ENDLESS)
        told = len(system.client.lines)
        question.process.kill()
        system.client.wait_for('cancelled: /hires_imagine_.*, which asked, is gone', first=told)
        self.require_idle(watcher)
        self.require_as_at_first(system)

    def test_a_killed_sim_worker_comes_back_and_the_answer_is_the_same(self):
        self.kill_part_of_worker('sim_worker')

    def test_a_killed_worker_host_leaves_no_child_and_the_other_worker_answers(self):
        system = self.shared.take()
        joined = system.times_joined(1)
        _, question = self.begin(system)
        system.hosts[1].kill()
        wait_until(lambda: not system.pids_of_worker(1), 'the children to end', 2.0)
        self.require_expected(question.answer())
        system.start_host(1)
        system.wait_until_joined(1, times=joined + 1)
        self.require_as_at_first(system)

    def test_a_hung_worker_is_done_without_and_joins_again_when_it_goes_on(self):
        system = self.shared.take()
        joined, told = system.times_joined(1), len(system.client.lines)
        _, question = self.begin(system)
        hung = system.pids_of_worker(1)['sim_worker']
        os.kill(hung, signal.SIGSTOP)
        stopped = time.monotonic()
        system.client.wait_for('worker=1 lost', first=told)
        self.report_time('from SIGSTOP to lost', time.monotonic() - stopped)
        self.require_expected(question.answer())
        os.kill(hung, signal.SIGCONT)
        system.wait_until_joined(1, times=joined + 1)
        self.require_as_at_first(system)

    # Every worker.

    def test_without_workers_there_is_no_answer(self):
        system = self.system()
        system.start_client(worker_wait=0.5)
        answer = system.ask().answer()
        self.assertEqual(answer.code, 3, answer.output)
        self.assertEqual(answer.report['outcome'], 'no_worker')
        self.assertEqual(answer.report['ranking'], [])
        self.assertIsNone(answer.report['recommended'])
        self.assertIn('no worker is there to imagine it', answer.report['why'])

    def test_when_all_workers_go_what_was_finished_is_ranked(self):
        system = self.start(worker_wait=0.5)
        # However few are finished, one success of them is enough.
        _, question = self.begin(system, '--min-success', '0.001', rollouts=ENDLESS)
        for host in system.hosts.values():
            host.kill()
        answer = question.answer()
        self.assertEqual(answer.code, 0, answer.output)
        self.assertIn(answer.report['outcome'], ('ranked_at_deadline', 'close'))
        self.assertFalse(answer.report['complete'])
        finished = answer.rollouts()
        self.assertEqual(finished[0], finished[1])
        self.assertTrue(0 < finished[0] < ENDLESS, finished)
        # What was finished is what the first so many rollouts are worth, not an estimate.
        shorter = system.ask('--local', rollouts=finished[0]).answer()
        # Only the intervals tell how it was stopped.
        for report, kind in ((answer.report, 'confidence sequence'),
                             (shorter.report, 'Clopper-Pearson')):
            for prediction in report['ranking']:
                self.assertEqual(prediction['success'].pop('interval'), kind)
                del prediction['success']['lower'], prediction['success']['upper']
                del prediction['expected_cost']['lower'], prediction['expected_cost']['upper']
        self.assertEqual(answer.report['ranking'], shorter.report['ranking'])

    # Too late, or not wanted any more.

    def test_a_deadline_too_short_for_one_rollout_gives_no_answer(self):
        system = self.shared.take()
        answer = system.ask('--deadline', '0.001').answer()
        self.assertEqual(answer.code, 4, answer.output)
        self.assertEqual(answer.report['outcome'], 'nothing_finished')
        self.assertEqual(answer.report['ranking'], [])
        self.assertIsNone(answer.report['recommended'])
        self.assertIn('deadline', answer.report['why'])
        self.require_as_at_first(system)

    def test_an_interrupted_request_is_cancelled_and_the_workers_rest(self):
        system = self.shared.take()
        watcher, question = self.begin(system, rollouts=ENDLESS)
        question.process.signal(signal.SIGINT)
        interrupted = time.monotonic()
        answer = question.answer()
        self.require_idle(watcher)
        self.report_time('from SIGINT to idle workers', time.monotonic() - interrupted)
        self.assertEqual(answer.code, 130, answer.output)
        self.assertEqual(answer.report['outcome'], 'cancelled')
        watcher.wait_for(' status=2 ')  # preempted; the outcome says what was found by then
        self.require_as_at_first(system)

    # The imagination client and the main master.

    def test_a_killed_client_is_reported_and_the_next_one_answers(self):
        system = self.shared.take()
        watcher, question = self.begin(system, rollouts=ENDLESS)
        system.client.kill()
        killed = time.monotonic()
        answer = question.answer()
        self.assertEqual(answer.code, 1, answer.output)
        self.assertIn('the imagination client went away during the request', answer.output)
        self.assertIsNone(answer.report)
        self.require_idle(watcher)
        self.report_time('from SIGKILL to idle workers', time.monotonic() - killed)
        started = time.monotonic()
        system.start_client()
        for k in (1, 2):
            system.wait_until_joined(k)
        self.report_time('from start to joined', time.monotonic() - started)
        self.require_as_at_first(system)

    def test_without_a_master_or_a_client_the_question_says_so(self):
        self.unanswered.process.wait_for('no imagination client serves the action')
        self.assertEqual(self.unanswered.answer().code, 1)
        system = self.system(workers=1)
        system.main.kill()
        question = system.ask()
        self.assertEqual(question.answer().code, 1)
        self.assertIn('no ROS master answers at ' + system.main.uri.rstrip('/'),
                      question.process.output())

    def test_whatever_happened_before_all_end_when_they_are_told_to(self):
        # Last by its name: of the system that the cases above disturbed.
        system = self.shared.take()
        self.report_time('shutdown', system.shut_down())

    # More than one request.

    def test_two_requests_at_once_get_the_answers_they_get_alone(self):
        system = self.shared.take()
        watcher = self.watch(system)
        questions = {seed: system.ask(rollouts=ROLLOUTS, seed=seed) for seed in (7, 8)}
        for seed, question in questions.items():
            self.require_expected(question.answer(), seed)
        # Both were under way at the same time: their feedback is interleaved.
        goals = [line.split('goal=')[1] for line in watcher.lines if line.startswith('feedback')]
        self.assertGreater(sum(a != b for a, b in zip(goals, goals[1:])), 1, goals)
        self.require_as_at_first(system)


class ImaginationRareFaultsTest(FaultsCase):
    def test_a_worker_whose_master_is_killed_comes_back_and_the_answer_is_the_same(self):
        self.kill_part_of_worker('rosmaster')

    def test_a_worker_whose_relay_is_killed_comes_back_and_the_answer_is_the_same(self):
        self.kill_part_of_worker('relay')

    def test_a_worker_that_hangs_and_goes_on_during_a_request_changes_nothing(self):
        system = self.shared.take()
        told = len(system.client.lines)
        _, question = self.begin(system)
        hung = system.pids_of_worker(1)['sim_worker']
        os.kill(hung, signal.SIGSTOP)
        system.client.wait_for('worker=1 lost', first=told)
        os.kill(hung, signal.SIGCONT)
        self.require_expected(question.answer())
        self.require_as_at_first(system)

    def test_a_worker_that_comes_late_answers_in_full(self):
        system = self.system(workers=1)
        system.start_client(worker_wait=60.0)
        question = system.ask(rollouts=FEW)
        system.client.wait_for('request=hires_imagine')
        system.start_host(1)
        self.require_expected(question.answer(), rollouts=FEW)

    def test_a_client_that_is_stopped_ends_the_request_in_good_order(self):
        system = self.shared.take()
        watcher, question = self.begin(system, rollouts=ENDLESS)
        system.client.signal(signal.SIGINT)
        self.assertEqual(system.client.wait(), 0)
        answer = question.answer()
        self.assertEqual(answer.code, 1, answer.output)
        self.assertIn('went away during the request', answer.output)
        self.require_idle(watcher)
        system.start_client()
        for k in (1, 2):
            system.wait_until_joined(k)
        self.require_as_at_first(system)

    def test_a_restarted_main_master_ends_the_request_and_gets_everybody_back(self):
        system = self.shared.take()
        _, question = self.begin(system, rollouts=ENDLESS)
        joined = {k: system.times_joined(k) for k in (1, 2)}
        system.main.kill()
        killed = time.monotonic()
        system.main.start()
        answer = question.answer()
        self.assertEqual(answer.code, 1, answer.output)
        self.assertIn('went away during the request', answer.output)
        self.assertIsNone(answer.report)
        for k in (1, 2):
            system.wait_until_joined(k, times=joined[k] + 1)
        self.report_time('from SIGKILL to joined', time.monotonic() - killed)
        self.require_as_at_first(system)

    def test_a_hung_client_can_be_given_up(self):
        system = self.shared.take()
        told = len(system.client.lines)
        _, question = self.begin(system, rollouts=ENDLESS)
        session = system.client.wait_for(r'session=(\d+) action', first=told).group(1)
        system.client.signal(signal.SIGSTOP)
        question.process.signal(signal.SIGINT)
        answer = question.answer()
        self.assertEqual(answer.code, 130, answer.output)
        self.assertEqual(answer.report['outcome'], 'cancelled')
        self.assertEqual(answer.report['ranking'], [])
        self.assertIn('did not confirm', answer.report['why'])
        system.client.signal(signal.SIGCONT)
        # Also where the cancel is lost, as who sent it has left.
        system.client.wait_for('session=%s outcome=cancelled' % session, first=told)
        self.require_as_at_first(system)

    # Time.

    def start_under_simulated_time(self):
        """The main master's time is that of a simulated robot: (system, robot)."""
        system = self.system(workers=1)
        system.main.set_param('/use_sim_time', True)
        robot = system.run([executable('sim_worker'), '__name:=robot', '_index:=9'])
        wait_until(lambda: system.main.publishers('/clock'), 'the clock')
        return system.start(), robot

    def test_under_simulated_time_the_answer_is_the_same(self):
        system, _ = self.start_under_simulated_time()
        self.require_next_works(system)
        answer = system.ask('--deadline', '1000', rollouts=FEW).answer()
        self.require_expected(answer, rollouts=FEW)
        answer = system.ask('--deadline', '0.001').answer()
        self.assertEqual(answer.code, 4, answer.output)

    def test_a_request_goes_on_and_can_be_cancelled_while_simulated_time_stands_still(self):
        system, robot = self.start_under_simulated_time()
        watcher = self.watch(system)
        question = system.ask(rollouts=ROLLOUTS)
        endless = system.ask(rollouts=ENDLESS, seed=8)
        system.client.wait_for('session=2 ')
        watcher.wait_for('feedback ')
        robot.signal(signal.SIGSTOP)
        self.require_expected(question.answer())
        endless.process.signal(signal.SIGINT)
        answer = endless.answer()
        self.assertEqual(answer.code, 130, answer.output)

    def test_one_request_cancelled_leaves_the_other_alone(self):
        system = self.shared.take()
        told = len(system.client.lines)
        _, unwanted = self.begin(system, rollouts=ENDLESS)
        first = int(system.client.wait_for(r'session=(\d+) action', first=told).group(1))
        question = system.ask(rollouts=ROLLOUTS, seed=8)
        system.client.wait_for('session=%d action' % (first + 1), first=told)
        unwanted.process.signal(signal.SIGINT)
        self.assertEqual(unwanted.answer().code, 130)
        self.require_expected(question.answer(), 8)
        self.require_as_at_first(system)


if __name__ == '__main__':
    if '--rare' in sys.argv:
        run_test('imagination_rare_faults', ImaginationRareFaultsTest)
    else:
        run_test('imagination_faults', ImaginationFaultsTest)
