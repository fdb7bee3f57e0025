"""Generated missions: mostly one protected vehicle that flies north, traffic that meets it, and
zones about its route.

The vehicle would be at the frame's origin after `time_s`, and continues to a point as far behind
it. `cases` are named alternatives, of which one is drawn for each seed: other counts, ranges and
values of the mission. An intruder's course is `angle_deg` relative to the vehicle's; it passes the
origin at the same instant, `miss_m` beside it and `height_m` above. Each parameter of a seed has
its own random stream, so that changing the range of one leaves the others unchanged.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import cos, radians, sin
from random import Random
from typing import Any

from cratous.core.kernel import Vec2
from cratous.core.permit.tubes import disc_within
from cratous.services.campaign.changed_missions import changing_mission
from cratous.spec.errors import BadInput

Ranges = dict[str, tuple[float, float]]
ALTITUDE_M = 300.0
FRAME = {"latitude_deg": 45.0, "longitude_deg": -120.0}
"""Location of generated missions."""
COMMON: Ranges = {
    "own_speed_m_s": (18, 28), "speed_m_s": (15, 40), "time_s": (70, 110), "miss_m": (-50, 50),
    "height_m": (-20, 20), "area_m": (-3000, 3000), "zone_gap_m": (100, 600), "zone_size_m": (200, 600),
    "zone_place": (-0.6, 0.4), "bend_m": (-150, 150), "room_m": (400, 800),
}  # fmt: skip
KINDS: dict[str, Ranges] = {
    "aimed": {"angle_deg": (0, 360), "miss_m": (0, 0), "height_m": (0, 0)},
    "converging": {"angle_deg": (30, 150)},
    "overtaking": {"angle_deg": (-15, 15), "own_speed_m_s": (22, 28), "speed_m_s": (8, 14)},
    "head_on": {"angle_deg": (165, 195)},
    "random": {"angle_deg": (0, 360), "height_m": (-150, 150)},
}
PARAMETERS = frozenset(COMMON) | {name for ranges in KINDS.values() for name in ranges}
"""All parameters with a range."""
CHANGES, MOST_CHANGES = "changes", 6
"""The kind of `services.campaign.changing`, which has no ranges, and its maximum number of changes."""
COUNTS = (
    "intruders", "zones_beside", "zones_across", "bends", "keep_in", "cooperative", "apart_m",
)  # fmt: skip
"""What a case may change besides ranges and values of the mission."""
CASES = "cases"
AGAIN = 100
"""Maximum number of draws of an intruder that would start too close."""
KEEP_IN = 50
"""Id of the keep-in zone."""
BEND = 1000
"""First id of tasks at bends of the route."""
SIDES = (-1, 1)
"""Left and right."""
MIRRORED = ("converging",)
"""Kinds whose angle may be to either side."""


class Draw:
    """The parameters of one seed, and the values drawn; those in `given` are used instead of draws.

    bounds: range of each drawn number, before mirroring; choices: alternatives of each other draw.
    """

    def __init__(
        self, data: dict[str, Any], seed: int, given: Mapping[str, Any] | None = None
    ) -> None:
        self.kind: str = data["kind"]
        self.seed, self._given = seed, given or {}
        self.drawn: dict[str, Any] = {}
        self.bounds: dict[str, tuple[float, float]] = {}
        self.choices: dict[str, tuple[Any, ...]] = {}
        self.data, self.values = dict(data), dict[str, Any]()  # of the mission, by their path
        ranges = dict(data.get("ranges", {}))
        for what, cases in sorted(data.get(CASES, {}).items()):
            case = cases[self.chosen(what, tuple(sorted(cases)))]
            self.data |= {name: case[name] for name in COUNTS if name in case}
            ranges |= case.get("ranges", {})
            self.values |= case.get("set", {})
        own = {name: tuple(bounds) for name, bounds in ranges.items()}
        self._ranges = {**COMMON, **KINDS.get(self.kind, {}), **own}

    def __call__(self, name: str, number: int = 0, again: int = 0) -> float:
        """A parameter; number: of the intruder or zone, from 1, 0 if common to all; again: number
        of earlier draws.
        """
        low, high = self._ranges[name]
        key = f"{name}[{number}]" if number else name
        once = f" again {again}" * bool(again)
        value = round(Random(f"{self.seed} {key}{once}").uniform(low, high), 3)
        value = self._given.get(key, value)
        if name == "angle_deg" and self.kind in MIRRORED:
            value *= self.side(key)
        self.drawn[key], self.bounds[key] = value, (low, high)
        return value

    def chosen(self, what: str, names: tuple[str, ...]) -> str:
        """The drawn one of some cases."""
        self.choices[what] = names
        drawn = Random(f"{self.seed} case {what}").choice(names)
        self.drawn[what] = self._given.get(what, drawn)
        return str(self.drawn[what])

    def side(self, key: str) -> int:
        """Left (-1) or right (1)."""
        name = f"side {key}"
        self.choices[name] = SIDES
        drawn = Random(f"{self.seed} {name}").choice(SIDES)
        return int(self._given.get(name, drawn))


def mission_of(
    data: dict[str, Any], name: str, seed: int, given: Mapping[str, Any] | None = None
) -> tuple[dict[str, Any], Draw]:
    """The mission file of a seed as data, and its parameters; values in `given` are used as they are."""
    draw = Draw(data, seed, given)
    if draw.kind == CHANGES:
        made = changing_mission(name, seed, data.get("most_changes", MOST_CHANGES))
        draw.drawn = {what: len(made[what]) for what in ("vehicles", "tasks", "changes")}
        return made, draw
    data = draw.data
    time, speed = draw("time_s"), draw("own_speed_m_s")
    way = speed * time
    vehicles = [vehicle_at(1, (-way, 0.0, ALTITUDE_M), 0.0, speed)]
    tasks = [*_bends(draw, data, way), _task(1, (way, 0.0, ALTITUDE_M))]
    traffic = []
    for k in range(1, data.get("intruders", 1) + 1):
        start, course_deg, fast = _far_intruder(draw, k, time, way)
        if data.get("cooperative", False):
            vehicles.append(vehicle_at(k + 1, start, course_deg, fast))
            tasks.append(_task(k + 1, _ahead(start, course_deg, 2 * fast * time)))
        else:
            traffic.append(
                {"id": 100 + k, "position": _at(start), "velocity": _over(course_deg, fast)}
            )
    mission = {
        "name": f"{name}-{seed}",
        "description": f"{draw.kind}, made by a campaign with seed {seed}",
        "frame": dict(FRAME),
        "vehicles": vehicles,
        "tasks": tasks,
        "traffic": traffic,
        "zones": [*_zones(draw, data, way), *_keep_in(draw, data, way)],
        "simulation": {"limit_s": round(6 * time)},
    }
    return {key: value for key, value in mission.items() if value != []}, draw


Point = tuple[float, float, float]


def _far_intruder(draw: Draw, k: int, time: float, way: float) -> tuple[Point, float, float]:
    """The first draw of an intruder that starts at least `apart_m` from the vehicle; BadInput if
    none of AGAIN does.
    """
    apart_m = float(draw.data.get("apart_m", 0.0))
    for again in range(AGAIN):
        found = _intruder(draw, k, time, again)
        north, east, _ = found[0]
        if not disc_within(Vec2(north + way, east), 0.0, apart_m):
            return found
    raise BadInput(
        f"no intruder starts so far away, of {AGAIN} that were drawn for seed {draw.seed}",
        item="generator.apart_m",
        expected="ranges in which most intruders do",
        got=f"{apart_m:g} m",
    )


def _intruder(draw: Draw, k: int, time: float, again: int) -> tuple[Point, float, float]:
    """Start position, course [degrees] and speed [m/s] of an intruder."""
    course_deg, fast = draw("angle_deg", k, again), draw("speed_m_s", k, again)
    alt = ALTITUDE_M + draw("height_m", k)
    if draw.kind == "random":
        draw_north, draw_east = _anywhere(draw, k)
        passes = (draw_north, draw_east, alt)
    else:
        miss = draw("miss_m", k)
        across = radians(course_deg + 90)
        passes = (miss * cos(across), miss * sin(across), alt)
    return _ahead(passes, course_deg, -fast * time), course_deg, fast


def _anywhere(draw: Draw, k: int) -> tuple[float, float]:
    return draw("area_m", 2 * k - 1), draw("area_m", 2 * k)


def _zones(draw: Draw, data: dict[str, Any], way: float) -> Iterator[dict[str, Any]]:
    beside, across = data.get("zones_beside", 0), data.get("zones_across", 0)
    for k in range(1, beside + across + 1):
        size, centre = draw("zone_size_m", k), draw("zone_place", k) * way
        west = -size / 2
        if k <= beside:
            gap = draw("zone_gap_m", k)
            west = gap if draw.side(f"zone {k}") > 0 else -gap - size
        south, north, east = centre - size / 2, centre + size / 2, west + size
        corners = [[south, west], [south, east], [north, east], [north, west]]
        yield {
            "id": k,
            "kind": "keep_out",
            "vertices": [[round(value, 3) for value in corner] for corner in corners],
        }


def _keep_in(draw: Draw, data: dict[str, Any], way: float) -> Iterator[dict[str, Any]]:
    """A rectangle around the whole straight path, with the same clearance at its ends as at its sides."""
    if data.get("keep_in", False):
        room = draw("room_m")
        north, east = round(way + room, 3), round(room, 3)
        corners = [[-north, -east], [-north, east], [north, east], [north, -east]]
        yield {"id": KEEP_IN, "kind": "keep_in", "vertices": corners}


def vehicle_at(number: int, start: Point, course_deg: float, speed: float) -> dict[str, Any]:
    """A vehicle of a mission file with the common limits of generated ones, with course [degrees]
    and speed [m/s].
    """
    return {
        "id": number, "position": _at(start), "heading_deg": _turned(course_deg), "speed_m_s": speed,
        "min_speed_m_s": round(0.7 * speed, 3), "max_speed_m_s": round(1.4 * speed, 3),
        "max_bank_deg": 30, "max_climb_m_s": 5,
    }  # fmt: skip


def _turned(course_deg: float) -> float:
    """The equivalent course between -180 and 180 degrees."""
    return round((course_deg + 180) % 360 - 180, 3)


def _bends(draw: Draw, data: dict[str, Any], way: float) -> Iterator[dict[str, Any]]:
    """Tasks evenly spaced along the vehicle's route, each offset from the straight path."""
    bends = data.get("bends", 0)
    for k in range(1, bends + 1):
        place = (2 * k / (bends + 1) - 1) * way, draw("bend_m", k), ALTITUDE_M
        yield {**_task(1, place), "id": BEND + k}


def _task(number: int, place: Point) -> dict[str, Any]:
    return {"id": number, "kind": "must_fly", "eligible": [number], "points": [_at(place)]}


def _at(place: Point) -> dict[str, float]:
    north, east, alt = (round(value, 3) for value in place)
    return {"north_m": north, "east_m": east, "alt_m": alt}


def _ahead(place: Point, course_deg: float, distance: float) -> Point:
    course = radians(course_deg)
    return place[0] + distance * cos(course), place[1] + distance * sin(course), place[2]


def _over(course_deg: float, speed: float) -> dict[str, float]:
    course = radians(course_deg)
    return {"north_m_s": round(speed * cos(course), 4), "east_m_s": round(speed * sin(course), 4)}
