"""Pictures of a report, as SVG for the page or PNG. Equal numbers give equal bytes."""

import io
import re

import matplotlib
from markupsafe import Markup, escape
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import FixedLocator, FuncFormatter, MaxNLocator, NullLocator
from numpy import geomspace, histogram, linspace

INK, QUIET, GRID = '#1d2b36', '#8a97a3', '#dfe4e8'
BEST, OTHER = '#1f5f8b', '#9db4c6'
STEP, IMAGINED, IMAGINATION, FAILED = '#8fa8c8', '#c0392b', '#e07b6f', '#555555'
WIDTH = 5.0  # [in]
MOST_ROWS = 24  # of one picture; the table beside it has all
BINS = 48

STYLE = {'svg.fonttype': 'none', 'svg.hashsalt': 'hires', 'font.family': 'DejaVu Sans', 'font.size': 9,
         'text.color': INK, 'axes.labelcolor': INK, 'xtick.color': INK, 'ytick.color': INK,
         'axes.edgecolor': QUIET, 'axes.linewidth': 0.6, 'axes.spines.top': False,
         'axes.spines.right': False, 'axes.spines.left': False}


def figure_of_rows(rows, row_height, width=WIDTH):
    figure = Figure(figsize=(width, 0.62 + row_height * rows))
    axes = figure.add_axes([0.022, 0.46 / figure.get_figheight(), 0.94,
                            1.0 - 0.54 / figure.get_figheight()])
    axes.set_yticks([])
    axes.set_axisbelow(True)
    axes.xaxis.grid(True, color=GRID, linewidth=0.6)
    return figure, axes


def svg(figure, name, label):
    """The picture as a part of the page: its ids are its own, and no other file is named in it."""
    text = io.StringIO()
    figure.savefig(text, format='svg', metadata={'Date': None, 'Creator': None, 'Format': None, 'Type': None})
    drawn = text.getvalue()
    drawn = re.sub(r'<metadata>.*?</metadata>\s*', '', drawn[drawn.index('<svg'):], flags=re.DOTALL)
    drawn = re.sub(r'\bid="', 'id="%s-' % name, drawn)
    drawn = re.sub(r'(url\(#|xlink:href="#)', r'\g<1>%s-' % name, drawn)
    drawn = re.sub(r'<svg ', '<svg role="img" aria-label="%s" ' % escape(label), drawn, count=1)
    drawn = re.sub(r' (?:width|height)="[\d.]+pt"', '', drawn, count=2)
    return Markup(re.sub(r'[ \t]+\n', '\n', drawn))


def styled(function):
    """Under this module's style, whatever a user's own is."""
    def with_style(*arguments, **options):
        with matplotlib.rc_context():
            matplotlib.rcdefaults()
            matplotlib.rcParams.update(STYLE)
            return function(*arguments, **options)
    return with_style


def _shortened(text, most):
    return text if len(text) <= most else text[:most - 3] + '...'


def label_row(axes, y, text, most=68):
    axes.annotate(_shortened(text, most), (0, y), xycoords=('axes fraction', 'data'), xytext=(0, 5),
                  textcoords='offset points', va='bottom', fontsize=8.5)


@styled
def intervals(name, label, rows, percent=True, wanted=None, logarithmic=False):
    """A line for each interval, a dot at its estimate.
    @param rows  (text, estimate, lower, upper, whether it stands out).
    @param wanted  (value, text) of a line across all."""
    rows = rows[:MOST_ROWS]
    figure, axes = figure_of_rows(len(rows), 0.42)
    factor = 100.0 if percent else 1.0
    for i, (text, estimate, lower, upper, stands_out) in enumerate(rows):
        y = len(rows) - 1 - i
        colour = BEST if stands_out else OTHER
        label_row(axes, y, text)
        axes.plot([factor * lower, factor * upper], [y, y], color=colour, linewidth=4.5,
                  solid_capstyle='butt')
        axes.plot([factor * estimate], [y], 'o', color=INK, markersize=5, zorder=3, clip_on=False)
    if wanted:
        axes.axvline(factor * wanted[0], color=FAILED, linewidth=1.0, linestyle=(0, (4, 3)))
        axes.annotate(wanted[1], (factor * wanted[0], -0.62), fontsize=8, va='bottom', xytext=(4, 0),
                      textcoords='offset points')
    if logarithmic:
        axes.set_xscale('log')
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: '%g' % value))
    if percent and all(row[2] >= 0.0 for row in rows):
        axes.set_xlim(0, 100)
    axes.set_ylim(-0.65, len(rows) - 0.2)
    axes.set_xlabel(label)
    return svg(figure, name, label)


def _edges(rows, logarithmic):
    values = [value for row in rows for value in row[1]]
    if logarithmic:
        positive = [value for value in values if value > 0.0] or [1.0]
        lowest, highest = min(positive), max(positive)
        return geomspace(lowest / 1.05, highest * 1.05, BINS + 1)
    lowest, highest = min(values), max(values)
    margin = 0.02 * (highest - lowest) or max(0.5, 0.02 * abs(highest))
    return linspace(lowest - margin, highest + margin, BINS + 1)


def _use_logarithm(axes, edges):
    """Ticks that are read as numbers: 0.01, 0.02, 0.05, ..."""
    ticks = [digit * 10.0 ** power for power in range(-12, 7) for digit in (1, 2, 5)]
    shown = [tick for tick in ticks if edges[0] <= tick <= edges[-1]]
    axes.set_xscale('log')
    axes.xaxis.set_major_locator(FixedLocator(shown[::max(1, round(len(shown) / 8))]))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: '%g' % value))
    axes.xaxis.set_minor_locator(NullLocator())


@styled
def spreads(name, label, rows, logarithmic=False):
    """A histogram for each row over one axis; full height is the row's fullest bin.
    @param rows  (text, values, marks, whether it stands out); marks are drawn across their row.
    @return nothing where there are no values."""
    rows = [row for row in rows if row[1]][:MOST_ROWS]
    if not rows:
        return None
    figure, axes = figure_of_rows(len(rows), 0.68)
    edges = _edges(rows, logarithmic)
    for i, (text, values, marks, stands_out) in enumerate(rows):
        y = len(rows) - 1 - i
        shown = [max(value, edges[0]) for value in values]
        counts, _ = histogram(shown, edges)
        axes.stairs(y + 0.62 * counts / counts.max(), edges, baseline=y, fill=True,
                    color=BEST if stands_out else OTHER)
        axes.plot([edges[0], edges[-1]], [y, y], color=QUIET, linewidth=0.6)
        for mark, style in zip(marks, ('-', (0, (2, 2)))):
            axes.plot([max(mark, edges[0])] * 2, [y, y + 0.66], color=INK, linewidth=1.2, linestyle=style)
        axes.annotate(_shortened(text, 68), (0, y + 0.66), xycoords=('axes fraction', 'data'),
                      va='bottom', fontsize=8.5)
    if logarithmic:
        _use_logarithm(axes, edges)
    axes.set_xlim(edges[0], edges[-1])
    axes.set_ylim(-0.1, len(rows) - 0.02)
    axes.set_xlabel(label)
    return svg(figure, name, label)


@styled
def counts(name, label, rows):
    """A bar for each count.  @param rows  (text, count, whether it stands out)."""
    if not rows:
        return None
    rows = rows[:MOST_ROWS]
    figure, axes = figure_of_rows(len(rows), 0.42)
    for i, (text, count, stands_out) in enumerate(rows):
        y = len(rows) - 1 - i
        label_row(axes, y, '%s: %d' % (text, count))
        axes.barh(y, count, height=0.24, color=BEST if stands_out else OTHER)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.set_xlim(0, 1.02 * max(1, max(row[1] for row in rows)))
    axes.set_ylim(-0.4, len(rows) - 0.2)
    axes.set_xlabel(label)
    return svg(figure, name, label)


def _colour(bar, imagined):
    if bar['kind'] == 'imagination':
        return IMAGINATION
    if bar['outcome'] == 'failed':
        return FAILED
    return IMAGINED if (bar['plan'], bar['index']) in imagined else STEP


def _timeline(bars, duration):
    imagined = {(bar['plan'], bar['index']) for bar in bars if bar['kind'] == 'imagination'}
    figure, axes = figure_of_rows(len(bars), 0.36, 8.6)
    for i, bar in enumerate(bars):
        y = len(bars) - 1 - i
        head = 'imagine ' if bar['kind'] == 'imagination' else ''
        label_row(axes, y, '%s%s: %s, %.1f s' % (head, _shortened(bar['action'], 80), bar['outcome'],
                                                  bar['end'] - bar['begin']), most=120)
        axes.barh(y, max(bar['end'] - bar['begin'], 0.002 * duration), left=bar['begin'], height=0.26,
                  color=_colour(bar, imagined))
        if bar['dispatch'] is not None:
            axes.axvline(bar['dispatch'], color=IMAGINED, linewidth=0.7, linestyle=':')
    axes.set_xlim(0, 1.01 * max(duration, 1.0))
    axes.set_ylim(-0.4, len(bars) - 0.1)
    axes.set_xlabel('time since the task began [s]')
    kinds = [('imagination', IMAGINATION), ('imagined step', IMAGINED), ('step', STEP)]
    if any(bar['outcome'] == 'failed' and bar['kind'] == 'step' for bar in bars):
        kinds.append(('failed step', FAILED))
    axes.legend(handles=[Patch(color=colour, label=text) for text, colour in kinds], fontsize=8,
                loc='upper right', framealpha=1.0, edgecolor=GRID)
    return figure


@styled
def timeline(name, label, bars, duration):
    """What was done when, after the dissertation's Fig. 6.13: imaginations above, a dotted line where
    the step begins that one was about."""
    return svg(_timeline(bars, duration), name, label) if bars else None


@styled
def timeline_png(bars, duration):
    """The same as PNG bytes."""
    picture = io.BytesIO()
    _timeline(bars, duration).savefig(picture, format='png', dpi=120, metadata={'Software': None})
    return picture.getvalue()
