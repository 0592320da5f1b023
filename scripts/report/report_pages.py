"""One page for each verb: what it says first, which pictures it has. The rest is in templates/."""

import base64
import os
import re

import jinja2

import report_drawings as drawings
from report_input import ReportError, folder_of
from report_numbers import Numbers, action_name, bars_of, values
from report_reproduce import reproduce

GOOD, OPEN, BAD = 'good', 'open', 'bad'

# What an outcome of imagination says in one line, and how it is marked.
IMAGINED = {
    'ranked': ('Recommended', GOOD),
    'ranked_at_deadline': ('Recommended, cut short by the deadline', GOOD),
    'close': ('Recommended, but a near tie', GOOD),
    'all_failed': ('Nothing is recommended: all alternatives fail', BAD),
    'undecided': ('Undecided: more rollouts are needed', OPEN),
    'no_worker': ('No worker could be reached', BAD),
    'nothing_finished': ('Nothing finished by the deadline', BAD),
    'cancelled': ('Cancelled', OPEN),
}
TASKS = {
    'succeeded': ('The task is done', GOOD),
    'no_plan': ('There is no plan for the task', BAD),
    'failed': ('The task failed', BAD),
    'preempted': ('The task was ended on request', OPEN),
    'invalid': ('The task was refused', BAD),
    'busy': ('The task was refused: another one is being done', BAD),
    'dry_run': ('Planned and imagined; nothing was moved', GOOD),
}
PLANS = {'found': ('A plan is found', GOOD), 'no_plan': ('There is no plan', BAD)}

# Confidence and success are explained where they are so far apart.
FAR_APART = 0.1


def said(answer, pointer, sentences):
    """What is said of an outcome.  @raise ReportError for one that is unknown."""
    word = answer.at(pointer, str)
    if word in sentences:
        return sentences[word]
    raise ReportError('%s: field %s: %r is unknown; wanted one of %s' %
                      (answer.name, pointer, word, ', '.join(sorted(sentences))))


def recommended(answer, pointer, places):
    """The place that is recommended, or None."""
    if not answer.has(pointer):
        return None
    index = answer.at(pointer, int)
    if -1 <= index < len(places):
        return places[index] if index >= 0 else None
    raise ReportError('%s: field %s: came %d, wanted the index of one of %d alternatives' %
                      (answer.name, pointer, index, len(places)))


def far_apart(answer, ranking):
    """The alternative of which confidence and success say the most different things, or None."""
    def distance(place):
        return abs(answer.at(place + '/success/share', float) - answer.at(place + '/confidence/mean', float))
    furthest = max(ranking, key=distance, default=None)
    return furthest if furthest is not None and distance(furthest) > FAR_APART else None


def imagine(answer):
    ranking = answer.items('/ranking')
    best = recommended(answer, '/recommended', ranking)
    headline, state = said(answer, '/outcome', IMAGINED)
    names = {place: action_name(answer, place) for place in ranking}

    def interval(place):
        share = place + '/success/'
        return (names[place], answer.at(share + 'share', float), answer.at(share + 'lower', float),
                answer.at(share + 'upper', float), place == best)

    def spread(place, quantity):
        field = place + '/' + quantity
        return (names[place], values(answer, field + '/values'),
                [answer.at(field + '/p50', float), answer.at(field + '/p95', float)], place == best)

    causes = [('%s, %s' % (answer.at(cause + '/cause', str), names[place]), answer.at(cause + '/count', int),
               place == best) for place in ranking for cause in answer.items(place + '/first_causes')]
    wanted = None
    if answer.has('/min_success'):
        least = answer.at('/min_success', float)
        wanted = (least, 'wanted %g %%' % (100.0 * least))
    return {
        'headline': headline, 'state': state, 'ranking': ranking, 'best': best,
        'far_apart': far_apart(answer, ranking),
        'with_cost': any(answer.has(place + '/expected_cost') for place in ranking),
        'most_failures': max((answer.at(f + '/count', int) for p in ranking
                              for f in answer.items(p + '/failures')), default=0),
        'success': drawings.intervals('success', 'rollouts that succeed [%], 95 % intervals',
                                      [interval(place) for place in ranking], wanted=wanted)
                   if ranking else None,
        'durations': drawings.spreads('durations', 'duration [s]',
                                      [spread(place, 'duration') for place in ranking]),
        'tilts': drawings.spreads('tilts', 'largest tilt of a rollout [rad], logarithmic',
                                  [spread(place, 'max_tilt') for place in ranking], logarithmic=True),
        'causes': drawings.counts('causes', 'rollouts', causes),
    }


def measured_intervals(answer):
    """Measures that come with an interval: (name, estimate, lower, upper, whether it excludes 0)."""
    rows = []
    for place in answer.keys('/measures'):
        if not all(answer.has(place + end) for end in ('', '_lower', '_upper')):
            continue
        lower, upper = answer.at(place + '_lower', float), answer.at(place + '_upper', float)
        rows.append((place.split('/')[-1], answer.at(place, float), lower, upper, lower > 0 or upper < 0))
    return rows


def grouped(answer, rows, group, quantity, kind):
    """{group: values of the quantity} over rows that have it."""
    found = {}
    for place in rows:
        if answer.has('%s/%s' % (place, quantity)):
            head = answer.at('%s/%s' % (place, group), str) if answer.has('%s/%s' % (place, group)) else 'all'
            found.setdefault(head or 'other', []).append(answer.at('%s/%s' % (place, quantity), kind))
    return found


def spread_of_rows(answer, rows, group, quantity, name, label, logarithmic=False):
    found = grouped(answer, rows, group, quantity, float)
    return drawings.spreads(name, label, [(head, found[head], [], True) for head in sorted(found)],
                            logarithmic)


def counted(answer, rows, group, quantity, name, label):
    """How often each word came, the most frequent first; what is empty is left out."""
    tally = {}
    for head, words in grouped(answer, rows, group, quantity, str).items():
        for word in filter(None, words):
            tally[(head, word)] = tally.get((head, word), 0) + 1
    ordered = sorted(tally.items(), key=lambda item: (-item[1], item[0]))
    return drawings.counts(name, label, [('%s, %s' % (word, head), count, True)
                                         for (head, word), count in ordered])


def experiment(answer):
    checks, rows = answer.items('/expectations'), answer.items('/rows')
    passed = answer.at('/passed', bool)
    headline = ('All expectations hold' if passed else 'Not all expectations hold') if checks else (
        'Played; the file expects nothing')
    group = next((key for key in ('motion_set', 'load') if rows and answer.has('%s/%s' % (rows[0], key))),
                 'motion_set')
    found = measured_intervals(answer)
    return {
        'headline': '%s: %s' % (answer.at('/name', str), headline),
        'state': (GOOD if passed else BAD) if checks else OPEN,
        'checks': checks,
        'intervals': drawings.intervals('intervals', 'measure, 95 % intervals', found, percent=False,
                                        wanted=(0.0, 'no difference')) if found else None,
        'durations': spread_of_rows(answer, rows, group, 'duration', 'durations', 'duration [s]'),
        'tilts': spread_of_rows(answer, rows, group, 'max_tilt', 'tilts',
                                'largest tilt of a rollout [rad], logarithmic', logarithmic=True),
        'causes': counted(answer, rows, group, 'first_cause', 'causes', 'what began it, rollouts'),
    }


def hypothesis(answer):
    arms = [('with imagination', '/with_imagination'), ('without imagination', '/without_imagination')]
    difference = '/paired_difference/'
    lower, upper = answer.at(difference + 'lower', float), answer.at(difference + 'upper', float)
    headline, state = ('Imagination makes success more frequent', GOOD) if lower > 0 else (
        ('Imagination makes success less frequent', BAD) if upper < 0 else
        ('No difference in success is shown', OPEN))
    runs = [run for run in answer.items('/list') if answer.at(run + '/complete', bool)]
    durations = {arm: [answer.at(run + '/duration', float) for run in runs
                       if answer.at(run + '/imagination', bool) == (arm == arms[0][0])] for arm, _ in arms}
    return {
        'headline': headline, 'state': state, 'arms': arms,
        'failed': [run for run in answer.items('/list') if not answer.at(run + '/success', bool)],
        'success': drawings.intervals('success', 'runs that succeed [%], 95 % intervals',
                                      [(name, *(answer.at('%s/success/%s' % (arm, end), float)
                                                for end in ('share', 'lower', 'upper')), i == 0)
                                       for i, (name, arm) in enumerate(arms)]),
        'difference': drawings.intervals('difference', 'difference of the shares [percentage points]',
                                         [('success with minus without',
                                           answer.at(difference + 'mean', float), lower, upper,
                                           state != OPEN)], wanted=(0.0, 'no difference')),
        'durations': drawings.spreads('durations', 'duration of runs that came to an end [s]',
                                      [(arm, durations[arm], [], i == 0) for i, (arm, _) in enumerate(arms)]),
    }


def achieve(answer):
    headline, state = said(answer, '/outcome', TASKS)
    imaginations = answer.items('/imaginations')

    def intervals(place):
        predictions = answer.items(place + '/predictions')
        if not predictions:
            return None
        best = recommended(answer, place + '/recommended', predictions)
        return drawings.intervals(
            'imagined%s' % place.split('/')[-1], 'rollouts that succeed [%], 95 % intervals',
            [(action_name(answer, p), answer.at(p + '/success', float), answer.at(p + '/success_lower', float),
              answer.at(p + '/success_upper', float), p == best) for p in predictions])

    return {
        'headline': headline, 'state': state, 'imaginations': imaginations,
        'intervals': {place: intervals(place) for place in imaginations},
        'timeline': drawings.timeline('timeline', 'what was done when', bars_of(answer),
                                      answer.at('/duration', float)),
    }


def plan(answer):
    plans = answer.items('/plans')
    headline, state = PLANS.get(answer.at('/outcome', str), ('The search ended early', OPEN))

    def after(place, step):
        """The pairs of the plan's order that end at this step."""
        return ['%s/0' % pair for pair in answer.items(place + '/order') if answer.at(pair + '/1', int) == step]

    refused = any(answer.items(place + '/violations') for place in plans if answer.has(place + '/violations'))
    return {
        'headline': 'The validator refuses a plan' if refused else headline,
        'state': BAD if refused else state, 'plans': plans, 'after': after,
    }


def doctor(answer):
    is_well = answer.at('/ok', bool)
    return {
        'headline': 'All is well' if is_well else 'Something needs attention',
        'state': GOOD if is_well else BAD,
        'findings': sorted(answer.items('/findings'),
                           key=lambda place: answer.at(place + '/level', str) != 'failed'),
        'bodies': answer.items('/physics') if answer.has('/physics') else [],
    }


PAGES = {'imagine': imagine, 'experiment': experiment, 'experiment hypothesis': hypothesis,
         'achieve': achieve, 'plan': plan, 'doctor': doctor, 'reproduce': reproduce}


def pictures(answer, path):
    """PNG files that the answer names, as (place, data); their paths count from its own folder."""
    found = []
    for place in answer.items('/pictures') if answer.has('/pictures') else []:
        file = os.path.join(folder_of(path), answer.at(place + '/file', str))
        try:
            with open(file, 'rb') as opened:
                data = opened.read()
        except OSError as error:
            raise ReportError('%s: field %s/file: %s: %s; make it again with the answer, or take the '
                              'field out' % (answer.name, place, file, error.strerror)) from error
        if not data.startswith(b'\x89PNG'):
            raise ReportError('%s: field %s/file: %s is no PNG picture' % (answer.name, place, file))
        found.append((place, base64.b64encode(data).decode('ascii')))
    return found


def command_again(answer):
    """The command that gives the answer again, and this page with it."""
    command = answer.at('/report/command', str)
    return command if ' --html' in command else command + ' --html page.html'


def page(answer, path):
    """The whole page as text."""
    verb = answer.at('/report/verb', str)
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(os.path.join(os.path.dirname(os.path.abspath(__file__)), 'templates')),
        autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    numbers = Numbers(answer)
    for name in ('number', 'text', 'texts', 'word', 'holds', 'action', 'failure', 'bar'):
        environment.globals[name] = getattr(numbers, name)
    template = environment.get_template(verb.replace(' ', '_') + '.html')
    text = template.render(answer=answer, verb=verb, command=command_again(answer),
                           pictures=pictures(answer, path), **PAGES[verb](answer))
    return re.sub(r'[ \t]+$', '', text, flags=re.MULTILINE) + '\n'
