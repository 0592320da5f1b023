#!/usr/bin/env python3
"""The exported headers' pages build without a warning; see docs/Doxyfile."""

import os
import subprocess
import tempfile
import unittest

ROOT = os.path.abspath(os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..'))


def warnings_of(source, folder):
    """Lines that doxygen complains about in the folder `source`."""
    with open(os.path.join(ROOT, 'docs', 'Doxyfile')) as file:
        settings = file.read() + ('\nINPUT = %s\nOUTPUT_DIRECTORY = %s\nGENERATE_HTML = NO\n'
                                  'GENERATE_PERLMOD = YES\n' % (source, folder))  # the quickest
    done = subprocess.run(['doxygen', '-'], input=settings, text=True, capture_output=True, cwd=ROOT,
                          check=True)
    return sorted(set(done.stderr.splitlines()))


class DoxygenTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def test_headers_are_free_of_warnings(self):
        self.assertEqual(warnings_of('include/hires', self.folder), [])
        with open(os.path.join(self.folder, 'perlmod', 'DoxyDocs.pm')) as file:
            self.assertIn("name => 'hires::imagination::Evidence'", file.read())

    def test_a_bad_header_is_found(self):
        with open(os.path.join(self.folder, 'bad.h'), 'w') as file:
            file.write('/// Kept in /proc/<pid>.\n/// @param lenght  of it\nvoid Keep(int length);\n')
        text = '\n'.join(warnings_of(self.folder, self.folder))
        self.assertIn('<pid>', text)
        self.assertIn("'lenght'", text)


if __name__ == '__main__':
    unittest.main()
