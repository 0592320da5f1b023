"""What README and docs/ print behind a command is what that command says today.

Of every block between ``` that begins with "$ scripts/run hires" the commands are run from the source tree, and their
answers are compared line by line; how long that took is not. Commands that write files, and those with what
nobody types ("..."), are left out.
"""

import glob
import os
import re
import shlex
import subprocess
import sys
import unittest

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..'))
PROMPT = '$ scripts/run hires '
WRITES = ('blackboard ', '--json', '--html', '--csv', '--output', '--store')
# Lines that say how long it took.
TOOK = re.compile(r'^[\d.]+ s (?:imagined|played) in |ms of processor time')


def blocks(path):
    """The lines of each block between ```, with the number of its first."""
    block = None
    with open(path, encoding='utf-8') as file:
        for number, line in enumerate(file, 1):
            if line.startswith('```'):
                if block is not None:
                    yield first, block
                first, block = number + 1, None if block is not None else []
            elif block is not None:
                block.append(line.rstrip('\n'))


def examples():
    """(place, words of the command, printed lines)."""
    for path in sorted(glob.glob(os.path.join(ROOT, 'docs', '*.md')) + [os.path.join(ROOT, 'README.md')]):
        for number, block in blocks(path):
            for part in re.split(r'^(?=\$ )', '\n'.join(block), flags=re.M):
                text = re.sub(r'\\\n\s*', '', part)
                command, _, printed = text.partition('\n')
                if not command.startswith(PROMPT) or '...' in command or any(w in command for w in WRITES):
                    continue
                if printed.strip():
                    yield ('%s:%d' % (os.path.relpath(path, ROOT), number),
                           shlex.split(command[len(PROMPT):], comments=True), printed.splitlines())


def compared(lines):
    """Without what differs each time."""
    lines = [line.rstrip() for line in lines if not TOOK.search(line)]
    while lines and not lines[-1]:
        lines.pop()
    return lines


class PrintedExamplesTest(unittest.TestCase):
    maxDiff = None

    def test_each_command_says_what_is_printed(self):
        num_run = 0
        for place, words, printed in examples():
            with self.subTest(place):
                run = subprocess.run([HIRES, *words, *(['--quiet'] if words[0] in QUIET else [])], cwd=ROOT,
                                     stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False,
                                     stdin=subprocess.DEVNULL)
                self.assertEqual(compared(run.stdout.splitlines()), compared(printed),
                                 'hires %s: print what it says today' % ' '.join(words))
            num_run += 1
        self.assertGreaterEqual(num_run, 8, 'examples that are compared')


QUIET = ('imagine', 'limits')  # verbs with a line of progress

if __name__ == '__main__':
    HIRES = sys.argv.pop(1)
    unittest.main()
