"""The page of `hires_lab reproduce`: what each table and figure of the dissertation came to, with pictures."""

import math

import report_drawings as drawings
import report_plots as plots
from report_input import Answer, ReportError
from report_numbers import bars_of, values

GOOD, OPEN, NEUTRAL = 'good', 'open', 'neutral'
MARKS = {'reproduced': 'ok', 'better': 'ok', 'not reproduced': 'failed', 'undecided': 'warning', 'check holds': 'ok',
         'check fails': 'failed', 'check undecided': 'warning', 'shown': 'nothing', 'described': 'nothing',
         'not played': 'warning'}
PUBLISHED = ('reproduced', 'better', 'not reproduced', 'undecided')
CHECKS = ('check holds', 'check fails', 'check undecided')
SHARPEST = 0.1  # [m/s] slower than that no turn is looked at


class Item:
    """One table or figure: where it stands, and what its drawings need."""

    def __init__(self, answer, place):
        self.answer = answer
        self.place = place

    def id(self, drawing):
        """A name for the picture's parts that no other picture has."""
        return 'i%s-%s' % (self.place.split('/')[-1], ''.join(c if c.isalnum() else '-' for c in drawing))

    def play(self, name):
        """The answer of a play."""
        content = self.answer.at('/plays/%s/answer' % name, None)
        return Answer(content, '%s: play %s' % (self.answer.name, name))

    def published(self, pointer):
        """The published number beside the one at that place of the first play's answer, or None."""
        for value in self.answer.items(self.place + '/values'):
            if self.answer.at(value + '/at', str).split(':', 1)[1] == pointer and self.answer.has(value + '/published'):
                return self.answer.at(value + '/published', float)
        return None

    def values(self):
        """(name, published or None, found or None, whether accepted, or not judged) of its numbers."""
        rows = []
        for value in self.answer.items(self.place + '/values'):
            number = {field: self.answer.at('%s/%s' % (value, field), float)
                      if self.answer.has('%s/%s' % (value, field)) else None for field in ('published', 'found')}
            unit = self.answer.at(value + '/unit', str)
            rows.append((self.answer.at(value + '/name', str) + (' [%s]' % unit if unit else ''),
                         number['published'], number['found'],
                         self.answer.at(value + '/holds', bool) or not self.answer.at(value + '/judged', bool)))
        return rows


def _durations_of(answer, key):
    """Durations [s] of the runs of one row, 'fast EC1 ET2', that came to an end."""
    name, start, goal = key.split()
    values = []
    for row in answer.items('/rows'):
        who = answer.at(row + '/motion_set', str) or answer.at(row + '/action', str)
        is_row = (who, answer.at(row + '/from', str), answer.at(row + '/to', str)) == (name, start, goal)
        if is_row and answer.at(row + '/planner', str) == 'scene' and answer.at(row + '/action_finished', bool):
            values.append(answer.at(row + '/duration', float))
    if not values:
        raise ReportError('%s: no run of %r came to an end, or there is no such row' % (answer.name, key))
    return values


def _normality(item, play, argument):
    values = _durations_of(item.play(play), argument)
    centre, sigma = (item.published('/measures/%s_%s' % (what, argument.replace(' ', '_'))) for what in ('mean', 'sigma'))
    reference = None if centre is None or sigma is None else (centre, sigma)
    picture = plots.normality(item.id(argument), 'duration [s]', values, reference)
    return picture, '%s, %s to %s: %s.' % (*argument.split(), plots.normality_text(plots.normality_of(values)))


def _numbers(item, _, argument):
    """All numbers of the item beside the published ones; only those whose name begins with the argument."""
    rows = [row for row in item.values() if row[0].startswith(argument) and row[1] is not None]
    return (plots.compared(item.id('numbers' + argument), 'published (ring) and ours (dot)', rows),
            'Ring: published. Dot: ours; red where it is not as accepted.')


def _shares(item, _, argument):
    rows = [row for row in item.values() if row[0].startswith(argument)]
    drawn = [row for row in rows if (row[1] or 0) > 0 and (row[2] or 0) > 0]
    left_out = ' Not drawn, as it has no logarithm: %s.' % ', '.join(row[0] for row in rows if row not in drawn)
    return (plots.compared(item.id('shares' + argument), 'published (ring) and ours (dot), logarithmic', drawn,
                           logarithmic=True),
            'Ring: published. Dot: ours; red where it is not as accepted.' + (left_out if drawn != rows else ''))


def _torso_poses(item, play, argument):
    answer = item.play(play)
    rows = []
    for pose in answer.items('/poses'):
        field = '%s/%s/' % (pose, argument)
        torso = answer.at(pose + '/torso', str)
        rows.append(('%s, %s' % (torso, answer.at(pose + '/base', str)), answer.at(field + 'estimate', float),
                     answer.at(field + 'lower', float), answer.at(field + 'upper', float), 'down' in torso))
    what = argument.replace('_', ' ')
    return (drawings.intervals(item.id(argument), what, rows, percent=False),
            '%s over forms of things, 95 %% intervals. Dark: torso down.' % what.capitalize())


def _timeline(item, play, _):
    answer = item.play(play)
    return (drawings.timeline(item.id('timeline'), 'what was done when', bars_of(answer), answer.at('/duration', float)),
            'Imaginations above, steps below. Dotted line: when an imagined step began.')


def _arms(item, play, _):
    answer = item.play(play)
    rows = []
    for title, wanted in (('with imagination', True), ('without imagination', False)):
        values = [answer.at(run + '/duration', float) for run in answer.items('/list')
                  if answer.at(run + '/complete', bool) and answer.at(run + '/imagination', bool) == wanted]
        rows.append((title, values, [], wanted))
    return drawings.spreads(item.id('arms'), 'duration of runs that came to an end [s]', rows), ''


def _series(answer, place, *names):
    """Columns of a stretch of experiences, time first."""
    return [values(answer, '%s/%s' % (place, name)) for name in ('time', *names)]


def _where(answer, place):
    return '%s, %s' % (answer.at(place + '/run', str), answer.at(place + '/action', str))


def _tilt(item, play, argument):
    answer, place = item.play(play), '/pictures/' + argument
    if not answer.has(place):
        return None, ''
    time, alpha, v, a, j = _series(answer, place, 'alpha', 'v', 'a', 'j')
    rows = [('tilt [rad]', [('tilt', time, alpha)]), ('v [m/s]', [('v', time, v)]),
            ('a [m/s²]', [('a', time, a)]), ('j [m/s³]', [('j', time, j)])]
    marks = [(0, 0.01, 'shaking'), (0, 0.5, 'topple')] if max(alpha) > 0.4 else [(0, 0.01, 'shaking')]
    return (plots.lines(item.id('tilt' + argument), 'time [s]', rows, marks),
            'Tilt of the load with the thresholds of Eq. 5.1, and motion of the base: %s.' % _where(answer, place))


def _object(item, play, argument):
    answer, place = item.play(play), '/pictures/' + argument
    if not answer.has(place):
        return None, ''
    time, alpha, deviation, ov, oa, v, a, w = _series(answer, place, 'alpha', 'deviation', 'object_v', 'object_a',
                                                      'v', 'a', 'angular_v')
    rows = [('load v [m/s]', [('load', time, ov), ('base', time, v)]),
            ('a [m/s²]', [('load', time, oa), ('base', time, a)]), ('turning [rad/s]', [('base', time, w)]),
            ('tilt [rad]', [('tilt', time, alpha)]), ('deviation [m]', [('deviation', time, deviation)])]
    return (plots.lines(item.id('object' + argument), 'time [s]', rows),
            'Dynamics of load and base, and how far the load leaned and slid: %s.' % _where(answer, place))


def _sharpest_turn(x, y, v, w):
    """(x, y, radius, text) about which the base turned when it turned fastest on its way; or None.
    @param v, w  [m/s], [rad/s] magnitudes."""
    moving = [i for i in range(1, len(x) - 1) if v[i] > SHARPEST and w[i] > 0.0]
    if not moving:
        return None
    i = max(moving, key=lambda k: w[k])
    ahead, before = (x[i + 1] - x[i], y[i + 1] - y[i]), (x[i] - x[i - 1], y[i] - y[i - 1])
    length = math.hypot(ahead[0] + before[0], ahead[1] + before[1])
    if length == 0.0:
        return None
    side = 1.0 if before[0] * ahead[1] - before[1] * ahead[0] >= 0.0 else -1.0
    radius = v[i] / w[i]
    return (x[i] - side * radius * (ahead[1] + before[1]) / length,
            y[i] + side * radius * (ahead[0] + before[0]) / length, radius, 'r = %.2f m' % radius)


def _trace(item, play, argument):
    answer, place = item.play(play), '/pictures/drives/' + argument
    x, y, v, a, w = (values(answer, '%s/%s' % (place, name)) for name in ('x', 'y', 'v', 'a', 'angular_v'))
    turn = _sharpest_turn(x, y, v, w)
    return (plots.trace(item.id('trace' + argument), 'x, y in the map [m]', x, y, v, a, [turn] if turn else []),
            'Width: speed. Green: it speeds up; red: it slows down. Circle: centre and radius (v over angular velocity) '
            'of the base\'s turning when it turned fastest. %s.' % _where(answer, place))


def _falls(item, play, _):
    """Where on the map loads fell, on the ways that were driven."""
    answer = item.play(play)
    ways = [(values(answer, place + '/x'), values(answer, place + '/y')) for place in answer.keys('/pictures/drives')]
    x, y = (values(answer, '/pictures/falls/' + name) for name in ('x', 'y'))
    return (plots.places(item.id('falls'), 'x, y in the map [m]', list(zip(x, y)), ways),
            'Where the base was when a load fell: %d falls. Lines: the longest drive of each motion set.' % len(x))


def _speed(item, play, _):
    answer, rows = item.play(play), []
    for place in answer.keys('/pictures/drives'):
        time, v = _series(answer, place, 'v')
        rows.append((place.split('/')[-1] + ' v [m/s]', [('v', time, v)]))
    return plots.lines(item.id('speed'), 'time [s]', rows), 'The longest drive of each motion set.'


def _density(item, play, argument):
    answer = item.play(play)
    curves = [(place.split('/')[-1], values(answer, place + '/edges'), values(answer, place + '/density'))
              for place in answer.keys('/pictures/distributions/' + argument)]
    return (plots.densities(item.id(argument), argument.replace('_', ' '), curves),
            'Density over all parts, logarithmic; the outermost bins hold what lies beyond them.')


LABELS = {'v': 'v [m/s]', 'a': 'a [m/s²]', 'j': 'j [m/s³]', 'angular_v': 'turning [rad/s]',
          'angular_a': 'turning acceleration [rad/s²]', 'alpha': 'tilt [rad]', 'deviation': 'deviation [m]'}


def _cloud(item, play, argument):
    """Points of one quantity over another: 'a' (tilt over it), 'a v'."""
    answer = item.play(play)
    over, what = (argument.split(' ') + ['alpha'])[:2]
    points = list(zip(values(answer, '/pictures/points/' + over),
                      values(answer, '/pictures/points/' + what)))
    if what == 'alpha':
        points = [point for point in points if point[1] < 0.5]  # what lies is no deviation any more
    return (plots.scatter(item.id('cloud' + argument), (LABELS[over], LABELS[what]), points),
            '%d of all parts, evenly chosen%s.' %
            (len(points), '; those that lie are left out' if what == 'alpha' else ''))


def _roc(item, play, _):
    answer = item.play(play)
    rows = []
    for place in answer.items('/prediction/features'):
        field = place + '/area/'
        rows.append((answer.at(place + '/feature', str), answer.at(field + 'estimate', float),
                     answer.at(field + 'lower', float), answer.at(field + 'upper', float),
                     answer.at(field + 'lower', float) > 0.5))
    return (drawings.intervals(item.id('roc'), 'area under the ROC curve, 0.5 s ahead', rows, percent=False,
                               wanted=(0.5, 'chance')),
            '%d falls; 95 %% intervals over runs. Dark: better than chance.' % answer.at('/prediction/falls', int))


def _roc_curves(item, play, _):
    answer, curves = item.play(play), []
    for place in answer.items('/prediction/features'):
        curves.append((answer.at(place + '/feature', str), values(answer, place + '/roc/false_alarms'),
                       values(answer, place + '/roc/hits')))
    return (plots.curves(item.id('curves'), ('calm windows that it calls falls', 'falls that it foretells'), curves),
            '%d falls, %d calm windows, both motion sets together. Dashed: chance.' %
            (answer.at('/prediction/falls', int), answer.at('/prediction/calm_windows', int)))


def _filters(item, play, _):
    answer = item.play(play)
    rows = []
    for place in answer.items('/filter_trial/filters'):
        field = place + '/separation/'
        name = '%s, %s; error of a %.3f m/s², delay %.3f s' % (
            answer.at(place + '/filter', str), 'causal' if answer.at(place + '/causal', bool) else 'zero phase',
            answer.at(place + '/rms_error/a', float), answer.at(place + '/delay', float))
        rows.append((name, answer.at(field + 'estimate', float), answer.at(field + 'lower', float),
                     answer.at(field + 'upper', float), not answer.at(place + '/causal', bool)))
    return (drawings.intervals(item.id('filters'), 'shaking told from not toppling by |a|: area under the curve', rows,
                               percent=False, wanted=(0.5, 'chance')),
            'The base measured with %g m of white noise; window %d samples, from the autocorrelation.' %
            (answer.at('/filter_trial/noise', float), answer.at('/filter_trial/window', int)))


def _ladder(item, play, _):
    answer = item.play(play)
    rows = []
    for place in answer.items('/rungs'):
        field = place + '/ratio/'
        if not all(answer.has(field + end) for end in ('estimate', 'lower', 'upper')):
            continue
        rows.append((answer.at(place + '/title', str), answer.at(field + 'estimate', float),
                     max(answer.at(field + 'lower', float), 1e-3), answer.at(field + 'upper', float),
                     answer.at(field + 'lower', float) > 1.0))
    return (drawings.intervals(item.id('ladder'), 'speed after the step / before, logarithmic', rows, percent=False,
                               wanted=(1.0, 'no gain'), logarithmic=True),
            'Dot: estimate. Bar: its 95 % interval. Dark: it makes faster.')


def _choices(item, play, _):
    answer = item.play(play)
    rows = [('%s, choice %d: %s' % (answer.at(place + '/group', str), answer.at(place + '/choice', int),
                                    '; '.join(answer.at(member, str) for member in answer.items(place + '/members'))),
             answer.at(place + '/share', float), answer.at(place + '/lower', float),
             answer.at(place + '/upper', float), True) for place in answer.items('/shares')]
    return (drawings.intervals(item.id('choices'), 'runs that succeed [%], 95 % intervals', rows),
            'By arrangement. Bar: Wilson\'s interval.')


DRAWINGS = {'tilt': _tilt, 'object': _object, 'trace': _trace, 'speed': _speed, 'density': _density, 'cloud': _cloud,
            'falls': _falls, 'roc': _roc, 'roc_curves': _roc_curves, 'filters': _filters, 'ladder': _ladder,
            'choices': _choices, 'normality': _normality, 'numbers': _numbers, 'shares': _shares,
            'torso_poses': _torso_poses, 'timeline': _timeline, 'arms': _arms}
BROAD = {'normality', 'timeline', 'tilt', 'object', 'speed'}


def pictures_of(answer, place):
    """(picture, caption, whether it is broad) of an item's drawings; none where a play is missing. Where the
    answer has too little to draw, picture is None and the caption says which drawing it is.
    @raise ReportError for a drawing that is unknown."""
    item = Item(answer, place)
    found = []
    for drawing in answer.items(place + '/drawings'):
        play, name, argument = (answer.at(drawing, str).split(':', 2) + [''])[:3]
        if not answer.has('/plays/' + play):
            continue
        if name not in DRAWINGS:
            raise ReportError('%s: field %s: there is no drawing %r; there are %s' %
                              (answer.name, drawing, name, ', '.join(sorted(DRAWINGS))))
        picture, caption = DRAWINGS[name](item, play, argument)
        if not picture:
            caption = 'Not drawn, for the answer has too little for it: %s. %s' % (answer.at(drawing, str), caption)
        found.append((picture, caption, name in BROAD))
    return found


def _share(good, all_of, text, undecided):
    """'8 of 9 checks hold, 1 is undecided'."""
    more = ', %d %s undecided' % (undecided, 'is' if undecided == 1 else 'are') if undecided else ''
    return '%d of %d %s%s' % (good, all_of, text, more)


def _headline(verdicts):
    """(what all verdicts come to, the state of that, what checks come to unless that is said already)."""
    counts = {verdict: verdicts.count(verdict) for verdict in MARKS}
    published, checks = (sum(counts[verdict] for verdict in kind) for kind in (PUBLISHED, CHECKS))
    good = counts['reproduced'] + counts['better']
    holding = _share(counts['check holds'], checks, 'checks by bounds of our own hold', counts['check undecided'])
    if published:
        text = _share(good, published, 'published results with numbers are reproduced or better', counts['undecided'])
    elif checks:
        text = 'No published number is judged here; ' + holding
    else:
        text = 'Nothing here is judged: no published number, no check of our own'
    if counts['not played']:
        text += '; %d %s not played' % (counts['not played'], 'was' if counts['not played'] == 1 else 'were')
    is_open = good < published or counts['check holds'] < checks or counts['not played']
    state = OPEN if is_open else GOOD if published or checks else NEUTRAL
    return text, state, holding if published and checks else ''


def reproduce(answer):
    """What the template needs."""
    items = answer.items('/items')
    verdicts = [answer.at(item + '/verdict', str) for item in items]
    headline, state, checks = _headline(verdicts)
    plays = answer.keys('/plays')
    foreign = [play for play in plays if not answer.at(play + '/this_build', bool)]
    chapters = {}
    for item in items:
        chapters.setdefault(answer.at(item + '/section', str).split('.')[0], []).append(item)
    return {
        'headline': headline,
        'build': 'played with this version' if not foreign else
                 '%d of %d answers by another build of this version (--again plays them anew)' % (len(foreign), len(plays)),
        'checks': checks,
        'state': state,
        'chapters': [('Appendix ' + name if name.isalpha() else 'Chapter ' + name, chapters[name])
                     for name in sorted(chapters)],
        'mark': lambda item: MARKS.get(answer.at(item + '/verdict', str), 'nothing'),
        'drawn': lambda item: pictures_of(answer, item),
        'counted': [(verdict, verdicts.count(verdict)) for verdict in MARKS if verdict in verdicts],
        'anchor': lambda item: 'item-' + item.split('/')[-1],
    }
