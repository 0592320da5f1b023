"""How a rostest runs its cases: as rosunit does, and with each thing that went wrong told in the
output and in the result file.

    run_test('my_node', MyNodeTest)

    class MyNodeTest(unittest.TestCase):
        @long_case
        def test_what_takes_long_and_seldom_breaks(self): ...  # only in scripts/test --long

rosunit alone counts what fails within `with self.subTest(...)` or in setUpClass and does not say what
it was; of several failures of one test it keeps the last.
"""

import os
import sys
import unittest

from rosunit import print_unittest_summary, xmlrunner
from rosunit.core import XML_OUTPUT_FLAG, create_xml_runner


class _Result(xmlrunner._XMLTestResult):
    """Keeps one entry for each failure and error, in the order in which they came."""

    def startTest(self, test):
        super().startTest(test)
        self._num_before = len(self.failures) + len(self.errors)

    def stopTest(self, test):
        if len(self.failures) + len(self.errors) == self._num_before:
            super().stopTest(test)  # keeps an entry for the success
        else:
            unittest.TestResult.stopTest(self, test)

    def addFailure(self, test, err):
        super().addFailure(test, err)
        self._failure = None  # told here, not once more by stopTest
        self._keep(test, failure=err)

    def addError(self, test, err):
        super().addError(test, err)
        self._error = None
        self._keep(test, error=err)

    def addSubTest(self, test, subtest, err):
        super().addSubTest(test, subtest, err)  # counts it
        if err is not None:
            kind = 'failure' if issubclass(err[0], test.failureException) else 'error'
            self._keep(subtest, **{kind: err})

    def _keep(self, test, failure=None, error=None):
        """@param test  a test case, a part of one, or what stands for setUpClass."""
        case = getattr(test, 'test_case', test)
        info = xmlrunner._TestInfo(case, self._elapsed())
        if isinstance(case, unittest.TestCase):
            info._method = test.id()[len(info._class) + 1:]
        else:
            info._class, info._method = self._test_name, test.id()
        info._failure, info._error = failure, error
        self._tests.append(info)

    def _elapsed(self):
        """[s] since the test began; setUpClass belongs to none."""
        return xmlrunner.time.time() - self._start_time if self._start_time else 0.0


def long_case(test):
    """Marks a case that plays only with HIRES_LONG_TESTS in the environment, as scripts/test --long has it."""
    test.is_long = True
    return test


def cases_of(case):
    """The suite of a class, without its long cases where only short ones are wanted."""
    loader = unittest.TestLoader()
    names = loader.getTestCaseNames(case)
    if not os.environ.get('HIRES_LONG_TESTS'):
        short = [name for name in names if not getattr(getattr(case, name), 'is_long', False)]
        if len(short) < len(names):
            print('%d of %d cases are left to scripts/test --long' % (len(names) - len(short), len(names)))
        names = short
    return loader.suiteClass(map(case, names))


def run_test(name, case):
    """Ends the program with 1 if a test of this class fails.
    @param name  in lists of results."""
    suite = cases_of(case)
    if '--text' in sys.argv:
        result = unittest.TextTestRunner(verbosity=2).run(suite)
    else:
        paths = [a[len(XML_OUTPUT_FLAG):] for a in sys.argv if a.startswith(XML_OUTPUT_FLAG)]
        xmlrunner._XMLTestResult = _Result  # the runner makes its own, and takes no other
        result = create_xml_runner('hires', name, paths[0] if paths else None).run(suite)
    print_unittest_summary(result)
    if not result.wasSuccessful():
        sys.exit(1)
