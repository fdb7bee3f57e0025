"""Judges short flights without a log, from the mission's file and the aircraft states, with the
geometry of whole flights.

Judged are zones (G1), well clear (G2), and points (G3): for each protected vehicle the first
`reached` points of its must_fly tasks, in file order, must be passed within 50 m one after the
other. Unknown for a vehicle that reached none.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction
from pathlib import Path

from cratous.judge import mission_file, separation, zones
from cratous.judge.fields import FARTHEST, MOST, Node
from cratous.judge.log import Log, State
from cratous.judge.mission import Mission, Point
from cratous.judge.plane import squared_distance
from cratous.judge.service import CAPTURE_M
from cratous.judge.tracks import Track, tracks
from cratous.judge.verdict import HOLDS, UNKNOWN, VIOLATED, Row, doubted
from cratous.spec.errors import BadInput

States = Mapping[int, list[list[float]]]
"""By aircraft, one or more: time [ms]; north, east, altitude [m]; velocity north, east, up [m/s]; in time order."""


def judge_encounter(file: Path, states: States, reached: Mapping[int, int]) -> list[Row]:
    """All rows of an encounter; BadInput if mission or states are invalid.

    reached: by vehicle, the number of its points that it is reported to have passed.
    """
    mission = mission_file.read(file)
    if not any(states.values()):
        raise BadInput("nobody was seen", where=str(file), expected="states of an aircraft")
    log = Log(file)
    for name, told in states.items():
        log.states[name] = list(_read(Node(told, str(file), f"states[{name}]")))
    log.ends = [(max(s.time_ms for found in log.states.values() for s in found), "")]
    flown = tracks(mission, log)
    found = [*zones.rows(mission, flown), *separation.rows(mission, flown)]
    return [*found, *_points(mission, flown, reached)]


def _read(told: Node) -> Iterator[State]:
    """The states in a list; valid plain numbers, the usual case, are read without tracking positions."""
    if type(told.data) is not list:
        raise told.wrong("a list")
    for k, state in enumerate(told.data):
        yield _plain(state) or _state(Node(state, told.where, k, told))


def _plain(state: object) -> State | None:
    """A state of an integer and six doubles that `real` accepts unchanged; None if that is not certain."""
    if type(state) is not list or len(state) != len(State._fields):
        return None
    time, *values = state
    if type(time) is not int or abs(time) >= MOST or set(map(type, values)) != {float}:
        return None
    # the comparison is false for NaN too
    return State._make(state) if sum(map(abs, values)) <= FARTHEST else None


def _state(data: Node) -> State:
    values = list(data)
    if len(values) != len(State._fields):
        raise data.wrong("time [ms], position and velocity")
    return State(values[0].whole, *(value.real for value in values[1:]))


def _points(
    mission: Mission, flown: Mapping[int, Track], reached: Mapping[int, int]
) -> Iterator[Row]:
    """One row for each protected vehicle."""
    for vehicle in mission.protected:
        points = [
            point
            for task in mission.tasks.values()
            if task.kind == "must_fly" and task.eligible == {vehicle}
            for point in task.points
        ]
        yield _row(vehicle, points[: reached.get(vehicle, 0)], reached, flown[vehicle])


def _row(vehicle: int, points: list[Point], reached: Mapping[int, int], track: Track) -> Row:
    subject, item = ("points", str(vehicle)), f"points of vehicle {vehicle}"
    if vehicle not in reached or reached[vehicle] != len(points):
        note = f"{len(points)} points are known, passed are said to be {reached.get(vehicle)}"
        return Row("G3", subject, item, UNKNOWN, note)
    if not points:
        return Row("G3", subject, item, UNKNOWN, "no point was reached, so there is none to judge")
    legs = list(track.legs())
    at = 0
    for number, point in enumerate(points, 1):
        here = next((k for k in range(at, len(legs)) if _near(point, *legs[k])), None)
        if here is None:
            note = (
                f"point {number} of {len(points)} was not passed within {CAPTURE_M:g} m in its turn"
            )
            return doubted(Row("G3", subject, item, VIOLATED, note, checks=number), track.doubt)
        at = here
    note = f"{len(points)} points were passed in their order"
    return doubted(Row("G3", subject, item, HOLDS, note, checks=len(points)), track.doubt)


def _near(point: Point, p: State, q: State) -> bool:
    """Whether the leg comes within 50 m of the point."""
    for k in (0, 1):
        low, high = sorted((p[k + 1], q[k + 1]))
        if not low - 2 * CAPTURE_M <= point[k] <= high + 2 * CAPTURE_M:
            return False
    a, b = (p.north_m, p.east_m), (q.north_m, q.east_m)
    return squared_distance(point, a, b) <= Fraction(CAPTURE_M) ** 2
