#!/usr/bin/env python3
"""Whatever goes wrong in a rostest is told, in its output and in its result file."""

import os
import subprocess
import sys
import tempfile
import unittest

from rosunit import junitxml

SUPPORT = os.path.join(os.path.dirname(os.path.abspath(__file__)), 'support')

HEAD = """
import sys
import unittest
sys.path.insert(0, %r)
from test_run import run_test


class SomeTest(unittest.TestCase):
""" % SUPPORT

PARTS = HEAD + """
    def test_parts(self):
        with self.subTest('stays.dry'):
            self.assertEqual('wet', 'dry')
        with self.subTest(torso=0.3):
            raise ValueError('no such height')
        with self.subTest('goes well'):
            pass

    def test_two_things(self):
        self.addCleanup(self.fail, 'left over')
        self.fail('broken')

    def test_that_goes_well(self):
        with self.subTest('goes well too'):
            pass


run_test('some', SomeTest)
"""

NO_BEGINNING = HEAD + """
    @classmethod
    def setUpClass(cls):
        raise OSError('no robot')

    def test_something(self):
        pass


run_test('some', SomeTest)
"""

LONG = HEAD.replace('import run_test', 'import long_case, run_test') + """
    def test_something(self):
        pass

    @long_case
    def test_something_that_takes_long(self):
        self.fail('it was played')


run_test('some', SomeTest)
"""

ALL_WELL = HEAD + """
    def test_something(self):
        print('told on the way')


run_test('some', SomeTest)
"""


class TestRunTest(unittest.TestCase):
    def run_cases(self, program, **environment):
        """(exit code, what it printed, {name: [texts of failures and errors]} of its file)"""
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'result.xml')
            run = subprocess.run(
                [sys.executable, '-B', '-c', program, '--gtest_output=xml:' + path],
                env={**{k: v for k, v in os.environ.items() if k != 'HIRES_LONG_TESTS'}, **environment},
                stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
            self.result = junitxml.read(path, 'some')
        told = {}
        for case in self.result.test_case_results:
            told.setdefault(case.name.split('/', 1)[1], []).extend(
                problem.text for problem in case.failures + case.errors)
        return run.returncode, run.stdout, told

    def test_a_part_that_fails_names_itself(self):
        code, output, told = self.run_cases(PARTS)
        self.assertEqual(code, 1)
        self.assertIn("'wet' != 'dry'", told['test_parts [stays.dry]'][0])
        self.assertIn('no such height', told['test_parts (torso=0.3)'][0])
        self.assertIn('in test_parts', told['test_parts [stays.dry]'][0])  # the place
        for words in ('test_parts [stays.dry]', "'wet' != 'dry'", 'test_parts (torso=0.3)',
                      'no such height'):
            self.assertIn(words, output)

    def test_each_of_several_failures_of_a_test_is_told(self):
        _, output, told = self.run_cases(PARTS)
        self.assertEqual([text.splitlines()[0] for text in told['test_two_things']],
                         ['broken', 'left over'])
        self.assertIn('left over', output)

    def test_what_is_counted_is_what_is_told(self):
        _, _, told = self.run_cases(PARTS)
        self.assertEqual((self.result.num_failures, self.result.num_errors), (3, 1))
        self.assertEqual(sum(len(texts) for texts in told.values()), 4)
        self.assertEqual(told['test_that_goes_well'], [])
        self.assertEqual(self.result.num_tests, 3)

    def test_a_class_that_cannot_begin_says_why(self):
        code, output, told = self.run_cases(NO_BEGINNING)
        self.assertEqual(code, 1)
        self.assertIn('no robot', output)
        self.assertIn('no robot', told['setUpClass (__main__.SomeTest)'][0])

    def test_a_test_that_passes_says_so(self):
        code, output, told = self.run_cases(ALL_WELL)
        self.assertEqual((code, told), (0, {'test_something': []}))
        self.assertIn('SUCCESS', output)
        self.assertIn('told on the way', self.result.system_out)

    def test_a_long_case_is_played_in_a_long_run_alone(self):
        code, output, told = self.run_cases(LONG)
        self.assertEqual((code, told), (0, {'test_something': []}))
        self.assertIn('1 of 2 cases are left to scripts/test --long', output)
        code, output, told = self.run_cases(LONG, HIRES_LONG_TESTS='ON')
        self.assertEqual(code, 1)
        self.assertIn('it was played', told['test_something_that_takes_long'][0])


if __name__ == '__main__':
    unittest.main()
