#!/usr/bin/env python3
"""Tasks drawn at random run to their end, or stop with a reason that is true. Run alone, or by
`rostest hires loop_random_tasks.test`; `tasks:=20 first:=1 --text` draws more of them and shows a
table."""

import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support'))

from closed_loop import IMAGINE_PLACING, link_of  # noqa: E402
from claims import FALSE, Claims, Snapshot  # noqa: E402
from loop_case import LoopCase  # noqa: E402
from random_tasks import RandomTask  # noqa: E402
from ros_processes import wait_until  # noqa: E402
from test_run import run_test  # noqa: E402

ROW = '%-4s %-48s %-32s %5s %7s %-10s %-34s %s'
ENDS = {0: 'succeeded', 1: 'no_plan', 2: 'failed'}


def numbers_given():
    """How many tasks, and the first one's seed."""
    numbers = [int(word) for word in sys.argv[1:] if word.isdigit()]
    return (numbers + [4, 1][len(numbers):])[:2]


class LoopRandomTasksTest(LoopCase):
    SETTINGS = dict(sensing='pictures') if 'pictures' in sys.argv[1:] else {}

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        print('\n' + ROW % ('seed', 'task', 'from', 'steps', 'sim. s', 'end', 'robot touched',
                            'reason | claims [true?]'))

    def run_task(self, seed):
        drawn = RandomTask(seed)
        self.loop.seed = seed
        knowledge = [self.loop.processes.write('knowledge_%d.yaml' % seed, drawn.knowledge(not self.SETTINGS))]
        if drawn.is_placing_imagined:
            knowledge.append(IMAGINE_PLACING)
        self.begin(drawn.robot, drawn.objects, drawn.hidden, knowledge)
        self.claims = Claims()
        begun = self.truth.now()
        task = self.achieve(drawn.task, on_feedback=self.note_claims)
        result = task.result()
        self.note_claims(result)
        self.wait_until_it_stands()
        self.note_end(drawn, result, self.truth.now() - begun)
        self.check(drawn, task, result)

    def note_claims(self, report):
        """As soon as they are said."""
        self.claims.note(report.steps, Snapshot(self.truth))

    def note_end(self, drawn, result, duration):
        steps = [s for s in result.steps
                 if s.started == s.started and s.action.name != 'imagine']
        told = '; '.join('%s [%s]' % claim for claim in self.claims.verdicts) or 'nothing'
        print(ROW % (drawn.seed, drawn.task, drawn.start, len(steps), '%.1f' % duration,
                     ENDS.get(result.code, str(result.code)), self.truth.summary.contact or '-',
                     '%s | %s' % (result.reason or '-', told)), flush=True)

    def check(self, drawn, task, result):
        story = lambda: self.story(task, result)  # noqa: E731
        self.assertIn(result.code, ENDS, story())
        self.assertTrue(result.code == 0 or result.reason, story())
        if self.SETTINGS and drawn.can_be_done():
            self.assertEqual(result.code, self.codes.SUCCEEDED, story())
        false = [claim for claim, verdict in self.claims.verdicts if verdict == FALSE]
        self.assertEqual(false, [], story())
        if result.code == self.codes.SUCCEEDED:
            self.check_goal(drawn, story)
        self.check_belief(drawn, task, story)

    def check_goal(self, drawn, story):
        truth = Snapshot(self.truth)
        there = {name for name in drawn.objects
                 if truth.stands_on(name, drawn.goal_areas, 0.02)}
        self.assertTrue(drawn.is_done(there), '%s\n%s' % (sorted(there), story()))

    def check_belief(self, drawn, task, story):
        """What it decided by is so. What it had no need to look for may be gone all the same, and who
        sees by pictures cannot know how things are called that nobody told it of."""
        not_needed = drawn.missing if task.result().code == self.codes.SUCCEEDED else set()

        def differences():
            truth = Snapshot(self.truth)
            atoms = [('on', [link_of(f, 'hasPhysicalEntity'), link_of(f, 'hasArea')])
                     for f in self.loop.fluents('On', now=True)]
            atoms += [('holding', [link_of(f, 'hasArm'), link_of(f, 'hasPassiveObject')])
                      for f in self.loop.fluents('Holding', now=True)]
            return [atom for atom in atoms
                    if truth.holds(*atom) is False and not not_needed & set(atom[1]) and
                    (not self.SETTINGS or set(drawn.objects) & set(atom[1]))]
        try:
            wait_until(lambda: not differences(), 'belief to agree with truth', 5.0)
        except AssertionError:
            self.fail('%s\n%s' % (differences(), story()))

    def test_tasks_at_random_end_as_they_say(self):
        count, first = numbers_given()
        for seed in range(first, first + count):
            with self.subTest(seed=seed, task=RandomTask(seed).task):
                self.run_task(seed)


if __name__ == '__main__':
    run_test('loop_random_tasks', LoopRandomTasksTest)
