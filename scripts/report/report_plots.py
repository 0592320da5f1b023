"""Pictures of what was reproduced: numbers beside the published ones, distributions, shares."""

import math

from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter
from numpy import linspace, mean, std
from scipy import stats

import report_drawings as drawings
from report_drawings import BEST, GRID, IMAGINED, INK, OTHER, QUIET, WIDTH


def _dot(axes, x, y, filled, colour):
    axes.plot([x], [y], 'o', color=colour, markersize=6, markerfacecolor=colour if filled else 'white',
              zorder=3, clip_on=False)


@drawings.styled
def compared(name, label, rows, logarithmic=False):
    """Ours and the published number of each row on one axis, a line between.
    @param rows  (text, published or None, found or None, whether it is as accepted)."""
    rows = [row for row in rows if row[1] is not None or row[2] is not None][:drawings.MOST_ROWS]
    if logarithmic:
        rows = [row for row in rows if (row[1] or 0) > 0 and (row[2] or 0) > 0]
    if not rows:
        return None
    figure, axes = drawings.figure_of_rows(len(rows), 0.40)
    for i, (text, published, found, holds) in enumerate(rows):
        y = len(rows) - 1 - i
        drawings.label_row(axes, y, text)
        if published is not None and found is not None:
            axes.plot([published, found], [y, y], color=QUIET if holds else IMAGINED, linewidth=1.2)
        if published is not None:
            _dot(axes, published, y, False, INK)
        if found is not None:
            _dot(axes, found, y, True, BEST if holds else IMAGINED)
    if logarithmic:
        axes.set_xscale('log')
        axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: '%g' % value))
    axes.set_ylim(-0.5, len(rows) - 0.15)
    axes.set_xlabel(label)
    return drawings.svg(figure, name, label)


def _beside(height=2.6):
    """Two plots side by side."""
    figure = Figure(figsize=(1.7 * WIDTH, height))
    left = figure.add_axes([0.07, 0.19, 0.40, 0.74])
    right = figure.add_axes([0.57, 0.19, 0.40, 0.74])
    for axes in (left, right):
        axes.grid(True, color=GRID, linewidth=0.6)
        axes.set_axisbelow(True)
    return figure, left, right


def normality_of(values):
    """What is said of a sample: size, mean, deviation (1/N), Shapiro-Wilk and Anderson-Darling against a
    normal distribution whose mean and deviation are the sample's; tests need values that differ."""
    told = {'n': len(values), 'mean': float(mean(values)), 'sigma': float(std(values))}
    if len(values) >= 3 and told['sigma'] > 0.0:
        shapiro = stats.shapiro(values)
        anderson = stats.anderson(values, 'norm')
        told.update(w=float(shapiro.statistic), p=float(shapiro.pvalue), a2=float(anderson.statistic),
                    a2_limit=float(anderson.critical_values[2]))
    return told


def normality_text(told):
    text = '%d runs, %.2f ± %.2f s (sigma by 1/N)' % (told['n'], told['mean'], told['sigma'])
    if 'w' not in told:
        return text + '; too few values differ for a test'
    verdict = 'rejects' if told['a2'] > told['a2_limit'] else 'does not reject'
    return text + '; Shapiro-Wilk W %.3f, p %.2g; Anderson-Darling A² %.2f, which %s a normal distribution at ' \
                  '5 %% (limit %.2f)' % (told['w'], told['p'], told['a2'], verdict, told['a2_limit'])


@drawings.styled
def normality(name, label, values, reference=None):
    """Histogram with fitted normal and kernel density; quantiles against those of a normal distribution.
    @param reference  (mean, sigma) of a published sample, drawn dashed."""
    if len(values) < 3 or std(values) == 0.0:
        return None
    figure, left, right = _beside()
    centre, sigma = mean(values), std(values)
    low, high = min(values), max(values)
    if reference:
        low, high = min(low, reference[0] - 2.5 * reference[1]), max(high, reference[0] + 2.5 * reference[1])
    margin = 0.08 * (high - low)
    x = linspace(low - margin, high + margin, 200)
    left.hist(values, bins='fd' if len(values) > 8 else 5, density=True, color=OTHER, edgecolor='white')
    left.plot(x, stats.norm.pdf(x, centre, sigma), color=INK, linewidth=1.4, label='fitted normal')
    left.plot(x, stats.gaussian_kde(values)(x), color=BEST, linewidth=1.4, label='density')
    if reference and reference[1] > 0.0:
        left.plot(x, stats.norm.pdf(x, *reference), color=IMAGINED, linewidth=1.0, linestyle='--',
                  label='published')
    left.set_xlabel(label)
    left.legend(fontsize=7, frameon=False)
    (quantiles, ordered), (slope, start, _) = stats.probplot(values)
    right.plot(quantiles, ordered, 'o', color=BEST, markersize=3.5)
    right.plot(quantiles, slope * quantiles + start, color=INK, linewidth=1.0)
    right.set_xlabel('standard normal quantile')
    right.set_ylabel(label)
    return drawings.svg(figure, name, label)


@drawings.styled
def densities(name, label, curves):
    """Histograms as lines over one axis.  @param curves  (text, edges, heights)."""
    curves = [curve for curve in curves if curve[2] and max(curve[2]) > 0]
    if not curves:
        return None
    figure = Figure(figsize=(WIDTH, 2.5))
    axes = figure.add_axes([0.10, 0.20, 0.86, 0.74])
    axes.grid(True, color=GRID, linewidth=0.6)
    colours = [BEST, IMAGINED, OTHER, INK]
    for i, (text, edges, heights) in enumerate(curves):
        axes.stairs(heights, edges, color=colours[i % len(colours)], linewidth=1.3, label=text)
    axes.set_xlabel(label)
    axes.set_yscale('log')
    axes.legend(fontsize=7, frameon=False)
    return drawings.svg(figure, name, label)


@drawings.styled
def lines(name, label, rows, marks=()):
    """Rows of lines over one time, each with an axis of its own.
    @param rows   (text of the axis, [(text, times, values)]).
    @param marks  (row, value, text) of lines across a row."""
    rows = [row for row in rows if any(curve[1] for curve in row[1])]
    if not rows:
        return None
    figure = Figure(figsize=(1.5 * WIDTH, 0.5 + 1.25 * len(rows)))
    colours = [BEST, IMAGINED, OTHER, INK]
    below = 0.42 / figure.get_figheight()
    height = (1.0 - below - 0.02) / len(rows)
    for i, (text, curves) in enumerate(rows):
        axes = figure.add_axes([0.10, below + (len(rows) - 1 - i) * height, 0.88, 0.86 * height])
        axes.grid(True, color=GRID, linewidth=0.6)
        for k, (title, times, values) in enumerate(curves):
            axes.plot(times, values, color=colours[k % len(colours)], linewidth=1.0, label=title)
        for row, value, title in marks:
            if row == i:
                axes.axhline(value, color=QUIET, linewidth=0.9, linestyle='--')
                axes.annotate(title, (0.005, value), xycoords=('axes fraction', 'data'), fontsize=7, va='bottom')
        axes.set_ylabel(text, fontsize=7.5)
        axes.tick_params(labelsize=7, labelbottom=i == len(rows) - 1)
        if len(curves) > 1:
            axes.legend(fontsize=6.5, frameon=False, loc='upper right', ncol=len(curves))
    axes.set_xlabel(label)
    return drawings.svg(figure, name, label)


@drawings.styled
def trace(name, label, x, y, speed, acceleration, discs=()):
    """Where the base went: the line's width is its speed, its colour its acceleration, green where it
    speeds up, red where it slows down.  @param discs  (x, y, radius, text) drawn as circles."""
    if len(x) < 2:
        return None
    figure = Figure(figsize=(WIDTH, WIDTH))
    axes = figure.add_axes([0.11, 0.11, 0.86, 0.86])
    axes.set_aspect('equal', adjustable='datalim')
    axes.grid(True, color=GRID, linewidth=0.6)
    most = max(max(abs(a) for a in acceleration), 1e-9)
    fastest = max(max(speed), 1e-9)
    for i in range(len(x) - 1):
        if math.hypot(x[i + 1] - x[i], y[i + 1] - y[i]) > 0.5:
            continue  # it was put elsewhere
        share = acceleration[i] / most
        colour = (0.2, 0.55 + 0.25 * share, 0.35) if share >= 0 else (0.75, 0.35 * (1 + share), 0.25)
        axes.plot(x[i:i + 2], y[i:i + 2], color=colour, linewidth=0.6 + 3.0 * speed[i] / fastest,
                  solid_capstyle='round')
    for cx, cy, radius, text in discs:
        angles = linspace(0.0, 2.0 * math.pi, 60)
        axes.plot([cx + radius * math.cos(a) for a in angles], [cy + radius * math.sin(a) for a in angles],
                  color=IMAGINED, linewidth=1.0)
        axes.annotate(text, (cx, cy), fontsize=6.5, ha='center')
    axes.set_xlabel(label)
    return drawings.svg(figure, name, label)


@drawings.styled
def places(name, label, points, ways):
    """Points on a map, beside ways (xs, ys)."""
    if not points:
        return None
    figure = Figure(figsize=(WIDTH, WIDTH))
    axes = figure.add_axes([0.11, 0.11, 0.86, 0.86])
    axes.set_aspect('equal', adjustable='datalim')
    axes.grid(True, color=GRID, linewidth=0.6)
    for xs, ys in ways:
        axes.plot(xs, ys, color=QUIET, linewidth=0.9)
    axes.plot([p[0] for p in points], [p[1] for p in points], 'x', color=IMAGINED, markersize=5)
    axes.set_xlabel(label)
    return drawings.svg(figure, name, label)


@drawings.styled
def curves(name, labels, rows):
    """Curves in the unit square with its diagonal.  @param rows  (text, xs, ys)."""
    if not rows:
        return None
    figure = Figure(figsize=(WIDTH, WIDTH))
    axes = figure.add_axes([0.12, 0.11, 0.85, 0.86])
    axes.grid(True, color=GRID, linewidth=0.6)
    axes.plot([0, 1], [0, 1], color=QUIET, linewidth=0.9, linestyle='--')
    for i, (text, xs, ys) in enumerate(rows):
        axes.plot(xs, ys, color=[BEST, IMAGINED, OTHER, INK][i % 4], linestyle='-' if i < 4 else ':',
                  linewidth=1.2, label=text)
    axes.legend(fontsize=6.5, frameon=False, loc='lower right')
    axes.set_xlabel(labels[0])
    axes.set_ylabel(labels[1])
    return drawings.svg(figure, name, labels[0])


@drawings.styled
def scatter(name, labels, points, limit=None):
    """Points in the plane.  @param labels  of both axes.  @param limit  (value of y, text)."""
    if not points:
        return None
    figure = Figure(figsize=(WIDTH, 2.8))
    axes = figure.add_axes([0.12, 0.18, 0.85, 0.78])
    axes.grid(True, color=GRID, linewidth=0.6)
    axes.plot([p[0] for p in points], [p[1] for p in points], '.', color=BEST, markersize=2.2, alpha=0.6,
              rasterized=False)
    if limit:
        axes.axhline(limit[0], color=IMAGINED, linewidth=0.9, linestyle='--')
        axes.annotate(limit[1], (0.01, limit[0]), xycoords=('axes fraction', 'data'), fontsize=7, va='bottom')
    axes.set_xlabel(labels[0])
    axes.set_ylabel(labels[1])
    return drawings.svg(figure, name, labels[0])
