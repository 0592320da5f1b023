#!/usr/bin/env python3
"""What the examples in Python say to those who call them wrongly: examples_test.py"""

import os
import subprocess
import sys
import unittest

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..'))
CALL = ('urdf/cart.urdf', 'vase1', 'worlds/workshop.world', 'dock', 'atBench')


def run(name, *arguments):
    return subprocess.run([sys.executable, '-B', os.path.join('examples', name), *arguments], cwd=ROOT,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)


class BestSpeedTest(unittest.TestCase):
    def expect_refused(self, arguments, *words):
        told = run('best_speed.py', *arguments)
        self.assertEqual((told.returncode, told.stdout), (1, ''))
        self.assertNotIn('Traceback', told.stderr)
        for word in words:
            self.assertIn(word, told.stderr)

    def test_who_gives_too_few_or_too_many_arguments_is_told_which_are_wanted(self):
        for arguments in ((), CALL[:4], (*CALL, 'more')):
            self.expect_refused(arguments, 'usage: best_speed.py ROBOT OBJECT WORLD FROM TO',
                                ' '.join(CALL))

    def test_a_wrong_area_is_a_sentence(self):
        self.expect_refused((*CALL[:4], 'atBnch'), "best_speed.py: ", "'atbench'")
        self.expect_refused((*CALL[:3], 'dok', 'atBench'), "best_speed.py: ", "'dock'")


if __name__ == '__main__':
    unittest.main()
