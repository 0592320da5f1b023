#!/usr/bin/env python3
"""What a PR2 may do to us in the middle of a drive, and how its base then stops: measured from
where the fake PR2's base really is. Run by `rostest hires pr2_safety.test`."""

import math
import os
import signal
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from lab import Lab, wait_for  # noqa: E402
from failures import text_of  # noqa: E402
from ros_processes import wait_until  # noqa: E402
from test_run import run_test  # noqa: E402

FAST = 0.4          # [m/s] a drive is well under way
STILL = 0.005       # [m/s]
# The base controller's own limit, with what one sample of 0.01 s blurs. Braking harder than this is
# the base controller's time-out or its motors, not the guard.
CONTROLLER = 2.0    # [m/s^2]
AREAS = ('preManipulationAreaEastCounter1', 'preManipulationAreaEastTable2')


def decelerations(samples):
    """[m/s^2] over 0.05 s, so that the guard's steps of 0.02 s count as the ramp that they are."""
    span = 5
    return [(a[4] - b[4]) / (b[0] - a[0]) for a, b in zip(samples, samples[span:])]


class Pr2SafetyTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.lab = Lab()
        cls.addClassCleanup(cls.lab.stop)
        cls.lab.start()
        cls.lab.connect('pr2_safety')
        cls.codes = cls.lab.codes
        cls.turn = 0
        cls.states = cls.lab.msg.BaseGuardState

    def drive(self):
        """A drive that is fast by now: its goal and the number of the sample. Where it stood
        already there is none; and on a computer so busy that the middle layer is late by 0.1 s
        the guard has stopped it, as it should: neither is what is looked at here."""
        for _ in range(2 * len(AREAS)):
            type(self).turn += 1
            goal = self.lab.execute('move_base', AREAS[self.turn % 2])
            self.addCleanup(self.end, goal)
            index = self.lab.truth.wait_for(lambda s: s[4] > FAST or goal.is_done(),
                                            'the base to be fast')
            if not goal.is_done():
                return goal, index
            result = goal.result()
            is_stopped = text_of(result.failure).startswith('silent_')
            self.assertTrue(result.code == self.codes.SUCCEEDED or is_stopped,
                            '%s\n%s' % (result, self.lab.output()[-3000:]))
        raise AssertionError('no drive gets fast:\n' + self.lab.output()[-3000:])

    def end(self, goal):
        """Unless the server died with it."""
        goal.abandon()

    def state(self):
        return self.lab.guard_states[-1] if self.lab.guard_states else None

    def require_gentle_stop(self, index, limit):
        """From sample `index` on the base comes to a stand, and since the guard stops it it never
        brakes harder than `limit`: before that whoever drove may have. @return [s] until it stood,
        [m] that it went, hardest braking."""
        last = self.lab.truth.wait_for(lambda s: abs(s[4]) < STILL and abs(s[5]) < STILL,
                                       'the base to stand')
        wait_until(lambda: self.state().state == self.states.STANDING, 'the guard to stand')
        braking = [s for s in self.lab.guard_states if s.state == self.states.BRAKING][-1]
        samples = [s for s in self.lab.truth.since(index)[:last - index + 1]
                   if s[0] >= braking.header.stamp.to_sec()]
        hardest = max(decelerations(samples), default=0.0)
        way = sum(math.hypot(b[1] - a[1], b[2] - a[2]) for a, b in zip(samples, samples[1:]))
        print('stop: from %.2f m/s in %.2f s, %.2f m, hardest %.2f m/s^2 of %.2f' % (
            samples[0][4], samples[-1][0] - samples[0][0], way, hardest, limit))
        self.assertLess(hardest, limit)
        return samples[-1][0] - samples[0][0], way, hardest

    def allowed(self):
        """[m/s^2] what the load allows, as the last request said, with what 0.05 s blur."""
        return 1.15 * self.lab.requests[-1].max_braking

    def require_reason(self, goal, reason):
        """The middle layer may have noticed itself, in its own words, before the guard told it."""
        result = goal.result()
        self.assertEqual(result.code, self.codes.FAILED, result)
        self.assertIn(text_of(result.failure).split(':')[0], (reason, 'stale_observation'))
        wait_until(lambda: self.state().state == self.states.STANDING, 'the guard to stand')
        self.assertIn(reason, text_of(self.state().failure))

    def require_stand(self):
        """Nothing moves by itself once all is well again."""
        index = len(self.lab.truth.samples)
        self.lab.truth.wait_for_time(self.lab.truth.samples[-1][0] + 1.0)
        self.assertTrue(all(abs(s[4]) < STILL for s in self.lab.truth.since(index)))

    def require_new_drive(self):
        """A new request is followed."""
        goal, _ = self.drive()
        goal.cancel()
        self.assertEqual(goal.result().code, self.codes.PREEMPTED)
        self.lab.truth.wait_for(lambda s: abs(s[4]) < STILL, 'the base to stand')

    def require_safe(self, service, reason, limit=None):
        goal, index = self.drive()
        allowed = limit or self.allowed()
        self.lab.set(service, True)
        try:
            self.require_gentle_stop(index, allowed)
            self.require_reason(goal, reason)
            self.require_stand()
        finally:
            self.lab.set(service, False)
        self.require_stand()
        self.require_new_drive()

    def test_a_scan_that_stays_away(self):
        self.require_safe('freeze_scan', 'stale_scan')

    def test_a_localisation_that_stays_away(self):
        self.require_safe('freeze_localisation', 'stale_pose')

    def test_a_localisation_that_is_lost(self):
        self.require_safe('lose_localisation', 'localisation_lost')

    def test_motors_that_are_halted(self):
        """Gears and tyres stop it then; the guard only sees to it that it stays where it is."""
        self.require_safe('halt_motors', 'motors_halted', limit=6.0)

    def test_a_middle_layer_that_is_killed(self):
        _, index = self.drive()
        allowed = self.allowed()
        pid = self.lab.pid_of('middle_layer')
        os.kill(pid, signal.SIGKILL)
        self.require_gentle_stop(index, allowed)
        wait_until(lambda: self.state().state == self.states.STANDING, 'the guard to stand')
        self.assertIn('silent', text_of(self.state().failure))
        self.require_stand()
        wait_for(lambda: self.lab.pid_of('middle_layer') not in (None, pid),
                 'it to be started again')
        self.lab.wait_for_news(self.lab.actions)
        self.require_new_drive()

    def test_the_joystick_takes_over_and_gives_back(self):
        goal, _ = self.drive()
        back = self.lab.twist()
        back.linear.x = -0.2
        begin = self.lab.truth.samples[-1][0]
        while self.lab.truth.samples[-1][0] < begin + 2.0:
            self.lab.joystick.publish(back)
            self.lab.truth.wait_for_time(self.lab.truth.samples[-1][0] + 0.05)
        self.assertAlmostEqual(self.lab.truth.samples[-1][4], -0.2, places=2)
        result = goal.result()
        self.assertIn(result.code, (self.codes.SUCCEEDED, self.codes.FAILED))
        print('joystick: code %d, reason "%s"' % (result.code, text_of(result.failure)))
        if result.code == self.codes.FAILED:
            self.assertNotEqual(text_of(result.failure), '')
        self.lab.truth.wait_for(lambda s: abs(s[4]) < STILL, 'the base to stand')

    def test_it_is_never_faster_than_its_motion_set(self):
        goal, index = self.drive()
        self.assertEqual(goal.result().code, self.codes.SUCCEEDED, self.lab.output()[-2000:])
        fastest = max(s[4] for s in self.lab.truth.since(index))
        self.assertLessEqual(fastest, self.lab.requests[-2].max_linear_velocity + 1e-6)


if __name__ == '__main__':
    run_test('pr2_safety', Pr2SafetyTest)
