"""Draws the rooms of CMakeLists.txt and which may include which: docs/images/floor-plan.svg.

    python3 docs/draw_floor_plan.py            # writes the picture
    python3 docs/draw_floor_plan.py --check    # exit code 1 if the picture is not that of CMakeLists.txt

A layered drawing (Sugiyama, Tagawa, Toda 1981) of the table's transitive reduction: a room may include every room that
a path of lines leads down to, except those that its box names after "not".
Needs the standard library only.
"""

from __future__ import annotations

import random
import re
import sys
from math import fsum
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PICTURE = ROOT / "docs/images/floor-plan.svg"

BOX_HEIGHT = 38
FLOOR_HEIGHT = 82  # from one row of boxes to the next
GAP = 26           # between neighbours of a row
LANE = 14          # width of a line that passes a row
MARGIN = 24


def read_table(text):
    """The rooms in order with the rooms that each may include, and the library of each."""
    text = re.sub(r"#.*", "", text)
    variables, uses, library = {}, {}, {}
    for command, arguments in re.findall(r"\b(set|montelux_room|montelux_library)\s*\(([^)]*)\)", text):
        words = []
        for word in arguments.split():
            name = re.fullmatch(r"\$\{(\w+)\}", word)
            words += variables.get(name[1], [word]) if name else [word]
        if not words:
            continue
        first, rest = words[0], words[1:]
        if command == "set":
            variables[first] = rest
            continue
        key, values = None, {}
        for word in rest:
            if word in ("USES", "LINKS", "INCLUDES", "ROOMS"):
                key = word
            else:
                values.setdefault(key, []).append(word)
        if command == "montelux_room":
            uses[first] = values.get("USES", [])
        else:
            library |= {room: f"montelux::{first}" for room in values.get("ROOMS", [])}
    return uses, library


def reduction(uses):
    """The lines of each room (to what it may include and no room between leads to), and what they promise too much."""
    reach = {}
    for room in uses:  # declared after all that it uses
        reach[room] = set(uses[room]).union(*(reach[used] for used in uses[room]))
    direct = {room: [a for a in uses[room] if not any(a in reach[b] for b in uses[room])] for room in uses}
    forbidden = {room: [a for a in uses if a in reach[room] and a not in uses[room]] for room in uses}
    return direct, forbidden


def join_equal(direct):
    """Rooms with the same three or more lines share them: a joint, named by a tuple, between users and used."""
    graph = {room: list(used) for room, used in direct.items()}
    for used in sorted({tuple(v) for v in direct.values() if len(v) > 2}):
        users = [room for room in direct if tuple(direct[room]) == used]
        if len(users) > 1:
            graph[used] = list(used)
            for room in users:
                graph[room] = [used]
    return graph


def layered(graph):
    """Rows of nodes from the bottom, and the graph with a ("pass", ...) node in each row that a line crosses."""
    level = {}

    def level_of(node):
        if node not in level:
            level[node] = 1 + max((level_of(below) for below in graph[node]), default=-1)
        return level[node]

    for node in graph:
        level_of(node)
    chains = {node: [] for node in graph}
    for node in graph:
        for below in graph[node]:
            upper = node
            for row in range(level[node] - 1, level[below], -1):
                passing = ("pass", node, below, row)
                level[passing] = row
                chains[passing] = []
                chains[upper].append(passing)
                upper = passing
            chains[upper].append(below)
    rows = [[n for n in level if level[n] == row] for row in range(1 + max(level.values()))]
    return rows, chains


def crossings(upper, lower, chains):
    place = {node: i for i, node in enumerate(lower)}
    lines = [(i, place[below]) for i, node in enumerate(upper) for below in chains[node]]
    return sum((a < c and b > d) or (a > c and b < d) for i, (a, b) in enumerate(lines) for c, d in lines[:i])


def order(rows, chains):
    """The order of the rows with the fewest crossings, of those that a few shuffled starts lead to."""
    above = {node: [n for n in chains if node in chains[n]] for node in chains}
    rows = [list(row) for row in rows]
    shuffle = random.Random(1).shuffle
    best, kept = None, None

    def total():
        return sum(crossings(rows[i + 1], rows[i], chains) for i in range(len(rows) - 1))

    for _ in range(20):
        for row in rows:
            shuffle(row)
        for sweep in range(8):
            down = sweep % 2 == 0
            neighbours = chains if down else above
            for i in range(len(rows)) if down else reversed(range(len(rows))):
                sort_by_neighbours(rows, i, neighbours)
                exchange(rows[i], total)
            if best is None or total() < best:
                best, kept = total(), [list(row) for row in rows]
    return kept


def sort_by_neighbours(rows, i, neighbours):
    place = {node: (k + 0.5) / len(row) for row in rows for k, node in enumerate(row)}

    def mean(node):
        near = neighbours[node]
        return fsum(place[n] for n in near) / len(near) if near else place[node]

    rows[i].sort(key=mean)


def exchange(row, total):
    """Exchanges neighbours as long as lines cross less."""
    for k in range(len(row) - 1):
        before = total()
        row[k], row[k + 1] = row[k + 1], row[k]
        if total() >= before:
            row[k], row[k + 1] = row[k + 1], row[k]


def spread(wanted, distances):
    """Places in order, at least these distances apart, nearest to the wanted ones by least squares."""
    offsets = [0.0]
    for d in distances:
        offsets.append(offsets[-1] + d)
    blocks = []  # of equal shifted places: sum, number
    for want, offset in zip(wanted, offsets):
        blocks.append([want - offset, 1])
        while len(blocks) > 1 and blocks[-2][0] / blocks[-2][1] > blocks[-1][0] / blocks[-1][1]:
            total, number = blocks.pop()
            blocks[-1][0] += total
            blocks[-1][1] += number
    shifted = [total / number for total, number in blocks for _ in range(number)]
    return [s + offset for s, offset in zip(shifted, offsets)]


def place(rows, chains, width):
    """The middle of each node: near the mean of its neighbours, without overlaps."""
    above = {node: [n for n in chains if node in chains[n]] for node in chains}
    apart = [[separation(a, b, width) for a, b in zip(row, row[1:])] for row in rows]
    x = {}
    for row, distances in zip(rows, apart):
        x |= dict(zip(row, spread([0.0] * len(row), distances)))
    for _ in range(200):
        for row, distances in zip(rows, apart):
            near = [chains[node] + above[node] for node in row]
            wanted = [fsum(x[n] for n in ns) / len(ns) if ns else x[node] for node, ns in zip(row, near)]
            x |= dict(zip(row, spread(wanted, distances)))
    left = min(x[n] - width(n) / 2 for n in x)
    return {n: round(x[n] - left + MARGIN) for n in x}


def separation(a, b, width):
    return (width(a) + width(b)) / 2 + GAP


STYLE = """
  .paper { fill: #ffffff; }
  .line { fill: none; stroke: #6e7781; stroke-width: 1.6; }
  .tip { fill: #6e7781; }
  .box { stroke-width: 1.4; }
  .l0 { fill: #ddf4ff; stroke: #0969da; }
  .l1 { fill: #fff1e5; stroke: #bc4c00; }
  .l2 { fill: #fbefff; stroke: #8250df; }
  text { font-family: system-ui, "Segoe UI", Helvetica, Arial, sans-serif; fill: #1f2328; text-anchor: middle; }
  .name { font-size: 15px; font-weight: 600; }
  .note { font-size: 11px; }
  .key { font-size: 13px; text-anchor: start; }
  @media (prefers-color-scheme: dark) {
    .paper { fill: #0d1117; }
    .line { stroke: #8d96a0; }
    .tip { fill: #8d96a0; }
    .l0 { fill: #0c2d5e; stroke: #58a6ff; }
    .l1 { fill: #4a2207; stroke: #f0883e; }
    .l2 { fill: #341a62; stroke: #bc8cff; }
    text { fill: #e6edf3; }
  }
"""


def draw(uses, library):
    direct, forbidden = reduction(uses)
    rows, chains = layered(join_equal(direct))
    rows = order(rows, chains)
    notes = {room: "not " + ", ".join(names) for room, names in forbidden.items() if names}

    def is_room(node):
        return isinstance(node, str)

    def width(node):
        if not is_room(node):
            return LANE
        return max(9 * len(node) + 28, 6 * len(notes.get(node, "")) + 20)

    x = place(rows, chains, width)
    libraries = list(dict.fromkeys(library.values()))
    right = max(x[n] + width(n) / 2 for n in x) + MARGIN
    top = MARGIN
    bottom = top + FLOOR_HEIGHT * (len(rows) - 1)
    y = {node: bottom - FLOOR_HEIGHT * i + BOX_HEIGHT / 2 for i, row in enumerate(rows) for node in row}
    above = {node: [n for n in chains if node in chains[n]] for node in chains}

    def port(node, other, side):
        """Where the line to `other` meets a box: lines share its edge in the order of their other ends."""
        if not is_room(node):
            return x[node]
        ends = sorted((chains if side == "below" else above)[node], key=lambda n: x[n])
        room = min(width(node) - 24, 22 * (len(ends) - 1))
        return x[node] + (room * (ends.index(other) / (len(ends) - 1) - 0.5) if len(ends) > 1 else 0)

    height = bottom + BOX_HEIGHT + MARGIN
    svg = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {right:.0f} {height:.0f}" width="{right:.0f}" '
        f'height="{height:.0f}" role="img">',
        "<title>The rooms of Montelux and which may include which</title>",
        f"<style>{STYLE}</style>",
        f'<rect class="paper" width="{right:.0f}" height="{height:.0f}" rx="10"/>',
    ]
    for node in chains:
        for below in chains[node]:
            x0, x1 = port(node, below, "below"), port(below, node, "above")
            y0 = y[node] + (BOX_HEIGHT / 2 if is_room(node) else 0)
            y1 = y[below] - (BOX_HEIGHT / 2 + 7 if is_room(below) else 0)
            bend = (y1 - y0) / 2
            curve = f"M{x0:.0f} {y0:.0f} C{x0:.0f} {y0 + bend:.0f} {x1:.0f} {y1 - bend:.0f} {x1:.0f} {y1:.0f}"
            svg.append(f'<path class="line" d="{curve}"/>')
            if is_room(below):
                svg.append(f'<path class="tip" d="M{x1 - 4:.0f} {y1 - 1:.0f} h8 l-4 8 z"/>')
    for node in x:
        if not is_room(node):
            if node[0] != "pass":
                svg.append(f'<circle class="tip" cx="{x[node]}" cy="{y[node]:.0f}" r="4"/>')
            continue
        kind = libraries.index(library[node])
        w = width(node)
        corner = f'x="{x[node] - w / 2:.0f}" y="{y[node] - BOX_HEIGHT / 2:.0f}"'
        svg.append(f'<rect class="box l{kind}" {corner} width="{w}" height="{BOX_HEIGHT}" rx="7"/>')
        shift = -2 if node in notes else 5
        svg.append(f'<text class="name" x="{x[node]}" y="{y[node] + shift:.0f}">{node}</text>')
        if node in notes:
            svg.append(f'<text class="note" x="{x[node]}" y="{y[node] + 13:.0f}">{notes[node]}</text>')
    key = right - MARGIN - 140 if sum(x[n] for n in rows[-1]) < len(rows[-1]) * right / 2 else MARGIN
    for i, name in enumerate(libraries):
        svg.append(f'<rect class="box l{i}" x="{key:.0f}" y="{MARGIN + 26 * i}" width="18" height="18" rx="4"/>')
        svg.append(f'<text class="key" x="{key + 27:.0f}" y="{MARGIN + 26 * i + 14}">{name}</text>')
    return "\n".join(svg) + "\n</svg>\n"


def main(arguments):
    if arguments not in ([], ["--check"]):
        sys.exit(__doc__)
    uses, library = read_table((ROOT / "CMakeLists.txt").read_text())
    picture = draw(uses, library)
    if arguments:
        if not PICTURE.exists() or PICTURE.read_text() != picture:
            sys.exit(f"{PICTURE.relative_to(ROOT)} is not that of CMakeLists.txt: run python3 docs/draw_floor_plan.py")
        return
    PICTURE.write_text(picture)


if __name__ == "__main__":
    main(sys.argv[1:])
