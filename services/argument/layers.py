"""Layered layout: figures in columns from the goal on the left to its support, without overlaps.

A figure is one column to the right of its rightmost parent. A line that passes a column has its own
slot between the column's figures, so lines cross each other only between columns.
"""

from __future__ import annotations

from bisect import bisect_right, insort
from dataclasses import dataclass
from itertools import pairwise

GAP, GUTTER = 16.0, 84.0
"""Space between the figures of a column, and between columns."""
PASSING = 2.0
"""Height of the slot of a line that passes a column."""
SWEEPS = 12
Node = tuple[str, int]
"""A figure (its name, -1), or a line passing a column (a name for the line, the column)."""


@dataclass(frozen=True)
class Layout:
    """places: upper left corner of each figure; columns: (left, right) of each; routes: for each
    line (from, to) the heights at which it passes the columns between; size: total width and
    height.
    """

    places: dict[str, tuple[float, float]]
    columns: list[tuple[float, float]]
    column_of: dict[str, int]
    routes: dict[tuple[str, str], list[float]]
    size: tuple[float, float]


def laid_out(
    root: str, lines: dict[str, list[str]], sizes: dict[str, tuple[float, float]]
) -> Layout:
    """Layout of all figures reachable from `root` by `lines`; sizes: width and height of each figure."""
    column_of = _columns(root, lines)
    columns: list[list[Node]] = [[] for _ in range(max(column_of.values()) + 1)]
    for name, number in column_of.items():
        columns[number].append((name, -1))
    ways: dict[tuple[str, str], list[Node]] = {}
    for start in column_of:
        for end in lines.get(start, ()):
            through = range(column_of[start] + 1, column_of[end])
            passing = [(f"{start} {end}", passed) for passed in through]
            for node in passing:
                columns[node[1]].append(node)
            ways[start, end] = [(start, -1), *passing, (end, -1)]
    right: dict[Node, list[Node]] = {}
    left: dict[Node, list[Node]] = {}
    for way in ways.values():
        for one, other in pairwise(way):
            right.setdefault(one, []).append(other)
            left.setdefault(other, []).append(one)
    columns = _ordered(columns, left, right)
    heights = {node: sizes[node[0]][1] if node[1] < 0 else PASSING for c in columns for node in c}
    middles = _placed(columns, left, right, heights)
    upper = min(middles[node] - heights[node] / 2 for column in columns for node in column)
    places, spans, x = {}, [], 0.0
    for column in columns:
        wide = max(sizes[name][0] for name, passing in column if passing < 0)
        spans.append((x, x + wide))
        for node in column:
            if node[1] < 0:
                places[node[0]] = (x, middles[node] - heights[node] / 2 - upper)
        x += wide + GUTTER
    lower = max(middles[node] + heights[node] / 2 for column in columns for node in column)
    routes = {key: [middles[node] - upper for node in way[1:-1]] for key, way in ways.items()}
    return Layout(places, spans, column_of, routes, (spans[-1][1], lower - upper))


def _columns(root: str, lines: dict[str, list[str]]) -> dict[str, int]:
    """The column of each figure, in depth-first order."""
    order: dict[str, int] = {}
    todo = [root]
    while todo:
        name = todo.pop()
        if name not in order:
            order[name] = 0
            todo += reversed(lines.get(name, []))
    left = dict(order)
    for name in order:
        for other in lines.get(name, ()):
            left[other] += 1
    found = dict(order)
    ready = [root]
    while ready:
        name = ready.pop()
        for other in lines.get(name, ()):
            found[other] = max(found[other], found[name] + 1)
            left[other] -= 1
            if not left[other]:
                ready.append(other)
    return found


def _ordered(
    columns: list[list[Node]], left: dict[Node, list[Node]], right: dict[Node, list[Node]]
) -> list[list[Node]]:
    """The columns, ordered for few line crossings: figures are placed near their neighbours in adjacent columns."""
    best, fewest = columns, _crossings(columns, right)
    now = [list(column) for column in columns]
    for sweep in range(SWEEPS):
        forth = sweep % 2 == 0
        beside = left if forth else right
        for number in range(len(now)) if forth else reversed(range(len(now))):
            near = now[number - 1] if forth else now[(number + 1) % len(now)]
            place = {node: at for at, node in enumerate(near)}
            at_now = {node: at for at, node in enumerate(now[number])}
            now[number] = sorted(
                now[number],
                key=lambda n: _middle(
                    [place[o] for o in beside.get(n, ()) if o in place], at_now[n]
                ),
            )
        crossings = _crossings(now, right)
        if crossings < fewest:
            best, fewest = [list(column) for column in now], crossings
    return best


def _middle(places: list[int], default: float) -> float:
    return sum(places) / len(places) if places else default


def _crossings(columns: list[list[Node]], right: dict[Node, list[Node]]) -> int:
    """Number of crossing pairs of lines."""
    found = 0
    for one, other in pairwise(columns):
        place = {node: at for at, node in enumerate(other)}
        seen: list[int] = []
        for node in one:
            ends = sorted(place[end] for end in right.get(node, ()))
            found += sum(len(seen) - bisect_right(seen, end) for end in ends)
            for end in ends:
                insort(seen, end)
    return found


def _placed(
    columns: list[list[Node]],
    left: dict[Node, list[Node]],
    right: dict[Node, list[Node]],
    heights: dict[Node, float],
) -> dict[Node, float]:
    """The centre height of each node: as close as possible to the mean of its neighbours."""
    found: dict[Node, float] = {}
    for column in columns:
        found.update(_spread(column, dict.fromkeys(column, 0.0), heights))
    for sweep in range(SWEEPS):
        forth = sweep % 2 == 1
        beside = left if forth else right
        for column in columns if forth else reversed(columns):
            wish = {}
            for node in column:
                near = [found[other] for other in beside.get(node, ())]
                wish[node] = sum(near) / len(near) if near else found[node]
            found.update(_spread(column, wish, heights))
    return found


def _spread(
    column: list[Node], wish: dict[Node, float], heights: dict[Node, float]
) -> dict[Node, float]:
    """The centre heights of a column closest to the desired ones, in order and at least GAP apart.

    After subtracting the minimum distances this is an isotonic regression: neighbours that would be
    in the wrong order are pooled at their mean.
    """
    offsets = [0.0]
    for before, node in pairwise(column):
        offsets.append(offsets[-1] + (heights[before] + heights[node]) / 2 + GAP)
    pools: list[tuple[float, int]] = []
    for node, offset in zip(column, offsets, strict=True):
        pools.append((wish[node] - offset, 1))
        while len(pools) > 1 and pools[-2][0] > pools[-1][0]:
            (low, many), (high, more) = pools[-2:]
            pools[-2:] = [((low * many + high * more) / (many + more), many + more)]
    values = [value for value, count in pools for _ in range(count)]
    return {n: value + off for n, value, off in zip(column, values, offsets, strict=True)}
