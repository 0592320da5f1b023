"""Which results that docs/ and README print are those of today's parameters, how the others are played again, and
whether the counts of reproduced results agree with the catalogue.

Results of `hires experiment FILE` carry the hash of the parameters that they were played with, those of series
(`experiment hypothesis`, `scenarios` and the like) that of all files that a series reads: `hires experiment
--hashes`. A document may keep a stale result only where it says so: "files HASH, stale", "parameters HASH, stale".
"""

import glob
import os
import re
import subprocess
import sys
import unittest

import yaml

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..'))
DATA = os.path.join(ROOT, '..', 'shared', 'data')
# The first line of a printed report, a row of a table of reports, and a hash in a sentence that names the file.
PATTERNS = (re.compile(r'^(?P<name>\w+) \(\w+\), seed (?P<seed>\d+), parameters (?P<hash>[0-9a-f]{16})'
                       r'(?P<stale>, stale)?, experiment'),
            re.compile(r'^\| `(?P<name>\w+)` \| (?P<hash>[0-9a-f]{16})(?P<stale>, stale)? \|'),
            re.compile(r'config/experiments/(?P<name>\w+)\.yaml.*\(parameters (?P<hash>[0-9a-f]{16})'
                       r'(?P<stale>, stale)?\)'))
EXPERIMENT = re.compile(r'`(?:nice )?hires experiment config/experiments/(?P<name>\w+)\.yaml\b[^`]*`')
# A command that plays a series; where a day stands in its paragraph, the paragraph prints what it said then.
SERIES = re.compile(r'`hires (?P<command>(?:experiment (?:hypothesis|decision|recognition|detector|localisation|'
                    r'torso_poses)|scenarios|map --drive)\b[^`]*)`')
DAY = re.compile(r'\b20\d\d-\d\d-\d\d\b')
# What came of `hires reproduce all`, without what stands in brackets.
RESULTS = re.compile(r'of (?P<published>\d+) published results (?P<reproduced>\d+) (?:is|are) reproduced',
                     re.IGNORECASE)
ALL_RESULTS = re.compile(RESULTS.pattern + r', (?P<off>\d+) (?:is|are) not and (?P<undecided>\d+) (?:is|are) undecided'
                         r'.*?; of (?P<checks>\d+) checks by bounds of our own (?P<hold>\d+) holds?'
                         r'(?:, (?P<fail>\d+) fails?)? and (?P<open>\d+) (?:is|are) undecided'
                         r'; (?P<shown>\d+) are pictures and numbers that are not judged, (?P<words>\d+) words alone',
                         re.IGNORECASE)
FILES = re.compile(r'files (?P<hash>[0-9a-f]{16})(?P<stale>, stale)?')


def documents():
    """(path, number, line) of all that is printed."""
    for path in sorted(glob.glob(os.path.join(ROOT, 'docs', '*.md')) + [os.path.join(ROOT, 'README.md')]):
        with open(path, encoding='utf-8') as file:
            for number, line in enumerate(file, 1):
                yield os.path.relpath(path, ROOT), number, line


def published():
    """(place, experiment, seed, hash, whether it says that it is stale) of what is printed."""
    for path, number, line in documents():
        for pattern in PATTERNS:
            for found in pattern.finditer(line):
                named = found.groupdict()
                yield ('%s:%d' % (path, number), named['name'], named.get('seed') or '1', named['hash'],
                       bool(named['stale']))


def experiments_without_hash():
    """(place, experiment) of what is printed under a day and says nowhere of which parameters it is."""
    lines = list(documents())
    for at, (path, number, line) in enumerate(lines):
        if not (EXPERIMENT.search(line) and DAY.search(line)):
            continue
        below = [text for other, _, text in lines[at:at + 5] if other == path]  # a printed report begins so
        if not any(pattern.search(text) for pattern in PATTERNS for text in below):
            yield '%s:%d' % (path, number), EXPERIMENT.search(line).group('name')


def series():
    """(place, commands, hash or None, whether it says that it is stale) of what is printed."""
    for path, number, line in documents():
        commands = SERIES.findall(line)
        is_result = commands and DAY.search(line)
        for files in list(FILES.finditer(line)) or ([None] if is_result else []):
            yield ('%s:%d' % (path, number), ', '.join('`hires %s`' % command for command in commands),
                   files and files.group('hash'), bool(files and files.group('stale')))


def hash_of_files(program):
    """Of all that series read, today."""
    run = subprocess.run([program, 'experiment', '--hashes'], capture_output=True, text=True, check=True,
                         stdin=subprocess.DEVNULL)
    return FILES.match(run.stdout).group('hash')


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


def counted(path, pattern):
    """The numbers of the one sentence like that in a document, or None."""
    with open(os.path.join(ROOT, path), encoding='utf-8') as file:
        text = re.sub(r'\[([^]]*)\]\([^()]*\)', r'\1', file.read())
    text = re.sub(r'\s*\([^()]*\)', '', ' '.join(text.split()))
    found = list(pattern.finditer(text))
    return {name: int(number or 0) for name, number in found[0].groupdict().items()} if len(found) == 1 else None


def kinds_of_items():
    """How many items of the dissertation's catalogue there are of each kind."""
    with open(os.path.join(ROOT, 'config', 'reproduce.yaml'), encoding='utf-8') as file:
        items = yaml.safe_load(file)['items']
    kinds = {'published': 0, 'checks': 0, 'shown': 0, 'words': 0}
    for item in items:
        is_judged = any(not value.get('shown') for value in item.get('values', []))
        kinds[('checks' if item.get('own') else 'published') if is_judged else
              'shown' if item.get('plays') else 'words'] += 1
    return kinds


class CountedResultsTest(unittest.TestCase):
    def test_the_counts_that_are_told_are_those_of_the_catalogue(self):
        told = counted('docs/results.md', ALL_RESULTS)
        self.assertIsNotNone(told, 'docs/results.md has not one sentence as %s' % ALL_RESULTS.pattern)
        self.assertEqual({kind: told[kind] for kind in kinds_of_items()}, kinds_of_items(), 'docs/results.md')
        self.assertEqual(told['reproduced'] + told['off'] + told['undecided'], told['published'], 'docs/results.md')
        self.assertEqual(told['hold'] + told['fail'] + told['open'], told['checks'], 'docs/results.md')

    def test_the_readme_tells_the_same(self):
        told, short = counted('docs/results.md', RESULTS), counted('README.md', RESULTS)
        self.assertIsNotNone(short, 'README.md has not one sentence as %s' % RESULTS.pattern)
        self.assertEqual(short, told)


class PublishedTablesTest(unittest.TestCase):
    program = ''

    def test_what_is_printed_is_of_todays_parameters_or_says_that_it_is_stale(self):
        found = list(published())
        self.assertGreaterEqual(len(found), 5, 'no printed results are found any more')
        wrong = []
        for place, name, seed, printed, is_stale in found:
            now = todays(self.program, name, seed)
            again = 'play `hires experiment config/experiments/%s.yaml` again' % name
            if now is None:
                print('%s: %s: no data in ../shared to compare it with' % (place, name))
            elif now == printed and is_stale:
                wrong.append('%s: says that it is stale, and is of today: take that word out' % place)
            elif now != printed and is_stale:
                print('%s: stale, and says so; %s' % (place, again))
            elif now != printed:
                wrong.append('%s: %s is of parameters %s, today they are %s; %s, or write ", stale" behind the hash'
                             % (place, name, printed, now, again))
        self.assertEqual(wrong, [], '\n' + '\n'.join(wrong))

    def test_experiments_that_are_printed_say_of_which_parameters(self):
        wrong = ['%s: %s: wanted "(parameters HASH)" behind the command, as it prints it' % found
                 for found in experiments_without_hash()]
        self.assertEqual(wrong, [], '\n' + '\n'.join(wrong))

    def test_series_that_are_printed_are_of_todays_files_or_say_that_they_are_stale(self):
        found = list(series())
        self.assertGreaterEqual(len(found), 8, 'no printed series are found any more')
        now, wrong = hash_of_files(self.program), []
        for place, commands, printed, is_stale in found:
            again = '; play again (config/reproduce.yaml, config/reproduce_docs.yaml): ' + commands
            if printed is None:
                wrong.append('%s: wanted "files HASH" behind the date, as the command prints it%s' % (place, again))
            elif printed == now and is_stale:
                wrong.append('%s: says that it is stale, and is of today: take that word out' % place)
            elif printed != now and not is_stale:
                wrong.append('%s: is of files %s, today they are %s%s, or write ", stale" behind the hash'
                             % (place, printed, now, again))
            elif is_stale:
                print('%s: stale, and says so%s' % (place, again))
        self.assertEqual(wrong, [], '\n' + '\n'.join(wrong))


if __name__ == '__main__':
    PublishedTablesTest.program = sys.argv.pop(1)
    unittest.main()
