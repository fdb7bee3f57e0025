"""The mission as the judge uses it, from the data in a log. See also `mission_file`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from cratous.judge.declared import AfterFailure, after_failure
from cratous.judge.fields import Node
from cratous.judge.outlines import Point as Point
from cratous.judge.outlines import Zone as Zone
from cratous.judge.outlines import drifting, refuse_bad_ring, zone
from cratous.judge.outlines import pair as pair
from cratous.judge.outlines import with_ends as with_ends
from cratous.judge.sites import Fix, Site, fix_of, site_of
from cratous.judge.views import in_log

SEARCHES = ("line_search", "point_search", "area_search", "pattern_search")
KINDS = (*SEARCHES, "must_fly", "loiter")
Said = dict[int, tuple[tuple[int, bool], ...]]
"""By number: when it was announced as present (True) or absent, in time order [ms]."""
CHANGES = (
    "zone", "zone_ends", "vehicle_lost", "vehicle_joins", "task_added", "task_removed", "wind",
    "vehicle_holds", "vehicle_resumes",
)  # fmt: skip
ASK_NOTHING = ("wind", "vehicle_holds", "vehicle_resumes")
"""Changes that neither add nor remove requests."""


class Camera(NamedTuple):
    """A camera, by the payload that reports it."""

    payload: int
    wavelength: str
    pixels: int


@dataclass(frozen=True)
class Vehicle:
    """A mission vehicle."""

    id: int
    protected: bool
    speed_m_s: float
    bank_rad: float
    cameras: tuple[Camera, ...] = ()
    ground_m: float | None = None
    """Ground height at its start [m MSL]; None if it starts in the air."""
    fastest_m_s: float = 0.0


@dataclass(frozen=True)
class Task:
    """A requested task. shape, size_m, length_m: of a loiter; pattern, extent_m: of a pattern; views_deg: see
    `views`."""

    id: int
    kind: str
    points: tuple[Point, ...]
    eligible: frozenset[int]
    duration_ms: int = 0
    standoff_m: float = 0.0
    gsd_m: float = 0.0
    wavelength: str = "AllAny"
    shape: str = ""
    radius_m: float = 0.0
    length_m: float = 0.0
    pattern: str = ""
    extent_m: float = 0.0
    views_deg: tuple[float, ...] = ()


class Traffic(NamedTuple):
    """A traffic aircraft, and when it is present."""

    id: int
    appears_ms: int
    vanishes_ms: int | None


class WithoutLink(NamedTuple):
    """The lost-link procedure, as in the log; the silence that starts it; whether lines fail while a link is up."""

    choice: str
    after_ms: int
    lines_fail: bool


SILENCE_MS = 2000
LOITER = "Loiter"
CHOICES = ("finish", "loiter", "return", "land")


class Volume(NamedTuple):
    """The well-clear volume: DTHR and ZTHR [m], TTHR and TCOA [s]."""

    dthr_m: float
    zthr_m: float
    tthr_s: float
    tcoa_s: float


@dataclass(frozen=True)
class Mission:
    """The whole mission. lost, joins, added, removed: times by id [ms]; terrain_m: ground outside the sites; senses: by
    sensors; lost_link_after_ms: silence after which the link is lost; safe_state_after_ms: how long it circles then."""

    name: str
    latitude_deg: float
    longitude_deg: float
    vehicles: dict[int, Vehicle]
    tasks: dict[int, Task]
    zones: tuple[Zone, ...]
    traffic: tuple[Traffic, ...]
    relations: str
    instances: frozenset[int]
    volume: Volume
    step_ms: int = 250
    heartbeat_ms: int = 500
    faulty_bridge: bool = False
    limit_ms: int = 7_200_000
    seed: int = 0
    vehicle_said: Said = field(default_factory=dict)
    task_said: Said = field(default_factory=dict)
    terrain_m: float = 0.0
    sites: tuple[Site, ...] = ()
    without_link: WithoutLink | None = None
    after_failure: AfterFailure | None = None
    fix: Fix | None = None
    senses: bool = False
    lost_link_after_ms: int = 30_000
    safe_state_after_ms: int = 120_000

    @property
    def grounds(self) -> dict[int, float]:
        """Ground height below each vehicle that starts on it, by id [m MSL]."""
        return {v.id: v.ground_m for v in self.vehicles.values() if v.ground_m is not None}

    @property
    def silence_ms(self) -> int:
        """Maximum silence of UxAS while a vehicle rolls [ms]."""
        return SILENCE_MS if self.without_link is None else self.without_link.after_ms

    @property
    def protected(self) -> list[int]:
        """The vehicles to which the guarantees apply."""
        return sorted(v.id for v in self.vehicles.values() if v.protected)


def said_of(changes: Sequence[tuple[str, int, int]], enters: str, leaves: str) -> Said:
    """Announcements of vehicles or tasks in changes (kind, number, time), by time."""
    found: dict[int, list[tuple[int, bool]]] = {}
    for kind, number, at in sorted(changes, key=lambda change: change[2]):
        if kind in (enters, leaves):
            found.setdefault(number, []).append((at, kind == enters))
    return {number: tuple(entries) for number, entries in found.items()}


def away_because(said: Said, number: int, at_ms: int) -> str:
    """`left` or `to come` if it is absent both at an instant and just before; otherwise empty.

    The last announcement counts; what is first announced as coming was absent before."""
    entries = said.get(number, ())
    before = [there for at, there in entries if at < at_ms]
    now = [there for at, there in entries if at <= at_ms]
    first = not entries or not entries[0][1]
    if (before[-1] if before else first) or (now[-1] if now else first):
        return ""
    return "left" if now else "to come"


def from_log(data: Node) -> Mission:
    """The mission in a log's meta data; BadInput if it is invalid."""
    frame, simulation, daa = data["frame"], data["simulation"], data["daa"]["well_clear"]
    zones, said, ends = [zone(z) for z in data["zones"] if not z.has("moving")], [], []
    drift = drifting(data)
    for change in data["changes"]:
        kind, at = change["kind"].one_of(*CHANGES), _not_negative(change["at_ms"])
        if kind == "zone":
            zones += [] if change["zone"].has("moving") else [zone(change["zone"], at)]
        elif kind == "zone_ends" and change["zone_id"].whole not in drift:
            ends.append((change["zone_id"], at))
        elif kind not in (*ASK_NOTHING, "zone_ends"):
            number = change["vehicle" if kind.startswith("vehicle") else "task"].whole
            said.append((kind, number, at))
    volume = Volume(*(daa[name].real for name in Volume._fields))
    without_link, sites = None, tuple[Site, ...]()
    if data["daa"].has("link_loss"):
        loss = data["daa"]["link_loss"]
        fails = lines_fail(simulation.get("bridge_faults"), "_ms")
        choice = loss["choice"].one_of(*CHOICES).capitalize()
        without_link = WithoutLink(choice, _not_negative(loss["after_ms"]), fails)
        sites = tuple(site_of(one) for one in loss.get("sites", []))
    if failing := data["daa"].has("on_failure"):
        sites = tuple(site_of(one) for one in data["daa"]["on_failure"]["sites"])
    mission = Mission(
        name=data["name"].text,
        latitude_deg=frame["latitude_deg"].real,
        longitude_deg=frame["longitude_deg"].real,
        vehicles=by_id([_vehicle(v) for v in data["vehicles"]], data["vehicles"]),
        tasks=by_id([_task(t) for t in data["tasks"]], data["tasks"]),
        zones=(*with_ends(zones, ends), *drift.values()),
        traffic=tuple(_traffic(t) for t in data["traffic"]),
        relations=data["relations"].text,
        instances=frozenset(n.whole for n in data["instances"]),
        volume=volume,
        step_ms=positive(simulation["step_ms"]),
        heartbeat_ms=positive(simulation["heartbeat_ms"]),
        faulty_bridge=simulation.has("bridge_faults"),
        limit_ms=positive(simulation["limit_ms"]),
        seed=data["seed"].whole,
        vehicle_said=said_of(said, "vehicle_joins", "vehicle_lost"),
        task_said=said_of(said, "task_added", "task_removed"),
        terrain_m=frame.get("terrain_m", 0.0).real,
        sites=sites,
        without_link=without_link,
        after_failure=after_failure(data["daa"]["on_failure"]) if failing else None,
        fix=fix_of(data["daa"]["merging"]) if data["daa"].has("merging") else None,
        senses=data["daa"].has("sensing"),
        lost_link_after_ms=positive(data.get("bridge", {}).get("lost_link_after_ms", 30_000)),
        safe_state_after_ms=positive(data.get("bridge", {}).get("safe_state_after_ms", 120_000)),
    )
    check(mission, data)
    return mission


def check(mission: Mission, data: Node) -> None:
    """Checks of a mission, from whichever source."""
    if min(mission.volume) < 0:
        raise data["daa"].wrong("a well-clear volume without negative sizes")
    if not abs(mission.latitude_deg) <= 90:
        raise data["frame"].wrong("a latitude from -90 to 90")
    if mission.fix is not None and not mission.fix.vehicles <= mission.vehicles.keys():
        raise data["merging" if data.has("merging") else "daa"].wrong("vehicles that exist")
    if not mission.instances <= mission.vehicles.keys():
        raise data["instances"].wrong("vehicles that exist")
    known = {*mission.vehicles, *mission.tasks}
    named = [*mission.vehicle_said, *mission.task_said]
    if strange := [n for n in named if n not in known]:
        raise data["changes"].wrong(f"vehicles and tasks that exist, not {strange[0]}")


def lines_fail(faults: Node, unit: str) -> bool:
    """Whether bridge faults lose, damage or delay lines, or ICAROUS stops reading. unit: suffix of names."""
    if not isinstance(faults.data, dict):
        return False
    shares = ("loss", "truncation", "corruption", f"delay{unit}")
    stops = faults.has(f"stops_reading{unit}")
    return stops or any(faults.get(name, 0).real for name in shares)


def by_id(found: Sequence[Any], data: Node) -> dict[int, Any]:
    """Items by id; BadInput for a duplicate."""
    numbers = [one.id for one in found]
    if len(set(numbers)) != len(numbers):
        raise data.wrong("each id once")
    return dict(zip(numbers, found, strict=True))


def _not_negative(data: Node) -> int:
    if data.whole < 0:
        raise data.wrong("0 or more")
    return data.whole


def positive(data: Node) -> int:
    """A positive integer."""
    if data.whole <= 0:
        raise data.wrong("more than 0")
    return data.whole


def _vehicle(data: Node) -> Vehicle:
    cameras = tuple(
        Camera(c["payload_id"].whole, c["wavelength"].text, c["pixels"].whole)
        for c in data["cameras"]
    )
    return Vehicle(
        data["id"].whole,
        data["protected"].flag,
        data["speed_m_s"].real,
        data["max_bank_rad"].real,
        cameras,
        data["ground_m"].real if data.has("ground_m") else None,
        data.get("max_speed_m_s", data["speed_m_s"].real).real,
    )


def _task(data: Node) -> Task:
    kind = data["kind"].one_of(*KINDS)
    points = tuple((p["north_m"].real, p["east_m"].real) for p in data["points"])
    shape, radius, length = "", data["radius_m"].real, 0.0
    if data.has("loiter"):
        loiter = data["loiter"]
        shape, radius = loiter["shape"].text, loiter["radius_m"].real
        length = loiter["length_m"].real
        if kind == "loiter":
            points = ((loiter["centre"]["north_m"].real, loiter["centre"]["east_m"].real),)
    found = Task(
        id=data["id"].whole,
        kind=kind,
        points=points,
        eligible=frozenset(n.whole for n in data["eligible"]),
        duration_ms=_not_negative(data["duration_ms"]),
        standoff_m=data["standoff_m"].real,
        gsd_m=data["gsd_m"].real,
        wavelength=data["wavelength"].text,
        shape=shape,
        radius_m=radius,
        length_m=length,
        pattern=data["pattern"].text if data.has("pattern") else "",
        extent_m=data["extent_m"].real,
        views_deg=in_log(data),
    )
    check_task(found, data)
    return found


def check_task(task: Task, data: Node) -> None:
    """BadInput if a task has no position."""
    least = {"line_search": 2, "area_search": 3}.get(task.kind, 1)
    if len(task.points) < least:
        raise data.get("points").wrong(f"at least {least} points")
    if task.kind == "area_search":
        refuse_bad_ring(task.points, data.get("points"))
    if task.kind == "pattern_search":
        data["pattern"].one_of("spiral", "square", "sector", "sweep")
    if task.kind == "pattern_search" and task.extent_m <= 0:
        raise data["extent_m"].wrong("more than 0")


def _traffic(data: Node) -> Traffic:
    vanishes = data["vanishes_ms"].whole if data.has("vanishes_ms") else None
    return Traffic(data["id"].whole, data["appears_ms"].whole, vanishes)
