"""What cmake/HiresTests.cmake reads out of test files, and what it refuses."""

import os
import subprocess
import tempfile
import unittest

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), "..", ".."))
PROJECT = """cmake_minimum_required(VERSION 3.16)
project(sample LANGUAGES NONE)
include("%s/cmake/HiresTests.cmake")
foreach(name IN ITEMS %s)
  hires_test_suites(sample_test ${CMAKE_CURRENT_SOURCE_DIR}/${name}_test.cpp filter)
  message(STATUS "${name}: ${filter}")
endforeach()
"""


def configure(files):
    """How CMake ends, and what it says, for test files {name: text}."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            with open(os.path.join(folder, f"{name}_test.cpp"), "w", encoding="utf-8") as file:
                file.write(text)
        with open(os.path.join(folder, "CMakeLists.txt"), "w", encoding="utf-8") as file:
            file.write(PROJECT % (ROOT, " ".join(files)))
        done = subprocess.run(["cmake", "-S", folder, "-B", os.path.join(folder, "build")],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        return done.returncode, " ".join(done.stdout.split())


class TestProgramsTest(unittest.TestCase):
    def test_every_kind_of_suite_is_in_the_filter(self):
        text = ("TEST(PlainTest, A) {}\nTEST_F(FixtureTest, B) {}\nTEST_P(\n    ParamTest, C) {}\n"
                "TYPED_TEST(TypedTest, D) {}\nHIRES_PROPERTY(PropertyTest, E, (int i)) {}\n"
                "TEST(PlainTest, F) {}\nif (x) { y[0]; }\n")
        code, output = configure({"a": text})
        self.assertEqual(code, 0, output)
        for suite in ("PlainTest", "FixtureTest", "ParamTest", "TypedTest", "PropertyTest"):
            for pattern in (f"{suite}.*", f"*/{suite}.*", f"{suite}/*"):
                self.assertEqual(output.count(f":{pattern}:") + output.count(f" {pattern}:"), 1,
                                 f"{pattern} in {output}")

    def test_a_suite_of_two_files_is_refused(self):
        code, output = configure({"a": "TEST(SameTest, A) {}\n", "b": "TEST(SameTest, B) {}\n"})
        self.assertNotEqual(code, 0)
        self.assertRegex(output, "b_test.cpp: suite SameTest stands in .*a_test.cpp too")

    def test_a_file_without_a_test_is_refused(self):
        code, output = configure({"a": "int main() {}\n"})
        self.assertNotEqual(code, 0)
        self.assertRegex(output, "a_test.cpp: defines no test")

    def test_a_property_that_shares_its_settings_is_refused(self):
        code, output = configure({"a": "RC_GTEST_PROP(ATest, B, ()) {}\n"})
        self.assertNotEqual(code, 0)
        self.assertRegex(output, "a_test.cpp: .*use HIRES_PROPERTY")


if __name__ == "__main__":
    unittest.main()
