"""The pages of scripts/report: their numbers are those of the JSON, they load nothing, and what is no
answer of `hires` is refused with a word. The answers in test/data/report were written by `hires`, and shortened."""

import copy
import json
import math
import os
import re
import subprocess
import sys
import tempfile
import unittest

from scipy import stats

ROOT = os.path.realpath(os.path.join(os.path.dirname(__file__), '..', '..'))
PROGRAM = os.path.join(ROOT, 'scripts', 'report')
EXAMPLES = os.path.join(ROOT, 'test', 'data', 'report')
sys.path.insert(0, PROGRAM)

import report_input  # noqa: E402
import report_pages  # noqa: E402
import report_plots  # noqa: E402
import report_reproduce  # noqa: E402
from page_parser import Page  # noqa: E402

VERBS = {verb: verb.replace(' ', '_') + '.json' for verb in report_pages.PAGES}
# One pixel.
PNG = bytes.fromhex('89504e470d0a1a0a0000000d4948445200000001000000010802000000907753de0000000c49444154'
                    '08d763f8ffff3f0005fe02fea735816e0000000049454e44ae426082')


def example(verb):
    with open(os.path.join(EXAMPLES, VERBS[verb]), encoding='utf-8') as file:
        return json.load(file)


def page_of(content, path='-'):
    return report_pages.page(report_input.Answer(content, 'answer.json'), path)


def value_at(content, pointer):
    """By the rules of RFC 6901, and not by the program's own hand."""
    for word in pointer.split('/')[1:]:
        content = content[int(word) if isinstance(content, list) else word.replace('~1', '/').replace('~0', '~')]
    return content


def run(*arguments, **options):
    return subprocess.run(['/usr/bin/python3', '-B', PROGRAM, *arguments], capture_output=True, text=True,
                          check=False, **options)


class PageTest(unittest.TestCase):
    def require_field(self, content, pointer, value, shown):
        """What is shown is the field's value, to the last digit that is shown."""
        wanted = value_at(content, pointer)
        if value is None:
            self.assertEqual(shown, wanted, pointer)
            return
        self.assertEqual(json.loads(value), wanted, pointer)
        number = re.match(r'[-+]?[\d.]+(?:e[-+]?\d+)?', shown).group()
        factor = 100.0 if shown.endswith('%') else 1000.0 if shown.endswith(' ms') else 1.0
        mantissa, _, exponent = number.partition('e')
        digits = len(mantissa.partition('.')[2])
        half = 0.5 * 10.0 ** (int(exponent or 0) - digits)
        if '.' not in mantissa and len(mantissa.lstrip('+-')) >= 5:  # five digits that count
            half *= 10.0 ** max(0, len(mantissa.lstrip('+-')) - 5)
        self.assertLessEqual(abs(float(number) - factor * wanted), half * (1.0 + 1e-9), pointer)

    def test_every_number_is_that_of_the_json(self):
        for verb in VERBS:
            with self.subTest(verb):
                content = example(verb)
                fields = Page(page_of(content)).fields
                self.assertGreater(len(fields), 20)
                for pointer, value, shown in fields:
                    self.require_field(content, pointer, value, shown)

    def test_no_cell_has_a_number_of_its_own(self):
        for verb in VERBS:
            with self.subTest(verb):
                cells = Page(page_of(example(verb))).cells
                self.assertGreater(len(cells), 5)
                for kind, own_text in cells:
                    if 'step' not in kind.split():  # the number of a plan's step is its place
                        self.assertNotRegex(own_text, r'\d')

    def test_a_changed_number_changes_the_page(self):
        content = example('imagine')
        content['ranking'][1]['success']['lower'] = 0.123
        shown = [field for field in Page(page_of(content)).fields if field[0] == '/ranking/1/success/lower']
        self.assertEqual(shown, [('/ranking/1/success/lower', '0.123', '12.3 %')])

    def test_pages_load_nothing_and_run_nothing(self):
        for verb in VERBS:
            with self.subTest(verb):
                text = page_of(example(verb))
                page = Page(text)
                for address in page.addresses:
                    self.assertTrue(address.startswith(('data:', '#')), address)
                self.assertNotRegex(text, r'@import|url\((?!#)')
                self.assertNotIn('script', page.tags)
                self.assertEqual(len(page.ids), len(set(page.ids)), 'an id stands twice')

    def test_equal_answers_give_equal_pages(self):
        for verb in VERBS:
            with self.subTest(verb):
                self.assertEqual(page_of(example(verb)), page_of(example(verb)))

    def test_what_is_in_the_json_is_text_and_no_markup(self):
        content = example('imagine')
        content['why'] = '<script>alert(1)</script>'
        content['ranking'][0]['arguments'][0] = '"><img src=x>'
        page = Page(page_of(content))
        self.assertNotIn('script', page.tags)
        self.assertNotIn('img', page.tags)
        self.assertIn('<script>alert(1)</script>', [shown for _, _, shown in page.fields])

    def test_the_answer_comes_first(self):
        content = example('imagine')
        first = Page(page_of(content)).fields[0]
        self.assertEqual(first, ('/ranking/%d/action' % content['recommended'], None,
                                 content['ranking'][content['recommended']]['action']))

    def test_confidence_and_success_are_explained_where_they_are_far_apart(self):
        content = example('imagine')
        for alternative in content['ranking']:
            alternative['confidence']['mean'] = alternative['success']['share']
        self.assertNotIn('Confidence is not success', page_of(content))
        content['ranking'][0]['confidence']['mean'] -= 0.2
        self.assertIn('Confidence is not success', page_of(content))

    def test_answers_without_alternatives_have_a_page(self):
        content = example('imagine')
        content.update(ranking=[], outcome='no_worker', recommended=None)
        self.assertIn('No worker could be reached', page_of(content))

    def test_answers_in_which_little_happened_have_a_page(self):
        imagined, played, planned, done = (example(verb) for verb in ('imagine', 'experiment', 'plan', 'achieve'))
        for alternative in imagined['ranking']:
            alternative['duration']['values'] = []  # every action failed
            alternative['max_tilt']['values'] = [0.0, 0.0]
            alternative['median_rollout'] = None
        played.update(rows=[], tables=[], expectations=[])
        planned.update(plans=[], outcome='no_plan')
        done.update(timeline=[], imaginations=[], truth=None, seed=None)
        for content, said in ((imagined, 'Nothing is recommended' if imagined['recommended'] is None else
                               'Recommended'), (played, 'the file expects nothing'),
                              (planned, 'There is no plan'), (done, 'The task is done')):
            self.assertIn(said, page_of(content))

    def test_what_a_robot_lacks_comes_first_with_its_remedy(self):
        content = example('doctor')
        del content['physics']
        content['ok'] = False
        content['findings'] = [
            {'level': 'note', 'code': 'slow', 'subject': 'topic /tf', 'text': 'is slow', 'remedy': 'wait'},
            {'level': 'failed', 'code': 'topic_missing', 'subject': 'topic /scan', 'text': 'is not there',
             'remedy': 'start it'}]
        shown = [text for _, _, text in Page(page_of(content)).fields]
        self.assertLess(shown.index('topic /scan'), shown.index('topic /tf'))
        self.assertIn('start it', shown)

    def test_pictures_become_part_of_the_page(self):
        content = example('imagine')
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, 'strip.png'), 'wb') as file:
                file.write(PNG)
            content['pictures'] = [{'caption': 'the worst rollout', 'file': 'strip.png'}]
            page = Page(page_of(content, os.path.join(folder, 'answer.json')))
            self.assertIn('img', page.tags)
            content['pictures'][0]['file'] = 'gone.png'
            with self.assertRaisesRegex(report_input.ReportError, 'pictures/0/file.*gone.png'):
                page_of(content, os.path.join(folder, 'answer.json'))

    def test_a_missing_or_wrong_field_is_named(self):
        def without_lower(content):
            del content['ranking'][0]['success']['lower']

        def with_text(content):
            content['ranking'][0]['falls'] = 'many'

        def beyond(content):
            content['recommended'] = 99

        def unknown(content):
            content['outcome'] = 'splendid'

        for change, said in ((without_lower, 'field /ranking/0/success/lower: came nothing, wanted a number'),
                             (with_text, 'field /ranking/0/falls: came "many", wanted a whole number'),
                             (beyond, 'field /recommended: came 99, wanted the index'),
                             (unknown, "field /outcome: 'splendid' is unknown; wanted one of")):
            content = copy.deepcopy(example('imagine'))
            change(content)
            with self.subTest(said), self.assertRaises(report_input.ReportError) as caught:
                page_of(content)
            self.assertIn(said, str(caught.exception))
            self.assertIn('answer.json', str(caught.exception))


class CatalogueTest(unittest.TestCase):
    def test_each_drawing_of_the_shipped_catalogue_is_known(self):
        import yaml
        with open(os.path.join(ROOT, 'lab', 'config', 'reproduce.yaml'), encoding='utf-8') as file:
            items = yaml.safe_load(file)['items']
        drawings = {drawing.split(':')[1] for item in items for drawing in item.get('drawings', [])}
        self.assertEqual(drawings, set(report_reproduce.DRAWINGS))

    def test_published_durations_are_those_that_the_experiment_is_compared_with(self):
        import yaml
        files = []
        for name in ('reproduce.yaml', os.path.join('experiments', 'durations.yaml')):
            with open(os.path.join(ROOT, 'lab', 'config', name), encoding='utf-8') as file:
                files.append(yaml.safe_load(file))
        wanted = {}
        for action in files[1]['durations']['actions']:
            row = '_'.join((action.get('motion_set', action['action']), action['from'], action['to']))
            for whose in ('simulated', 'real'):
                for what in ('mean', 'sigma'):
                    wanted[whose, '/measures/%s_%s' % (what, row)] = action[whose][what]
        whose = {'Table 6.1': 'simulated', 'Table 6.2': 'real',
                 **{'Fig. A.%d' % i: 'simulated' if i < 25 else 'real' for i in range(19, 31)}}
        found = set()
        for item in files[0]['items']:
            for value in item.get('values', []) if item['item'] in whose else []:
                key = whose[item['item']], value['at']
                if 'published' in value:
                    found.add((item['item'], *key))
                    self.assertEqual(value['published'], wanted[key], (item['item'], value['name']))
        self.assertEqual(len(found), 2 * len(wanted), 'a table and a figure have each of them')

    def test_undecided_checks_are_counted_apart_from_undecided_results(self):
        content = copy.deepcopy(example('reproduce'))
        verdicts = ['reproduced', 'undecided', 'check holds', 'check undecided', 'check undecided']
        for item, verdict in zip(content['items'], verdicts):
            item['verdict'] = verdict
        page = page_of(content)
        self.assertIn('<h1>1 of 2 published results with numbers are reproduced or better, 1 is undecided</h1>', page)
        self.assertIn('1 of 3 checks by bounds of our own hold, 2 are undecided.', page)
        self.assertIn('1 reproduced, 1 undecided, 1 check holds, 2 check undecided.', page)
        self.assertIn('<td class="warning">', page)

    def test_where_nothing_is_judged_that_is_said_and_is_not_green(self):
        content = copy.deepcopy(example('reproduce'))
        for verdicts, state, said in (
                (['shown', 'described'], 'neutral', 'Nothing here is judged'),
                (['shown', 'not played'], 'open', 'Nothing here is judged.*; 1 was not played'),
                (['shown', 'check holds'], 'good', 'No published number is judged here; 1 of 1 checks'),
                (['check holds', 'check undecided'], 'open', 'No published number is judged here; 1 of 2 checks'),
                (['better', 'check fails'], 'open', '1 of 1 published results with numbers are reproduced or better'),
                (['reproduced', 'check holds'], 'good', '1 of 1 published')):
            with self.subTest(verdicts):
                content['items'] = copy.deepcopy(example('reproduce')['items'][:2])
                for item, verdict in zip(content['items'], verdicts):
                    item['verdict'] = verdict
                page = page_of(content)
                self.assertRegex(page, '<header class="%s">' % state)
                self.assertRegex(page, '<h1>%s' % said)
                self.assertNotIn('0 of 0', page)

    def test_a_row_that_nobody_played_is_named(self):
        content = copy.deepcopy(example('reproduce'))
        item = next(item for item in content['items'] if item['item'] == 'Fig. 6.3')
        item['drawings'] = ['durations:normality:fast EC1 NT2']
        with self.assertRaisesRegex(report_input.ReportError, "play durations: no run of 'fast EC1 NT2'"):
            page_of(content)

    def test_what_cannot_be_drawn_is_said(self):
        content = copy.deepcopy(example('reproduce'))
        item = next(item for item in content['items'] if item['item'] == 'Fig. 6.3')
        for row in content['plays']['durations']['answer']['rows']:
            row['duration'] = 5.0
        self.assertIn('Not drawn, for the answer has too little for it: ' + item['drawings'][0], page_of(content))

    def test_the_published_normal_is_drawn_beside_ours(self):
        content = copy.deepcopy(example('reproduce'))
        item = next(item for item in content['items'] if item['item'] == 'Fig. 6.3')
        self.assertNotIn('published', report_reproduce.pictures_of(
            report_input.Answer(content, 'a'), '/items/%d' % content['items'].index(item))[0][0])
        number = {'unit': 's', 'over': None, 'found': 1.0, 'lower': None, 'upper': None, 'accepted': 'not judged',
                  'judged': False, 'holds': False, 'undecided': False, 'better': False}
        item['values'] = [{'name': what, 'at': 'durations:/measures/%s_fast_EC1_NT1' % what, 'published': published,
                           **number} for what, published in (('mean', 15.99), ('sigma', 0.72))]
        self.assertIn('published', report_reproduce.pictures_of(
            report_input.Answer(content, 'a'), '/items/%d' % content['items'].index(item))[0][0])

    def test_the_sharpest_turn_is_that_of_the_circle_driven(self):
        angles = [0.1 * i for i in range(20)]
        x, y = [5.0 + 2.0 * math.cos(a) for a in angles], [1.0 + 2.0 * math.sin(a) for a in angles]
        for xs, ys in ((x, y), (x[::-1], y[::-1])):  # left and right about
            cx, cy, radius, text = report_reproduce._sharpest_turn(xs, ys, [0.4] * 20, [0.2] * 20)
            self.assertAlmostEqual(math.hypot(cx - 5.0, cy - 1.0), 0.0, places=6)
            self.assertAlmostEqual(radius, 2.0)
            self.assertEqual(text, 'r = 2.00 m')
        self.assertIsNone(report_reproduce._sharpest_turn(x, y, [0.0] * 20, [0.2] * 20), 'it stands')

    def test_what_is_said_of_a_sample(self):
        told = report_plots.normality_of([1.0, 2.0, 4.0, 5.0])
        self.assertEqual((told['n'], told['mean']), (4, 3.0))
        self.assertAlmostEqual(told['sigma'], math.sqrt(10.0 / 4.0))  # 1/N, as the dissertation's
        even = [stats.norm.ppf((i + 0.5) / 50) for i in range(50)]
        self.assertGreater(report_plots.normality_of(even)['p'], 0.99)
        self.assertIn('does not reject', report_plots.normality_text(report_plots.normality_of(even)))
        skewed = [math.exp(value) for value in even]
        self.assertLess(report_plots.normality_of(skewed)['p'], 0.01)
        self.assertNotIn('does not', report_plots.normality_text(report_plots.normality_of(skewed)))
        self.assertNotIn('w', report_plots.normality_of([5.2, 5.2, 5.2]))


class ProgramTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def write(self, text):
        with open(self.path('answer.json'), 'w', encoding='utf-8') as file:
            file.write(text)
        return self.path('answer.json')

    def require_refused(self, text, *said):
        with self.subTest(said[0]), self.assertRaises(report_input.ReportError) as caught:
            report_input.read(self.write(text), report_pages.PAGES)
        for words in ('answer.json', *said):
            self.assertIn(words, str(caught.exception))

    def test_numbers_without_a_page_are_called_what_they_are(self):
        for schema in ('hires/recognition', 'hires/recognition_experiment', 'hires/detector_fit'):
            self.require_refused(json.dumps({'schema': schema, 'version': 2, 'things': []}),
                                 'has no field /report: it is %s, numbers for machines that have no page' % schema,
                                 'pages are made of what achieve, doctor, experiment, experiment hypothesis, ')
        self.require_refused('{"schema": 3}', 'is no answer of `hires` that has a page')

    def test_what_is_no_answer_is_refused(self):
        head = {'format': 1, 'verb': 'imagine', 'version': '0.2.0'}
        self.require_refused('', 'is no JSON')
        self.require_refused('{"report": {"format"', 'is no JSON', 'written to its end')
        self.require_refused('{"report": {"format": NaN}}', 'is no JSON', 'NaN')
        self.require_refused('[1, 2]', 'has no field /report')
        self.require_refused('{"ranking": []}', 'has no field /report', 'is no answer of `hires` that has a page',
                             'before 0.2')
        self.require_refused(json.dumps({'report': {**head, 'format': 'one'}}),
                             'field /report/format: came "one", wanted a whole number')
        self.require_refused(json.dumps({'report': {**head, 'format': 2, 'version': '9.1'}}),
                             'is 2, this program reads 1 to 1', 'version 9.1')
        self.require_refused(json.dumps({'report': {**head, 'verb': 'dance'}}), "no page of 'dance'", 'imagine')
        with self.assertRaisesRegex(report_input.ReportError, 'nowhere.json: cannot be read'):
            report_input.read(self.path('nowhere.json'), report_pages.PAGES)

    def test_writes_a_page_and_ends_with_0(self):
        path = os.path.join(EXAMPLES, VERBS['imagine'])
        done = run(path, '--html', self.path('page.html'))
        self.assertEqual((done.returncode, done.stdout, done.stderr), (0, '', ''))
        with open(self.path('page.html'), encoding='utf-8') as file:
            self.assertEqual(file.read(), page_of(example('imagine'), path))
        self.assertEqual(os.listdir(self.folder.name), ['page.html'], 'and nothing beside it')

    def test_a_broken_answer_ends_with_1_and_leaves_the_page_that_was_there(self):
        with open(self.path('page.html'), 'w', encoding='utf-8') as file:
            file.write('an earlier one')
        done = run('-', '--html', self.path('page.html'), input='{}')
        self.assertEqual(done.returncode, 1)
        self.assertIn('standard input: has no field /report', done.stderr)
        with open(self.path('page.html'), encoding='utf-8') as file:
            self.assertEqual(file.read(), 'an earlier one')

    def test_only_achieve_has_a_timeline(self):
        done = run(os.path.join(EXAMPLES, VERBS['imagine']), '--png', self.path('run.png'))
        self.assertEqual(done.returncode, 1)
        self.assertIn('is no answer of `hires achieve`', done.stderr)

    def test_bad_arguments_end_with_2(self):
        self.assertEqual(run('answer.json').returncode, 2)

    def test_a_missing_package_ends_with_3_and_is_named(self):
        code = ("import runpy, sys, importlib.util as util; find = util.find_spec; "
                "util.find_spec = lambda name, *rest: None if name == 'jinja2' else find(name, *rest); "
                "sys.argv = ['report', '--check']; runpy.run_path(%r, run_name='__main__')" % PROGRAM)
        done = subprocess.run(['/usr/bin/python3', '-B', '-c', code], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn('needs python3-jinja2, which is not installed', done.stderr)

    def test_what_cannot_be_written_ends_with_4(self):
        done = run(os.path.join(EXAMPLES, VERBS['achieve']), '--png', '/no/such/folder/run.png')
        self.assertEqual(done.returncode, 4)
        self.assertIn('/no/such/folder/run.png: cannot be written', done.stderr)

    def test_the_timeline_is_a_picture(self):
        done = run(os.path.join(EXAMPLES, VERBS['achieve']), '--png', self.path('run.png'))
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.path('run.png'), 'rb') as file:
            self.assertEqual(file.read(8), PNG[:8])


class DocumentedExampleTest(unittest.TestCase):
    def test_the_page_in_docs_is_what_is_made_today(self):
        path = os.path.join(ROOT, 'docs', 'example_report.json')
        with open(path, encoding='utf-8') as file:
            made = page_of(json.load(file), path)
        with open(os.path.join(ROOT, 'docs', 'example_report.html'), encoding='utf-8') as file:
            self.assertTrue(file.read() == made, 'make it again: scripts/run hires report '
                            'docs/example_report.json --html docs/example_report.html')


if __name__ == '__main__':
    unittest.main()
