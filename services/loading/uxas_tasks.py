"""Converts CMASI and IMPACT tasks to tasks of a `Mission`."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from math import isfinite, radians
from typing import Any

from cratous.services.loading.coordinates import Places
from cratous.services.loading.uxas_cfg import Sent
from cratous.services.loading.uxas_parts import AHEAD, corners_of, looks_ahead, point
from cratous.spec.errors import BadInput
from cratous.spec.mission import Loiter, Pattern, Position, Task, TaskKind, Vehicle, View

SHAPES = {
    "VehicleDefault": "circular",
    "Circular": "circular",
    "Racetrack": "racetrack",
    "FigureEight": "figure_eight",
}
DIRECTIONS = {
    "VehicleDefault": "any",
    "Clockwise": "clockwise",
    "CounterClockwise": "counter_clockwise",
}
PATTERNS = {"Spiral": Pattern.SPIRAL, "Sector": Pattern.SECTOR, "Sweep": Pattern.SWEEP}


@dataclass(frozen=True)
class Interests:
    """Points, lines and areas of interest by id, to which IMPACT tasks refer."""

    points: dict[int, Sent] = field(default_factory=dict)
    lines: dict[int, Sent] = field(default_factory=dict)
    areas: dict[int, Sent] = field(default_factory=dict)
    entities: dict[int, Sent] = field(default_factory=dict)

    def add(self, sent: Sent) -> bool:
        """Keep the message if it is one of them; returns whether it is."""
        kind = type(sent.body).__name__
        if kind == "PointOfInterest":
            self.points[sent.body.PointID] = sent
        elif kind == "LineOfInterest":
            self.lines[sent.body.LineID] = sent
        elif kind == "AreaOfInterest":
            self.areas[sent.body.AreaID] = sent
        elif kind in ("EntityState", "GroundVehicleState", "SurfaceVehicleState"):
            self.entities[sent.body.ID] = sent
        else:
            return False
        return True


@dataclass(frozen=True)
class _Reading:
    """A task message with everything needed to read it."""

    sent: Sent
    places: Places
    vehicles: tuple[Vehicle, ...]
    interests: Interests
    notes: list[str]

    @property
    def body(self) -> Any:
        return self.sent.body

    @property
    def name(self) -> str:
        return f"task {self.body.TaskID}"

    def point(self, location: Any, item: str) -> Position:
        return point(location, self.places, self.sent, item)

    def refused(self, what: str, item: str, expected: str, got: str) -> BadInput:
        return BadInput(what, where=self.sent.where, item=item, expected=expected, got=got)

    def named(self, known: Mapping[int, Sent], number: int, item: str, kind: str) -> Any:
        """The point, line or area of interest with this id."""
        if number not in known:
            raise self.refused(
                f"{self.name} names a {kind} of interest that does not exist",
                item,
                "one of " + (", ".join(map(str, sorted(known))) or "none"),
                str(number),
            )
        return known[number].body


def other(sent: Sent, interests: Interests) -> Task | None:
    """A task of an unsupported kind, for which its own service tells how it is flown; None for a supported one."""
    body = sent.body
    if type(body).__name__ in READERS and not _watches_what_moves(body, interests):
        return None
    return Task(
        id=body.TaskID,
        kind=TaskKind.OTHER,
        label=body.Label or f"task {body.TaskID}",
        points=(),
        eligible=tuple(body.EligibleEntities),
        priority=body.Priority,
    )


def _watches_what_moves(body: Any, interests: Interests) -> bool:
    """Whether the task is a watch of a moving entity, which its own service follows."""
    sent = interests.entities.get(getattr(body, "WatchedEntityID", 0))
    return sent is not None and type(body).__name__ == "WatchTask" and _speed(sent.body) != 0


def _speed(state: Any) -> float:
    """Speed of an entity, from whatever its state contains [m/s]."""
    return float(max(abs(state.Groundspeed), abs(state.u), abs(state.v), abs(state.w)))


def task(
    sent: Sent,
    places: Places,
    vehicles: tuple[Vehicle, ...],
    notes: list[str],
    interests: Interests,
) -> Task:
    """A task; BadInput with the type if it is not supported."""
    body, kind = sent.body, type(sent.body).__name__
    if kind not in READERS:
        raise BadInput(
            f"tasks of type {kind} are not covered",
            where=sent.where,
            item=f"task {body.TaskID}",
            expected="one of " + ", ".join(READERS),
            got=kind,
        )
    reading = _Reading(sent, places, vehicles, interests, notes)
    found: dict[str, Any] = READERS[kind](reading)
    if kind.endswith("SearchTask") or kind == "WatchTask":
        found = {**_search(reading, found["kind"]), **found}
    return Task(
        id=body.TaskID,
        label=body.Label or reading.name,
        eligible=tuple(body.EligibleEntities),
        priority=body.Priority,
        **found,
    )


def _not_below_0(reading: _Reading, field: str, what: str, unit: str) -> float:
    value = float(getattr(reading.body, field))
    if not (isfinite(value) and value >= 0):
        raise reading.refused(
            f"{reading.name} has no {what}", field, f"0 or more {unit}", f"{value:g}"
        )
    return value


def _search(reading: _Reading, kind: TaskKind) -> dict[str, Any]:
    """Common fields of all search tasks: dwell time, wavelength, ground sample distance."""
    body, notes = reading.body, reading.notes
    bands = [band.name for band in body.DesiredWavelengthBands]
    if len(bands) > 1:
        notes.append(f"{reading.name}: any of the bands {', '.join(bands)} will do")
    gsd = _not_below_0(reading, "GroundSampleDistance", "ground sample distance", "meters a pixel")
    if body.DwellTime > 0 and kind is not TaskKind.POINT_SEARCH:
        notes.append(f"{reading.name}: its dwell of {body.DwellTime} ms at any point is not held")
    return {
        "duration_ms": int(body.DwellTime),
        "wavelength": bands[0] if len(bands) == 1 else "AllAny",
        "gsd_m": gsd,
    }


def _views(reading: _Reading, inertial: bool) -> dict[str, Any]:
    """The permitted view wedges, by their centrelines; none means any direction."""
    wedges = reading.body.ViewAngleList
    if any(wedge.VerticalCenterline == 0 for wedge in wedges):
        reading.notes.append(
            f"{reading.name} has a view without a tilt (VerticalCenterline 0): straight down is taken"
        )
    found = [
        View(
            radians(wedge.AzimuthCenterline),
            radians(wedge.VerticalCenterline or -90),
            bool(inertial),
            radians(wedge.AzimuthExtent),
        )
        for wedge in wedges
    ]
    return {"view": found[0] if found else None, "views": tuple(found[1:])}


def _line(reading: _Reading) -> dict[str, Any]:
    body = reading.body
    if type(body).__name__ == "ImpactLineSearchTask":
        places = reading.named(reading.interests.lines, body.LineID, "LineID", "line").Line
        item = f"line {body.LineID}"
    else:
        places, item = body.PointList, "PointList"
    points = tuple(reading.point(place, f"{item}[{k}]") for k, place in enumerate(places))
    views = _views(reading, body.UseInertialViewAngles)
    asked = reading.body.GroundSampleDistance
    if views["view"] is None and not asked and looks_ahead(reading.vehicles):
        views["views"] = (AHEAD,)
    return {"kind": TaskKind.LINE_SEARCH, "points": points, **views}


def _place(reading: _Reading) -> Position:
    """The point of interest that an IMPACT task names, otherwise its own coordinates."""
    body, number = reading.body, reading.body.SearchLocationID
    if number and (number in reading.interests.points or body.SearchLocation is None):
        known = reading.interests.points
        place = reading.named(known, number, "SearchLocationID", "point")
        return reading.point(place.Location, f"point {number}")
    return reading.point(body.SearchLocation, "SearchLocation")


def _point(reading: _Reading) -> dict[str, Any]:
    body = reading.body
    impact = type(body).__name__ == "ImpactPointSearchTask"
    place = _place(reading) if impact else reading.point(body.SearchLocation, "SearchLocation")
    standoff = _not_below_0(reading, "StandoffDistance", "standoff", "meters")
    found = {
        "kind": TaskKind.POINT_SEARCH,
        "points": (place,),
        "standoff_m": standoff,
        **_views(reading, True),
    }
    if impact and body.DesiredAction is not None and body.DesiredAction.Duration <= 0:
        reading.notes.append(
            f"{reading.name}: its DesiredAction has no duration, the point is passed for its dwell"
        )
    elif impact and body.DesiredAction is not None:
        loiter, duration_ms = _action(reading)
        dwell = max(duration_ms, int(body.DwellTime))
        found.update(loiter=loiter, duration_ms=dwell)
    return found


def _action(reading: _Reading) -> tuple[Loiter, int]:
    """The loiter that a task requests, and its duration [ms]."""
    action = reading.body.DesiredAction
    item = "DesiredAction"
    if action is None:
        raise reading.refused(f"{reading.name} has no loiter", item, "a LoiterAction", "nothing")
    shape = action.LoiterType.name
    if shape not in SHAPES:
        raise reading.refused(
            f"{reading.name} cannot be flown", f"{item}.LoiterType", ", ".join(SHAPES), shape
        )
    if action.Duration <= 0:
        raise reading.refused(
            f"{reading.name} never ends", f"{item}.Duration", "more than 0 ms", f"{action.Duration}"
        )
    sizes = {"Radius": float(action.Radius), "Length": float(action.Length)}
    for name, value in sizes.items():
        if not (isfinite(value) and value >= 0):
            raise reading.refused(
                f"{reading.name} has no size", f"{item}.{name}", "0 or more meters", f"{value:g}"
            )
    direction = DIRECTIONS[action.Direction.name]
    centre = reading.point(action.Location, f"{item}.Location")
    axis = radians(action.Axis)
    loiter = Loiter(centre, sizes["Radius"], SHAPES[shape], axis, sizes["Length"], direction)
    return loiter, int(action.Duration)


def _loiter(reading: _Reading) -> dict[str, Any]:
    loiter, duration_ms = _action(reading)
    return {
        "kind": TaskKind.LOITER,
        "points": (loiter.centre,),
        "duration_ms": duration_ms,
        "radius_m": loiter.radius_m,
        "loiter": loiter,
    }


def _must_fly(reading: _Reading) -> dict[str, Any]:
    body = reading.body
    place = reading.point(body.Position, "Position")
    if not body.UseAltitude:
        able = [
            v
            for v in reading.vehicles
            if not body.EligibleEntities or v.id in body.EligibleEntities
        ]
        height = (able or list(reading.vehicles))[0].cruise_alt_m
        place = place._replace(alt_m=height)
        reading.notes.append(f"{reading.name} uses no altitude: {height:g} m MSL is taken")
    return {"kind": TaskKind.MUST_FLY, "points": (place,)}


def _area(reading: _Reading) -> dict[str, Any]:
    return {**_outline(reading, reading.body.SearchArea, "SearchArea"), **_views(reading, True)}


def _outline(reading: _Reading, shape: Any, item: str) -> dict[str, Any]:
    corners = corners_of(
        shape,
        reading.sent,
        item,
        f"the area of {reading.name}",
        reading.places,
        reading.notes,
        outside=True,
    )
    ground = reading.places.terrain_m
    points = tuple(Position(north, east, ground) for north, east in corners)
    return {"kind": TaskKind.AREA_SEARCH, "points": points}


def _angled(reading: _Reading) -> dict[str, Any]:
    body = reading.body
    area = reading.named(reading.interests.areas, body.SearchAreaID, "SearchAreaID", "area").Area
    start = body.StartPoint
    return {
        **_outline(reading, area, f"area {body.SearchAreaID}"),
        "sweep_rad": radians(body.SweepAngle),
        "start_point": None if start is None else reading.point(start, "StartPoint"),
    }


def _pattern(reading: _Reading) -> dict[str, Any]:
    body = reading.body
    extent = float(body.Extent)
    if extent == 0:
        reading.notes.append(f"{reading.name} has no extent: its pattern is a pass over its point")
        return {"kind": TaskKind.POINT_SEARCH, "points": (_place(reading),)}
    if not (isfinite(extent) and extent > 0):
        raise reading.refused(
            f"{reading.name} has no extent", "Extent", "more than 0 m", f"{extent:g} m"
        )
    return {
        "kind": TaskKind.PATTERN_SEARCH,
        "points": (_place(reading),),
        "pattern": PATTERNS[body.Pattern.name],
        "extent_m": extent,
    }


def _watch(reading: _Reading) -> dict[str, Any]:
    """A stationary entity is watched at its position; a moving one is followed by its service."""
    number = reading.body.WatchedEntityID
    state = reading.named(reading.interests.entities, number, "WatchedEntityID", "entity")
    speed = _speed(state)
    if not speed == 0:
        raise reading.refused(
            f"{reading.name} watches entity {number}, which moves; `cratous uxas` alone follows it",
            "WatchedEntityID",
            "an entity whose state says that it stands still",
            f"{speed:g} m/s",
        )
    reading.notes.append(
        f"{reading.name} watches entity {number} where its state says that it stands, "
        "for its dwell time, once"
    )
    return {"kind": TaskKind.POINT_SEARCH, "points": (reading.point(state.Location, "Location"),)}


READERS: dict[str, Callable[[_Reading], dict[str, Any]]] = {
    "LineSearchTask": _line,
    "PointSearchTask": _point,
    "AreaSearchTask": _area,
    "MustFlyTask": _must_fly,
    "LoiterTask": _loiter,
    "ImpactLineSearchTask": _line,
    "ImpactPointSearchTask": _point,
    "AngledAreaSearchTask": _angled,
    "PatternSearchTask": _pattern,
    "WatchTask": _watch,
}
