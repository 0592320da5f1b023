"""The list of faults fits the code, and lab/scripts/faults plays it: on a tree of one file, whose tests look for
words in it, so that nothing is compiled."""

import importlib.machinery
import importlib.util
import json
import os
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..'))
SCRIPT = os.path.join(ROOT, 'lab', 'scripts', 'faults')

SOURCE = 'return a + b;\nreturn a < b;\nreturn;\n'
LIST = """# sums
sum
  file  src/base/sum.cpp
  was   a + b
  is    a - b
  what  the sign is wrong
  tests ^base\\.

order
  file  src/base/sum.cpp
  was   a < b
  is    a <= b
  what  an equal one counts as less
  tests ^base\\.
"""
PROJECT = """cmake_minimum_required(VERSION 3.16)
project(sample LANGUAGES NONE)
enable_testing()
add_custom_target(hires_base_test)
add_test(NAME base.sum COMMAND grep -q "a [+] b" ${PROJECT_SOURCE_DIR}/src/base/sum.cpp)
add_test(NAME base.end COMMAND grep -q "return;" ${PROJECT_SOURCE_DIR}/src/base/sum.cpp)
"""


def load_script():
    loader = importlib.machinery.SourceFileLoader('faults', SCRIPT)
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader('faults', loader))
    sys.modules['faults'] = module  # its data classes look there
    loader.exec_module(module)
    return module


class FaultsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.tree, self.build = (os.path.join(folder.name, name) for name in ('tree', 'build'))
        self.write('src/base/sum.cpp', SOURCE)
        self.write('lab/config/faults.txt', LIST)
        self.write('CMakeLists.txt', PROJECT)

    def write(self, name, text):
        path = os.path.join(self.tree, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, 'w', encoding='utf-8') as file:
            file.write(text)

    def run_script(self, *arguments):
        return subprocess.run([sys.executable, '-B', SCRIPT, '--source', self.tree, '--build', self.build,
                               *arguments], capture_output=True, text=True, stdin=subprocess.DEVNULL, check=False)

    def read(self, *path):
        with open(os.path.join(*path), encoding='utf-8') as file:
            return file.read()

    def caught_by(self):
        return {row['fault']: row['caught_by'] for row in json.loads(self.read(self.build, 'faults.json'))['faults']}

    def test_each_fault_of_the_list_fits_its_file(self):
        faults = load_script()
        known = faults.read_faults(os.path.join(ROOT, 'lab', 'config', 'faults.txt'))
        self.assertEqual(list(faults.misfits(ROOT, known)), [])
        self.assertGreaterEqual(len(known), 24)

    def test_all_that_do_not_fit_are_named_at_once(self):
        self.write('src/base/sum.cpp', 'return b + a;\na < b; a < b;\n')
        answer = self.run_script('--check')
        self.assertEqual(answer.returncode, 1)
        self.assertIn('sum: stands 0 times in src/base/sum.cpp, wanted once: a + b', answer.stderr)
        self.assertIn('order: stands 2 times in src/base/sum.cpp, wanted once: a < b', answer.stderr)

    def test_a_list_that_lacks_something_is_refused(self):
        self.write('lab/config/faults.txt', LIST.replace('  what  the sign is wrong\n', '') + 'and so on\n' + LIST)
        answer = self.run_script('--list')
        self.assertEqual(answer.returncode, 1)
        for words in ('sum: lacks what', 'faults.txt:14: is neither', 'order: stands twice'):
            self.assertIn(words, answer.stderr)

    def test_what_is_caught_and_what_is_missed(self):
        answer = self.run_script('--require', '1')
        self.assertEqual(answer.returncode, 0, answer.stdout + answer.stderr)
        self.assertEqual(self.caught_by(), {'sum': 'base.sum', 'order': None})
        self.assertIn('1 of 2 caught, 1 missed, 0 not played', answer.stdout)
        self.assertEqual(self.read(self.tree, 'src/base/sum.cpp'), SOURCE)
        self.assertEqual(self.read(self.build, 'source', 'src/base/sum.cpp'), SOURCE)
        self.assertEqual(self.run_script('--require', '2').returncode, 2)

    def test_only_what_a_change_may_have_changed_is_played_again(self):
        self.assertIn('1/1 sum', self.run_script('--only', 'sum').stdout)
        self.assertIn('1/1 order', self.run_script().stdout)
        self.assertNotIn('1/1', self.run_script().stdout)
        self.write('CMakeLists.txt', PROJECT.replace('return;', 'a < b'))
        answer = self.run_script('--require', '2')
        self.assertEqual(answer.returncode, 0, answer.stdout + answer.stderr)
        self.assertIn('1/1 order: caught by base.end', answer.stdout)
        self.assertIn('1 were played in an earlier state of the code', answer.stdout)
        self.assertIn('2/2', self.run_script('--again').stdout)

    def test_tests_that_fail_without_a_fault_are_named(self):
        self.write('CMakeLists.txt', PROJECT.replace('return;', 'no such line'))
        answer = self.run_script()
        self.assertEqual(answer.returncode, 1)
        self.assertIn('tests fail without a fault: base.end', answer.stderr)

    def test_what_cannot_be_built_or_has_no_test_is_an_error(self):
        self.write('CMakeLists.txt', PROJECT.replace(
            'hires_base_test)', 'hires_base_test COMMAND grep -q "a < b" ${PROJECT_SOURCE_DIR}/src/base/sum.cpp VERBATIM)'))
        self.write('lab/config/faults.txt', LIST + 'odd\n  file src/base/sum.cpp\n  was return;\n  is\n'
                                                   '  what nothing\n  tests ^odd\\.\n')
        answer = self.run_script()
        self.assertEqual(answer.returncode, 1)
        self.assertIn('order: does not compile', answer.stderr)
        self.assertIn('odd: no test is called ^odd\\.', answer.stderr)
        self.assertEqual(self.caught_by(), {'sum': 'base.sum', 'order': None, 'odd': None})
        self.assertIn('1 of 3 caught, 0 missed, 2 not played', answer.stdout)

    def test_a_folder_with_something_else_is_left_alone(self):
        os.makedirs(os.path.join(self.build, 'source', 'mine'))
        answer = self.run_script()
        self.assertNotEqual(answer.returncode, 0)
        self.assertIn('is no copy of this script', answer.stderr)

    def test_what_ctest_says_is_understood(self):
        faults = load_script()
        text = (' 1/3 Test #5: base.text ......   Passed    0.02 sec\n'
                '[  FAILED  ] RngTest.Forks, where GetParam() = 3\n'
                ' 2/3 Test #6: base.rng ...................***Failed    0.02 sec\n')
        self.assertEqual(faults.first_failure(text), 'base.rng RngTest.Forks')
        self.assertEqual(faults.first_failure(text.splitlines()[0]), None)
        late = ' 12/30 Test #106: loop.task_loop ........***Timeout 300.04 sec\n'
        self.assertEqual(faults.first_failure(late), 'loop.task_loop (timeout)')
        crash = '1/1 Test #7: base.log .........***Exception: SegFault  0.10 sec\n'
        self.assertEqual(faults.first_failure(crash), 'base.log (exception)')
        self.assertEqual(faults.first_failure('1/1 Test #7: base.log ....***Skipped  0.10 sec\n'), None)


if __name__ == '__main__':
    unittest.main()
