"""scripts/check_limits against the program itself. Usage: check_limits_test.py HIRES"""

import json
import os
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '../..'))
PROGRAM = sys.argv.pop()
PAIR = 'pr2:race_peppermill'
FEW = ('--pairs', PAIR, '--max-fall', '0.2', '--rollouts', '60', '--seed', '7')


def check(folder, *words):
    return subprocess.run([ROOT + '/scripts/check_limits', folder, *words, '--hires', PROGRAM],
                          capture_output=True, text=True, check=False)


class CheckLimitsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.path = f'{cls.folder.name}/pr2_race_peppermill.json'
        cls.printed = check(cls.folder.name, *FEW)

    def answer(self):
        with open(self.path, encoding='utf-8') as file:
            return json.load(file)

    def test_new_rollouts_keep_to_limits_and_fail_more_often_above_them(self):
        self.assertEqual(self.printed.returncode, 0, self.printed.stderr)
        self.assertIn('| pr2_tray | race_peppermill | speed | 0.33 m/s | ', self.printed.stdout)
        limits = [limit for limit in self.answer()['limits'] if 'check_falls_above' in limit]
        self.assertGreater(sum(limit['check_falls_above'] for limit in limits),
                           2 * sum(limit['check_falls'] for limit in limits))

    def test_a_limit_at_which_too_many_fail_is_named(self):
        answer = self.answer()
        answer['limits'][0]['check_falls'] = 45  # of 60, where 20 % may
        with tempfile.TemporaryDirectory() as folder:
            with open(f'{folder}/pr2_race_peppermill.json', 'w', encoding='utf-8') as file:
                json.dump(answer, file)
            refused = check(folder, *FEW)
        self.assertEqual(refused.returncode, 1)
        self.assertIn('race_peppermill: speed: 45 of 60 fail, at most 20 % may', refused.stderr)

    def in_mujoco(self, falls):
        """What is printed where so many of 60 fail in MuJoCo at each limit."""
        answer = self.answer()
        for limit in answer['limits']:
            limit['mujoco_falls'] = falls
        with tempfile.TemporaryDirectory() as folder:
            program = f'{folder}/program'
            with open(program, 'w', encoding='utf-8') as file:
                file.write('#!/bin/sh\n[ "$2 $3 $4" = "race_peppermill 60 7" ] && cat > "$6" << END\n'
                           f'{json.dumps(answer)}\nEND\n')
            os.chmod(program, 0o755)
            return check(folder, *FEW, '--mujoco', program)

    def test_falls_in_mujoco_are_pooled_over_all_limits(self):
        kept = self.in_mujoco(8)
        self.assertEqual(kept.returncode, 0, kept.stderr)
        self.assertIn('MuJoCo: 40 of 300 fail at the limits, at most 17.00 % (95 % confidence)', kept.stdout)
        refused = self.in_mujoco(11)
        self.assertEqual(refused.returncode, 1)
        self.assertIn('MuJoCo: 55 of 300 fail', refused.stderr)


if __name__ == '__main__':
    unittest.main()
