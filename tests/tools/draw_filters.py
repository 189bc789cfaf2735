# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
#
# measure_filter ../shared/data/blender 20 > filters.txt
# python3 draw_filters.py filters.txt docs/figures/filters.svg
#
# Draws the errors of filters that benchmarks/measure_filter prints: walk, jump and reach
# with white noise of 1 and 3 mm. A bar ends at the mean over
# channels, its thin line at the worst channel.
import pathlib
import re
import sys

ROWS = [(clip, mm) for clip in ("walk", "jump", "reach") for mm in (1, 3)]
FILTERS = [  # Name in the table, in the figure, colour.
    ("GCV, joint", "smoothing spline (default)", "#0b6e99"),
    ("Yu", "Yu's cut-off", "#7a9a3a"),
    ("Winter", "Winter's cut-off", "#c28a1e"),
    ("6 Hz", "6 Hz", "#9a9a9a"),
]
BAR_MEAN, BAR_WORST = 1.2, 1.6

WIDTH, LEFT, RIGHT, TOP = 720, 96, 44, 62
BAR, GAP = 11, 16  # Thickness of a bar, distance between rows. [px]
LOWEST, HIGHEST = 0.95, 3.1


def read_table(text):
    """{(clip, mm): {filter: (mean, worst channel)}, with white noise only."""
    table, row = {}, None
    for line in text.splitlines():
        head = re.match(r"(.+), (\d) mm(, correlation.*)?: oracle", line)
        if head:
            row = None if head[3] else table.setdefault((head[1], int(head[2])), {})
        figures = re.match(r"(.+?)  +([\d.]+) +([\d.]+) +([\d.]+) *$", line)
        if figures and row is not None:
            row[figures[1]] = (float(figures[2]), float(figures[3]))
    return table


def x_of(ratio):
    return LEFT + (ratio - LOWEST) / (HIGHEST - LOWEST) * (WIDTH - LEFT - RIGHT)


def text(x, y, words, more=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" {more}>{words}</text>'


def line(x, top, bottom, more):
    return f'<line x1="{x:.1f}" x2="{x:.1f}" y1="{top}" y2="{bottom}" {more}/>'


def draw_scale(height):
    parts = []
    bottom = height - 34
    for tenth in range(10, 31, 5):
        x = x_of(tenth / 10)
        parts.append(line(x, TOP, bottom, 'stroke="#dddddd"'))
        parts.append(text(x, bottom + 15, f"{tenth / 10:g}", 'text-anchor="middle"'))
    parts.append(line(x_of(1), TOP, bottom, 'stroke="#222222"'))
    for ratio, words, anchor in ((BAR_MEAN, "limit of the mean", "end"),
                                 (BAR_WORST, "limit of the worst channel", "start")):
        parts.append(line(x_of(ratio), TOP - 4, bottom, 'stroke="#b03030" stroke-dasharray="4 3"'))
        parts.append(text(x_of(ratio), TOP - 8, words, f'text-anchor="{anchor}" fill="#b03030"'))
    parts.append(text(LEFT, height - 6, "Error over that of the best cut-off, which knows the "
                      "truth: mean, and worst of twelve channels"))
    return parts


def draw_row(y, figures):
    parts = []
    for i, (name, _, colour) in enumerate(FILTERS):
        mean, worst = figures[name]
        top = y + i * BAR
        middle = top + BAR / 2 - 0.5
        parts.append(f'<rect x="{x_of(min(mean, 1)):.1f}" y="{top}" height="{BAR - 2}" '
                     f'fill="{colour}" width="{abs(x_of(mean) - x_of(1)):.1f}"/>')
        parts.append(f'<path d="M{x_of(mean):.1f} {middle}H{x_of(worst):.1f}" stroke="{colour}" '
                     'stroke-width="1.5"/>')
        parts.append(line(x_of(worst), top, top + BAR - 2, f'stroke="{colour}" stroke-width="2"'))
        parts.append(text(x_of(worst) + 5, top + BAR - 2.5, f"{mean:.2f} ({worst:.2f})",
                          'font-size="9.5" stroke="#ffffff" stroke-width="3" '
                          'paint-order="stroke"'))
    return parts


def draw(table):
    step = len(FILTERS) * BAR + GAP
    height = TOP + len(ROWS) * step + 38
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" '
             f'width="{WIDTH}" height="{height}" font-family="sans-serif" font-size="12" '
             'fill="#222222">', '<rect width="100%" height="100%" fill="#ffffff"/>']
    x = LEFT
    for _, name, colour in FILTERS:
        parts.append(f'<rect x="{x}" y="14" width="11" height="11" fill="{colour}"/>')
        parts.append(text(x + 16, 24, name))
        x += 40 + 6.6 * len(name)
    parts += draw_scale(height)
    for i, (clip, mm) in enumerate(ROWS):
        y = TOP + GAP // 2 + i * step
        parts.append(text(LEFT - 8, y + step / 2 - 4, f"{clip}, {mm} mm", 'text-anchor="end"'))
        parts += draw_row(y, table[clip, mm])
    return "\n".join([*parts, "</svg>\n"])


def main():
    source, out = map(pathlib.Path, sys.argv[1:3])
    table = read_table(source.read_text())
    missing = [row for row in ROWS if any(name not in table.get(row, {}) for name, *_ in FILTERS)]
    if missing:
        sys.exit(f"{source}: no figures of {missing}; is this the output of measure_filter?")
    out.write_text(draw(table))


main()
