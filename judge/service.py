"""G3: whether every requested task is served, by positions and footprints; without excuses.

A task is served if the log reports it as flown to its end (TaskProgress Complete) and if, while it is reported as being
flown (Active), by that vehicle:
- must_fly: the path came within 50 m of the point (horizontally);
- loiter: it stayed within 50 m of the loiter's reach for the duration;
- line_search: footprints covered 99 % of the line; area_search, pattern_search: of the area;
- point_search: a footprint contained the point, for the duration if one is required; and no vehicle
  that performed it came closer than the standoff.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from cratous.judge.earth import ACCURACY_M
from cratous.judge.mission import Mission, Point, Task
from cratous.judge.relations import Deed, asked, best_way
from cratous.judge.searches import searched
from cratous.judge.task_presence import Flight, nearest_m
from cratous.judge.verdict import HOLDS, UNKNOWN, VIOLATED, Row, doubted, seconds

CAPTURE_M = 50.0
GRAVITY = 9.80665
WIDER = 1.1
"""Radius of a loiter without one, as a multiple of the vehicle's minimum turn radius."""

Service = tuple[str, str, int | None]
"""Verdict, note, and time of completion [ms]."""


def served(flight: Flight) -> dict[int, Service]:
    """By task: verdict, note, and time of completion. For all tasks, requested or not."""
    return {
        task: _served(flight, flight.mission.tasks[task]) for task in sorted(flight.mission.tasks)
    }


def rows(flight: Flight, found: dict[int, Service]) -> Iterator[Row]:
    """One row for each task requested by the best-fitting resolution, and one for the end."""
    term = asked(flight.mission, flight.done, flight.log.end_ms)
    if term is not None:
        good = {t for t, (verdict, *_) in found.items() if verdict == HOLDS}
        for task in sorted(best_way(term, flight.done, good, flight.log.planned)[0].tasks()):
            verdict, note, at = found[task]
            row = Row("G3", ("served", str(task)), f"task {task} served", verdict, note, at, 1)
            yield doubted(row, flight.doubt(task))
    yield _end(flight)


def _end(flight: Flight) -> Row:
    subject, item = ("end",), "end of mission"
    ends = flight.log.ends
    if not ends:
        return Row("G3", subject, item, UNKNOWN, "the log stops before the mission ends")
    at, outcome = ends[-1]
    note = f"the mission ended {outcome!r} at {seconds(at)}"
    late = at > flight.mission.limit_ms + flight.mission.step_ms
    if len(ends) > 1 or late:
        note += ", after its limit" if late else f", after {len(ends) - 1} other ends"
    good = outcome == "complete" and len(ends) == 1 and not late
    return Row("G3", subject, item, HOLDS if good else VIOLATED, note, at, 1)


def _served(flight: Flight, task: Task) -> Service:
    deed = flight.done.get(task.id, Deed())
    if deed.complete_ms is None:
        if flight.log.end_ms is None:
            return UNKNOWN, "not flown to its end before the log stops", None
        said = "begun, but not flown to its end" if deed.active else "never begun"
        return VIOLATED, said, None
    if not deed.active:
        return VIOLATED, "said to be complete, but never begun", deed.complete_ms
    judge = {"must_fly": _flown, "loiter": _loitered}.get(task.kind, searched)
    verdict, note = judge(flight, task)
    way_doubt = flight.way_doubt(task.id)
    if way_doubt and verdict == VIOLATED and task.kind in ("must_fly", "loiter"):
        return UNKNOWN, f"{way_doubt}; else: {note}", deed.complete_ms
    return verdict, note, deed.complete_ms


def _flown(flight: Flight, task: Task) -> tuple[str, str]:
    nearest = nearest_m(flight, task, task.points[0])
    note = f"passed at {nearest:.1f} m"
    if abs(nearest - CAPTURE_M) < ACCURACY_M:
        return UNKNOWN, f"{note}, within a millimetre of what is asked"
    return (HOLDS if nearest < CAPTURE_M else VIOLATED), note


def reach_m(mission: Mission, task: Task, vehicle: int) -> float:
    """How far a loiter reaches from its centre [m]."""
    radius = task.radius_m
    flyer = mission.vehicles.get(vehicle)
    if radius == 0 and flyer is not None and flyer.bank_rad > 0:
        radius = WIDER * flyer.speed_m_s**2 / (GRAVITY * math.tan(flyer.bank_rad))
    if task.shape == "figure_eight":
        return radius + max(task.length_m / 2, radius)
    return radius + (task.length_m / 2 if task.shape == "racetrack" else 0.0)


def _loitered(flight: Flight, task: Task) -> tuple[str, str]:
    vehicles = {vehicle for vehicle, *_ in flight.spans(task.id)}
    reach = CAPTURE_M + max((reach_m(flight.mission, task, v) for v in vehicles), default=0.0)
    spent = sum(
        ms * _share_within(task.points[0], reach, a, b) for a, b, ms in flight.legs(task.id)
    )
    note = f"{spent / 1000:.3f} of {task.duration_ms / 1000:g} s within {reach:.1f} m of its centre"
    if not vehicles or spent == 0:
        return VIOLATED, note
    lacking = task.duration_ms - spent
    # start and end of a logged path are whole milliseconds
    if lacking <= 2:
        return HOLDS, note
    return (UNKNOWN if lacking <= flight.mission.step_ms else VIOLATED), note


def _share_within(centre: Point, reach: float, a: Point, b: Point) -> float:
    """The fraction of a leg within a disc."""
    x, y = a[0] - centre[0], a[1] - centre[1]
    u, v = b[0] - a[0], b[1] - a[1]
    uu, xu, over = u * u + v * v, x * u + y * v, x * x + y * y - reach * reach
    if uu == 0:
        return 1.0 if over <= 0 else 0.0
    root = xu * xu - uu * over
    if root <= 0:
        return 0.0
    root = math.sqrt(root)
    first, last = max((-xu - root) / uu, 0.0), min((-xu + root) / uu, 1.0)
    return max(0.0, last - first)
