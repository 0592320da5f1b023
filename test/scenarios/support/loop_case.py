"""What the tests of the closed loop share: a system of their own, tasks, and words for what must be
so."""

import math
import os
import sys
import unittest

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)

from closed_loop import RESTAURANT, ClosedLoop, link_of, scenario_of  # noqa: E402
from ros_processes import wait_until  # noqa: E402

# Before the counter, about to approach it: the way from there is short.
AT_COUNTER = {'pose': [6.8, 10.1, 3.14], 'torso': 'torsoupposture',
              'arms': {'leftarm1': 'armtuckedposture', 'rightarm1': 'armtosideposture'}}
ON_FLOOR = {'pose': [12.5, 9.8, 2.0], 'torso': 'torsodownposture',
            'arms': {'leftarm1': 'armuntuckedposture', 'rightarm1': 'armuntuckedposture'}}
MUG = {'mug1': (5.37, 10.26, 0.75, 0.0)}
BOTH = {'mug1': (5.37, 10.26, 0.75, 0.0), 'mug2': (5.37, 9.94, 0.75, 0.0)}

COUNTER = 'placingareaeastrightcounter1'
TABLE_TOP, COUNTER_TOP = 0.73, 0.75  # [m]
STILL = 0.01   # [m/s], [rad/s] of the base, counts as standing
JOINT_STILL = 0.02  # [m/s], [rad/s] likewise


def names(call):
    """An ActionCall as people write it."""
    return '%s(%s)' % (call.name, ', '.join(call.arguments))


class LoopCase(unittest.TestCase):
    SETTINGS = {}  # of the ClosedLoop

    @classmethod
    def setUpClass(cls):
        cls.loop = ClosedLoop(**cls.SETTINGS)
        cls.addClassCleanup(cls.loop.destroy)
        cls.loop.connect(cls.__name__.lower() + '_driver')
        cls.codes = cls.loop.msg.AchieveResult
        cls.phases = cls.loop.msg.StepStatus

    def begin(self, robot, objects, hidden=(), knowledge=(RESTAURANT,), temperatures=(), **monitor):
        """The whole system in this situation, once the Blackboard has seen it.
        @param monitor  as of ClosedLoop.start."""
        self.loop.start(scenario_of(robot, objects, hidden, temperatures), knowledge, **monitor)
        self.truth = self.loop.truth
        self.truth.wait(lambda truth: True, 'the simulated robot\n' + self.loop.output())
        self.wait_for_belief(robot)

    def wait_for_belief(self, robot):
        """Until observation has put the robot's true postures on the Blackboard."""
        wanted = {'torso1': robot['torso'], **robot['arms']}

        def is_seen():
            believed = {}
            for fluent in self.loop.fluents('TorsoPosture', now=True):
                believed[link_of(fluent, 'hasTorso')] = fluent.concept_name.lower()
            for fluent in self.loop.fluents('ArmPosture', now=True):
                believed[link_of(fluent, 'hasArm')] = fluent.concept_name.lower()
            return believed == wanted
        wait_until(is_seen, 'the robot to be observed\n' + self.loop.output())

    def achieve(self, task, **fields):
        task = self.loop.achieve(task, **fields)
        self.addCleanup(task.give_up)
        return task

    def require(self, task, code, *words):
        """The result, which must be this."""
        result = task.result()
        self.assertEqual(result.code, code, '%s\n%s' % (result.reason, self.story(task, result)))
        for word in words:
            self.assertIn(word, result.reason)
        return result

    def story(self, task, result):
        outcome = 'code=%d %s' % (result.code, result.reason)
        steps = [outcome] + ['%d.%d %s phase=%d %s' % (
            s.plan, s.index, names(s.action), s.phase, s.note) for s in result.steps]
        truth = self.truth.summary, self.truth.world.objects, self.truth.robot[-1].pose
        return '\n'.join(steps + task.warnings() + [self.loop.output()] + [str(t) for t in truth])

    def was_warned(self, task, *words):
        """Whether a warning with all these words has come."""
        return any(all(word in text for word in words) for text in task.warnings())

    def warned(self, task, *words):
        """There was a warning with all these words."""
        self.assertTrue(self.was_warned(task, *words),
                        'no warning with %s among %s' % (words, task.warnings()))

    def wait_for_step(self, task, name, phase=None):
        """Until a step of this name is under way."""
        phase = self.phases.RUNNING if phase is None else phase
        has_come = task.sees(
            lambda f: any(s.action.name == name and s.phase == phase for s in f.steps), name)
        if not has_come:
            self.fail('%s never came:\n%s' % (name, self.story(task, task.result())))

    def wait_for_imagination(self, task):
        """Until an imagination is asked for and not answered."""
        self.assertTrue(
            task.sees(lambda f: any(not i.outcome for i in f.imaginations), 'imagination'),
            'nothing was imagined')

    def steps_of(self, result, name):
        """Those of this name that were begun."""
        return [s for s in result.steps if s.action.name == name and s.started == s.started]

    # What is really so.

    def assert_stands_upright(self, name, top):
        """Within two degrees, with its underside on a top of this height [m]."""
        self.assertLess(self.truth.tilt(name), 0.035, name)
        self.assertAlmostEqual(self.truth.position(name)[2], top, delta=0.01, msg=name)

    def assert_on_table1(self, name):
        self.assert_stands_upright(name, TABLE_TOP)
        x, y, _ = self.truth.position(name)
        self.assertLess(max(abs(x - 7.73), abs(y - 11.49)), 0.35, (x, y))

    def assert_on_counter(self, name):
        self.assert_stands_upright(name, COUNTER_TOP)
        x, y, _ = self.truth.position(name)
        self.assertLess(math.hypot(x - 5.3, y - 10.07), 0.8, (x, y))

    def wait_until_it_stands(self):
        """Base and arms at rest, in truth."""
        self.truth.wait(lambda t: t.speed() < STILL and
                        max(t.joint_speeds().values(), default=1.0) < JOINT_STILL,
                        'the robot to stand')
