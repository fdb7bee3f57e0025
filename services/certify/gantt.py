"""Charts of an assignment as SVG: the schedule of each vehicle, and the tree of the task relations.

Plain shapes with their own colours, so that a chart looks the same in a report and as a file. Times
are ms after mission start. Nothing is decided here.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

from cratous.spec import algebra
from cratous.spec.assignment.search import AssignmentProblem, Step
from cratous.spec.constraint_rows import NOT_AFTER, NOT_BEFORE, Row

LEFT, WIDTH, LANE, TOP = 96, 880, 52, 30
FONT = 'font-family="sans-serif" font-size="12"'
INKS = ("#2b6cb0", "#2f855a", "#b7791f", "#9b2c2c", "#6b46c1", "#2c7a7b")
WORDS = {".": "in sequence", "~": "by starts", "|": "any order", "+": "exactly one"}
LEAF, LEVEL = 18, 66


@dataclass(frozen=True)
class Bar:
    """One task of a vehicle: times of departure, arrival, start and end [ms]."""

    vehicle: int
    task: int
    depart: int
    arrive: int
    start: int
    end: int


def bars_of(problem: AssignmentProblem, steps: Iterable[Step]) -> list[Bar]:
    """The bars of a solution; a vehicle departs when it is ready or has finished its previous task."""
    free = dict(zip(problem.vehicles, problem.ready_ms, strict=True))
    made = []
    for s in steps:
        made.append(
            Bar(s.vehicle_id, s.task_id, free[s.vehicle_id], s.arrive_ms, s.start_ms, s.end_ms)
        )
        free[s.vehicle_id] = s.end_ms
    return made


def plan_bars(plan: dict[str, Any]) -> list[Bar]:
    """The bars of a report's plan."""
    names = ("vehicle_id", "task_id", "depart_ms", "arrive_ms", "start_ms", "end_ms")
    return [Bar(*(item[name] for name in names)) for item in plan["items"]]


def plan_rows(plan: dict[str, Any]) -> list[Row]:
    """The constraint rows of a report's plan."""
    return [Row(**{**row, "group": tuple(row["group"])}) for row in plan.get("rows", ())]


def windows_of(rows: Iterable[Row]) -> dict[int, tuple[int | None, int | None]]:
    """For each task the earliest start and latest end set by rows on that task alone [ms]."""
    found: dict[int, tuple[int | None, int | None]] = {}
    for row in rows:
        low, high = found.get(row.i, (None, None))
        if row.kind == NOT_BEFORE and row.lo > 0:
            found[row.i] = (max(low or 0, row.lo), high)
        elif row.kind == NOT_AFTER:
            found[row.i] = (low, row.hi if high is None else min(high, row.hi))
    return found


def gantt(bars: Sequence[Bar], vehicles: Sequence[int], rows: Iterable[Row] = ()) -> str:
    """The chart: a lane for each vehicle; travel, waiting loiters, tasks, and time windows above the tasks."""
    horizon = max([bar.end for bar in bars] + [1])
    begin = min([bar.depart for bar in bars] + [0])
    per_ms = WIDTH / max(1, horizon - begin)
    height = TOP + LANE * max(1, len(vehicles)) + 56

    def x(at: int) -> float:
        return round(LEFT + (min(max(at, begin), horizon) - begin) * per_ms, 1)

    parts = _axis(begin, horizon, x, height)
    limits = windows_of(rows)
    for lane, vehicle in enumerate(vehicles):
        middle = TOP + LANE * lane + LANE // 2
        parts.append(f'<text x="8" y="{middle + 4}" fill="#333">vehicle {vehicle}</text>')
        parts.append(
            f'<line x1="{LEFT}" y1="{middle}" x2="{LEFT + WIDTH}" y2="{middle}" stroke="#e5e5e5"/>'
        )
        for bar in bars:
            if bar.vehicle == vehicle:
                window = limits.get(bar.task, (None, None))
                parts += _bar(bar, middle, x, INKS[lane % len(INKS)], window, horizon)
    return _svg(LEFT + WIDTH + 20, height, parts + _legend(height - 12), "Gantt chart")


def _bar(
    bar: Bar, middle: int, x: Any, ink: str, window: tuple[int | None, int | None], horizon: int
) -> list[str]:
    low, high = window
    about = f"task {bar.task}: {bar.start / 1000:.3f} to {bar.end / 1000:.3f} s"
    if low is not None or high is not None:
        to = "…" if high is None else f"{high / 1000:.3f} s"
        about += f", window {(low or 0) / 1000:.3f} to {to}"
    made = [
        f'<line x1="{x(bar.depart)}" y1="{middle}" x2="{x(bar.arrive)}" y2="{middle}" '
        f'stroke="{ink}" stroke-width="3"/>'
    ]
    if bar.start > bar.arrive:
        wide = max(1.0, x(bar.start) - x(bar.arrive))
        made.append(
            f'<rect x="{x(bar.arrive)}" y="{middle - 6}" width="{wide:.1f}" height="12" fill="#fff" '
            f'stroke="{ink}" stroke-dasharray="3 2"><title>loiter '
            f"{(bar.start - bar.arrive) / 1000:.3f} s</title></rect>"
        )
    wide = max(2.0, x(bar.end) - x(bar.start))
    made.append(
        f'<rect x="{x(bar.start)}" y="{middle - 11}" width="{wide:.1f}" height="22" rx="2" '
        f'fill="{ink}"><title>{escape(about)}</title></rect>'
    )
    if wide > 9 * len(f"p{bar.task}"):
        at, down, fill = x(bar.start) + wide / 2, middle + 4, "#fff"
    else:
        at, down, fill = x(bar.start) + wide / 2, middle + 23, ink
    made.append(
        f'<text x="{at:.1f}" y="{down}" text-anchor="middle" fill="{fill}">p{bar.task}</text>'
    )
    if low is not None or high is not None:
        a, b = x(low or 0), x(horizon if high is None else high)
        y = middle - 16
        open_end = high is None or high > horizon
        tail = f"M{b} {y} l-5 -3 m5 3 l-5 3" if open_end else f"M{b} {y - 3} v6"
        made.append(
            f'<path d="M{a} {y - 3} v6 M{a} {y} H{b} {tail}" fill="none" stroke="#c53030" '
            f'stroke-width="1.5"/><text x="{a + 3}" y="{y - 4}" font-size="9" fill="#c53030">'
            f"p{bar.task}</text>"
        )
    return made


def _axis(begin: int, horizon: int, x: Any, height: int) -> list[str]:
    span, step = max(1, horizon - begin), 1
    while span / step > 10:
        step *= 5 if str(step)[0] == "1" else 2
    unit, name = (1000, "s") if horizon >= 1000 else (1, "ms")
    made = []
    at = -(-begin // step) * step
    while at <= horizon:
        made.append(
            f'<line x1="{x(at)}" y1="{TOP - 8}" x2="{x(at)}" y2="{height - 50}" stroke="#eee"/>'
            f'<text x="{x(at)}" y="{TOP - 12}" text-anchor="middle" fill="#666">'
            f"{at / unit:g} {name}</text>"
        )
        at += step
    return made


def _legend(y: int) -> list[str]:
    names = (
        ('<line x1="0" y1="-4" x2="26" y2="-4" stroke="#555" stroke-width="3"/>', "on the way"),
        ('<rect x="0" y="-10" width="26" height="12" fill="#fff" stroke="#555" '
         'stroke-dasharray="3 2"/>', "loiter"),
        ('<rect x="0" y="-13" width="26" height="18" rx="2" fill="#555"/>', "task"),
        ('<path d="M0 -7 v6 M0 -4 H26 M26 -7 v6" fill="none" stroke="#c53030" '
         'stroke-width="1.5"/>', "window"),
    )  # fmt: skip
    return [
        f'<g transform="translate({LEFT + 150 * k} {y})">{shape}'
        f'<text x="34" y="0" fill="#333">{name}</text></g>'
        for k, (shape, name) in enumerate(names)
    ]


def tree(term: algebra.Term) -> str:
    """The tree of a term: operators with their meaning, tasks as leaves, timings in red."""
    parts: list[str] = []
    width, _, depth = _node(term, 10.0, 0, parts)
    return _svg(int(width) + 20, 30 + LEVEL * (depth + 1), parts, "Tree of the relations")


def _node(
    term: algebra.Term, left: float, level: int, parts: list[str]
) -> tuple[float, float, int]:
    """Draw a term from x = `left`; returns (right edge, middle of its head, deepest level)."""
    y = 26 + LEVEL * level
    timing = "" if term.suffix is None else _timing(term.suffix)
    if isinstance(term, algebra.Atom):
        name = f"p{term.task}"
        wide = max(44.0, 8.0 * max(len(name), 0.8 * len(timing)) + LEAF)
        x = left + wide / 2
        parts.append(
            f'<rect x="{x - 18:.1f}" y="{y - 12}" width="36" height="24" rx="4" fill="#2b6cb0"/>'
            f'<text x="{x:.1f}" y="{y + 4}" text-anchor="middle" fill="#fff">{name}</text>'
        )
        parts.append(_note(x, y + 27, timing, "#c53030"))
        return left + wide, x, level
    at, deepest, heads = left, level, []
    lines: list[str] = []
    for operand in term.operands:
        at, head, deep = _node(operand, at, level + 1, parts)
        heads.append(head)
        deepest = max(deepest, deep)
    label = WORDS[term.op] + (f"  {timing}" if timing else "")
    at = max(at, left + 7.0 * len(label) + LEAF)
    x = (heads[0] + heads[-1]) / 2
    lines += [
        f'<line x1="{x:.1f}" y1="{y}" x2="{head:.1f}" y2="{y + LEVEL - 12}" stroke="#999"/>'
        for head in heads
    ]
    parts[:0] = lines
    parts.append(
        f'<circle cx="{x:.1f}" cy="{y}" r="13" fill="#fff" stroke="#333"/>'
        f'<text x="{x:.1f}" y="{y + 4}" text-anchor="middle" fill="#333">{escape(term.op)}</text>'
    )
    parts.append(
        f'<text x="{x + 18:.1f}" y="{y - 2}" fill="#666">{WORDS[term.op]}'
        + (f' <tspan fill="#c53030">{timing}</tspan>' if timing else "")
        + "</text>"
    )
    return max(at, x + 26 + 7.0 * len(label)), x, deepest


def _timing(suffix: algebra.Suffix) -> str:
    mark = "_" if suffix.kind == algebra.ABSOLUTE else "-"
    return f"{mark}[{suffix.t1_ms / 1000:g} s, {suffix.t2_ms / 1000:g} s]"


def _note(x: float, y: float, text: str, ink: str) -> str:
    return (
        f'<text x="{x:.1f}" y="{y}" text-anchor="middle" fill="{ink}">{text}</text>' if text else ""
    )


def _svg(width: int, height: int, parts: Sequence[str], title: str) -> str:
    return (
        f'<svg viewBox="0 0 {width} {height}" width="{width}" height="{height}" role="img" aria-label="{title}" {FONT}>'
        f'<rect width="{width}" height="{height}" fill="#fff"/>' + "".join(parts) + "</svg>\n"
    )


def both(chart: str, of_relations: str) -> str:
    """Two charts in one file, one above the other."""
    sizes = [
        tuple(int(part.split('"')[0]) for part in picture.split('viewBox="0 0 ')[1].split(" ")[:2])
        for picture in (chart, of_relations)
    ]
    width, height = max(w for w, _ in sizes), sum(h for _, h in sizes)
    lower = of_relations.strip().replace("<svg ", f'<svg y="{sizes[0][1]}" ', 1)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" '
        f'height="{height}"><rect width="{width}" height="{height}" fill="#fff"/>'
        f"{chart.strip()}{lower}</svg>\n"
    )
