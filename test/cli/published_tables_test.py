"""Which results of `hires experiment FILE` that docs/ and README print are those of today's parameters."""

import glob
import os
import re
import subprocess
import sys
import unittest

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..'))
DATA = os.path.join(ROOT, '..', 'shared', 'data')
# The first line of a printed report, a row of a table of reports, and a hash in a sentence that names the file.
PATTERNS = (re.compile(r'^(?P<name>\w+) \(\w+\), seed (?P<seed>\d+), parameters (?P<hash>[0-9a-f]{16}), experiment'),
            re.compile(r'^\| `(?P<name>\w+)` \| (?P<hash>[0-9a-f]{16}) \|'),
            re.compile(r'config/experiments/(?P<name>\w+)\.yaml.*\(parameters (?P<hash>[0-9a-f]{16})\)'))


def published():
    """(place, experiment, seed, hash) of what is printed."""
    for path in sorted(glob.glob(os.path.join(ROOT, 'docs', '*.md')) + [os.path.join(ROOT, 'README.md')]):
        with open(path, encoding='utf-8') as file:
            for number, line in enumerate(file, 1):
                for pattern in PATTERNS:
                    for found in pattern.finditer(line):
                        named = found.groupdict()
                        yield ('%s:%d' % (os.path.relpath(path, ROOT), number), named['name'],
                               named.get('seed') or '1', named['hash'])


def todays(program, name, seed):
    """The hash of parameters, or None where the experiment's data are not here."""
    words = [program, 'experiment', os.path.join(ROOT, 'config', 'experiments', name + '.yaml'), '--hashes',
             '--seed', seed]
    if name.startswith('legs_map_'):
        plan = os.path.join(DATA, name.replace('legs_', '') + '_origin.yaml')
        if not os.path.isfile(plan):
            return None
        words += ['--map', plan]
    run = subprocess.run(words, capture_output=True, text=True, check=True, stdin=subprocess.DEVNULL)
    return re.search(r'parameters ([0-9a-f]{16})', run.stdout).group(1)


class PublishedTablesTest(unittest.TestCase):
    program = ''

    def test_what_is_printed_is_of_todays_parameters(self):
        found = list(published())
        self.assertGreaterEqual(len(found), 5, 'no printed results are found any more')
        stale = []
        for place, name, seed, printed in found:
            now = todays(self.program, name, seed)
            if now is None:
                print('%s: %s: no data in ../shared to compare it with' % (place, name))
            elif now != printed:
                stale.append('%s: %s is of parameters %s, today they are %s; play `hires experiment '
                             'config/experiments/%s.yaml` again' % (place, name, printed, now, name))
        self.assertEqual(stale, [], '\n' + '\n'.join(stale))


if __name__ == '__main__':
    PublishedTablesTest.program = sys.argv.pop(1)
    unittest.main()
