#!/usr/bin/env python3
# SPDX-FileCopyrightText: The marey authors
# SPDX-License-Identifier: Apache-2.0
"""Shows what is in a motion library: how fast the hips and hands move per content, and a
map of its windows of 2 s, where similar motions are close together.

    PYTHONPATH=python python3 examples/library_statistics.py LIB [--by content] [--to map.png]

Needs NumPy. With matplotlib (apt-get install python3-matplotlib) it draws a picture; it
prints a table in any case. --by is the key of the labels that clips are grouped by: labels
"content:walk" have the key content. Nothing is trained: the map has the two principal
components of the library's own features (docs/formats/library.md).
"""
import argparse
import sys
from collections import defaultdict

import numpy as np

from marey_library import FEATURE_RATE_HZ, Library, LibraryError

WINDOW = 21  # Instants of 0.1 s.
STEP = 5
DPI = 110
MAX_GROUPS = 12  # That have a colour; the others are grey.


def group_of(clip, key):
    """Returns the value of the first label KEY:VALUE of a clip."""
    for label in clip.labels:
        if label.startswith(key + ":"):
            return label[len(key) + 1:]
    return "(none)"


def speeds(library, clip):
    """Returns the median level speed of the hips, and the 95 % quantile of the faster
    hand's speed relative to the hips, in m/s."""
    motion = library.motion(clip.id)
    places = library.positions(clip.id)
    if len(places) < 2:
        return 0.0, 0.0
    hips = places[:, motion.human_bones.index("hips")]
    hands = [places[:, motion.human_bones.index(bone)] - hips
             for bone in ("leftHand", "rightHand") if bone in motion.human_bones]
    level = np.linalg.norm(np.diff(hips[:, [0, 2]], axis=0), axis=1) * motion.rate
    fast = [np.linalg.norm(np.diff(hand, axis=0), axis=1) * motion.rate for hand in hands]
    return np.median(level), np.percentile(np.max(fast, axis=0), 95) if fast else 0.0


def windows_of(features):
    """Returns the windows of a clip as rows: four instants with all features each."""
    starts = range(0, len(features) - WINDOW + 1, STEP)
    keys = [(2 * k + 1) * WINDOW // 8 for k in range(4)]
    return [features[start:start + WINDOW][keys].ravel() for start in starts]


def principal_components(rows):
    """Returns the two coordinates of each row, and their shares of the variance."""
    centred = rows - rows.mean(0)
    values, axes = np.linalg.eigh(centred.T @ centred)
    axes = axes[:, ::-1][:, :2]
    axes *= np.sign(axes[np.abs(axes).argmax(0), [0, 1]])  # The same picture everywhere.
    return centred @ axes, values[::-1][:2] / values.sum()


def print_table(groups, key):
    print(f"{key:26} clips   hours  hips m/s  hands m/s  pass %")
    for name, members in groups:
        table = np.array([[clip.seconds, walk, wave, clip.quality == "pass"]
                          for clip, (walk, wave) in members])
        print(f"{name:26} {len(table):5}  {table[:, 0].sum() / 3600:6.3f}  "
              f"{np.median(table[:, 1]):8.2f}  {np.median(table[:, 2]):9.2f}  "
              f"{100 * table[:, 3].mean():6.1f}")


def move_apart(figure, labels):
    """Moves labels up or down until none covers another one."""
    figure.canvas.draw()
    boxes = [label.get_window_extent().padded(6) for label in labels]
    for _ in range(500):
        for a in range(len(boxes)):
            for b in range(a):
                if boxes[a].overlaps(boxes[b]):
                    up = 1.0 if boxes[a].y0 >= boxes[b].y0 else -1.0
                    boxes[a] = boxes[a].translated(0, up)
                    boxes[b] = boxes[b].translated(0, -up)
    for label, box in zip(labels, boxes):
        label.set_position((0, box.y0 + 6 - label.get_window_extent().y0))


def draw(groups, rows_of, key, library, path):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot as plt

    order = [name for name, _ in groups]
    palette = plt.get_cmap("tab20").colors
    # Dark shades first, so that the largest groups differ most.
    colours = [palette[k] for k in (0, 2, 4, 6, 8, 10, 12, 16, 18, 1, 5, 9)]
    colour_of = {name: colours[k] if k < MAX_GROUPS else (0.75, 0.75, 0.75)
                 for k, name in enumerate(order)}
    figure, (left, right) = plt.subplots(
        1, 2, figsize=(14, 7), dpi=DPI, width_ratios=(1, 1.5), layout="constrained")
    shown = order[:MAX_GROUPS]
    members = dict(groups)
    for half, (column, name, colour) in enumerate(((0, "hips", "#3b6ea5"),
                                                   (1, "faster hand", "#d98032"))):
        values = [[speed[column] for _, speed in members[group]] for group in shown]
        at = np.arange(len(shown)) + 0.2 - 0.4 * half
        boxes = left.boxplot(values, positions=at, widths=0.32, vert=False, whis=(5, 95),
                             showfliers=False, patch_artist=True,
                             medianprops={"color": "black"})
        for box in boxes["boxes"]:
            box.set_facecolor(colour)
        left.plot([], [], "s", color=colour, label=name)
    left.set_yticks(range(len(shown)), [f"{g} ({len(members[g])})" for g in shown])
    left.invert_yaxis()
    left.set_xlabel("speed [m/s]")
    left.set_xlim(left=0)
    left.grid(axis="x", alpha=0.3)
    left.legend(loc="lower right")
    left.set_title(f"Speed per {key} (clips); boxes: quartiles, lines: 5 to 95 %")

    names = [name for name in order for _ in rows_of.get(name, [])]
    rows = np.array([row for name in order for row in rows_of.get(name, [])], np.float64)
    places, shares = principal_components(rows)
    tints = np.array([colour_of[name] for name in names])
    mixed = np.random.default_rng(0).permutation(len(rows))  # No group hides another.
    right.scatter(*places[mixed].T, s=7, c=tints[mixed], alpha=0.55, linewidths=0)
    labels = []
    for name in shown:
        mine = places[[other == name for other in names]]
        if len(mine) == 0:
            continue
        middle = np.median(mine, axis=0)
        centre = mine[np.linalg.norm(mine - middle, axis=1).argmin()]
        labels.append(right.annotate(
            name, centre, xytext=(0, 0), textcoords="offset pixels", ha="center",
            va="center", fontsize=9, weight="bold",
            arrowprops={"arrowstyle": "-", "color": colour_of[name], "linewidth": 1.2},
            bbox={"boxstyle": "round,pad=0.2", "facecolor": "white",
                  "edgecolor": colour_of[name], "linewidth": 1.6, "alpha": 0.9}))
    right.set_xlabel(f"principal component 1 ({100 * shares[0]:.0f} % of the variance)")
    right.set_ylabel(f"principal component 2 ({100 * shares[1]:.0f} %)")
    right.set_title(f"{len(rows)} windows of {(WINDOW - 1) / FEATURE_RATE_HZ:g} s by their "
                    f"features, coloured by {key}")
    hours = sum(clip.seconds for _, group in groups for clip, _ in group) / 3600
    figure.suptitle(f"{library.path.resolve().name}, version {library.version}: "
                    f"{len(library)} clips, {hours:.2f} h")
    move_apart(figure, labels)
    figure.savefig(path, dpi=DPI)
    print("wrote", path)


def main():
    parser = argparse.ArgumentParser(description="Statistics of a motion library")
    parser.add_argument("library")
    parser.add_argument("--by", default="content", help="key of the labels (default content)")
    parser.add_argument("--to", default="library_statistics.png", help="the picture")
    args = parser.parse_args()
    library = Library(args.library)
    found, rows_of = defaultdict(list), defaultdict(list)
    for clip in library.clips():
        name = group_of(clip, args.by)
        found[name].append((clip, speeds(library, clip)))
        rows_of[name] += windows_of(library.features(clip.id))
    groups = sorted(found.items(), key=lambda group: (-len(group[1]), group[0]))
    print_table(groups, args.by)
    if not any(rows_of.values()):
        print("no clip is as long as a window: no picture")
        return
    try:
        draw(groups, rows_of, args.by, library, args.to)
    except ImportError:
        print("no picture: matplotlib is missing; apt-get install python3-matplotlib")


if __name__ == "__main__":
    try:
        main()
    except LibraryError as error:
        sys.exit(f"error: {error}")
