"""Composes a mission file: a vehicle for each route, its waypoints as tasks in sequence, zones, traffic."""

from __future__ import annotations

from collections.abc import Sequence
from math import atan2, degrees
from typing import Any, NamedTuple

from cratous.services.importing.imported_content import Fence, Intruder, Parts, Place, Way
from cratous.services.loading.yaml_daa import DEFAULT_WELL_CLEAR
from cratous.services.mission.frames import Projection
from cratous.services.parameters.mapping import Setting, settings_of
from cratous.services.parameters.parameter_file import default_of
from cratous.spec.errors import BadInput
from cratous.spec.mission import Daa, Frame

TASKS_MOST, FIRST = 64, 100
"""Maximum number of tasks of a mission; the tasks of vehicle k are numbered from FIRST * k + 1."""
VOLUME = ("dthr_m", "zthr_m", "tthr_s", "tcoa_s")
LOWEST_M, HIGHEST_M = -1000.0, 100_000.0
"""Altitudes of a zone without any [m]."""


class Asked(NamedTuple):
    """The user's options. name: of the mission; speed_m_s: of routes without speed; terrain_m:
    ground at home [m MSL].
    """

    name: str
    speed_m_s: float | None = None
    terrain_m: float = 0.0


class Composed(NamedTuple):
    """data: of a mission file; notes: decisions made and contents omitted, in words."""

    data: dict[str, Any]
    notes: tuple[str, ...]


def composed(parts: Parts, asked: Asked) -> Composed:
    """The mission of all parts. Home is the start of the first route. Raises BadInput if something
    is missing that a mission needs; the reader of mission files checks whether it can be flown.
    """
    notes = list(parts.notes)
    ways = [_without_repeats(way, notes) for way in parts.ways]
    for way in ways if not asked.terrain_m else ():
        start = way.places[0]
        if not start.above_ground and any(place.above_ground for place in way.places):
            notes.append(
                f"{way.where}: altitudes above home count from the ground at 0 m (--terrain), and it starts at "
                f"{start.alt_m:g} m above sea level"
            )
    home = ways[0].places[0]
    plane = Projection(Frame(home.latitude_deg, home.longitude_deg, asked.terrain_m))
    given = parts.parameters or {}
    settings = settings_of(given, 1.0)
    vehicles, tasks, relations = [], [], []
    whole = sum(len(way.places) - 1 for way in ways) <= TASKS_MOST
    numbers = _free(len(ways), parts.intruders)
    for k, way in zip(numbers, ways, strict=True):
        speed = _speed_of(way, asked, settings)
        vehicle = _vehicle(k, way, plane, asked, (speed, settings_of(given, speed)))
        mine = _waypoints(k, way, asked) if whole else [_line(k, way, vehicle, asked, notes)]
        vehicles.append(vehicle)
        tasks += mine
        row = " ".join(f"p{task['id']}" for task in mine)
        relations.append(f".({row})" if len(mine) > 1 else row)
    data: dict[str, Any] = {
        "name": asked.name,
        "frame": {
            "latitude_deg": home.latitude_deg,
            "longitude_deg": home.longitude_deg,
            "terrain_m": asked.terrain_m,
        },
        "vehicles": vehicles,
        "tasks": tasks,
        "relations": relations[0] if len(relations) == 1 else f"|({' '.join(relations)})",
    }
    if parts.fences:
        data["zones"] = [
            _zone(k, fence, asked, settings) for k, fence in enumerate(parts.fences, 1)
        ]
    if parts.intruders:
        data["traffic"] = _traffic(parts.intruders, numbers, asked, notes)
    data.update(_rest(settings, parts, notes))
    return Composed(data, tuple(dict.fromkeys(notes)))


def _free(count: int, intruders: Sequence[Intruder]) -> list[int]:
    """The first ids not used by an intruder, since intruders keep theirs."""
    taken = {one.id for one in intruders}
    return [k for k in range(1, count + len(taken) + 1) if k not in taken][:count]


def _without_repeats(way: Way, notes: list[str]) -> Way:
    places = [p for k, p in enumerate(way.places) if not k or p[:3] != way.places[k - 1][:3]]
    if len(places) < 2:
        raise BadInput(
            "a plan that leads nowhere", where=way.where, item=way.label,
            expected="two waypoints that differ", got="one place",
        )  # fmt: skip
    if len(places) < len(way.places):
        notes.append(f"{way.where}: waypoints that repeat the one before are left out")
    return way._replace(places=tuple(places))


def _speed_of(way: Way, asked: Asked, settings: dict[str, Setting]) -> float:
    said = settings.get("vehicles[].speed_m_s")
    speed = way.speed_m_s or asked.speed_m_s or (said.value if said else None)
    if not speed:
        raise BadInput(
            "a plan without a speed", where=way.where, item=way.label,
            expected="a speed in the plan, --speed M_S, or default_wp_speed in a parameter file",
        )  # fmt: skip
    return float(speed)


def _vehicle(
    k: int, way: Way, plane: Projection, asked: Asked, flying: tuple[float, dict[str, Setting]]
) -> dict[str, Any]:
    """The vehicle of a route. flying: its cruise speed, and the parameter settings at that speed."""
    speed, settings = flying
    start, then = (plane.to_local(p.latitude_deg, p.longitude_deg) for p in way.places[:2])
    heading = degrees(atan2(then[1] - start[1], then[0] - start[0])) % 360
    found: dict[str, Any] = {
        "id": k,
        "label": way.label,
        "position": _point(way.places[0], asked),
        "heading_deg": round(heading, 3),
        "speed_m_s": speed,
    }
    for name in ("min_speed_m_s", "max_speed_m_s", "max_bank_deg", "max_climb_m_s"):
        setting = settings.get(f"vehicles[].{name}")
        if setting is not None:
            found[name] = round(setting.value, 9)
    return found


def _point(place: Place, asked: Asked) -> dict[str, Any]:
    return {
        "latitude_deg": place.latitude_deg,
        "longitude_deg": place.longitude_deg,
        "alt_m": round(place.alt_m + asked.terrain_m * place.above_ground, 6),
    }


def _waypoints(k: int, way: Way, asked: Asked) -> list[dict[str, Any]]:
    return [
        {
            "id": FIRST * k + j,
            "kind": "must_fly",
            "label": f"{way.label}, waypoint {j}",
            "eligible": [k],
            "points": [_point(place, asked)],
        }
        for j, place in enumerate(way.places[1:], 1)
    ]


def _line(
    k: int, way: Way, vehicle: dict[str, Any], asked: Asked, notes: list[str]
) -> dict[str, Any]:
    points = [_point(place, asked) for place in way.places]
    heights = {point["alt_m"] for point in points}
    if len(heights) > 1:
        raise BadInput(
            "a long plan that changes its altitude", where=way.where, item=way.label,
            expected=f"at most {TASKS_MOST} waypoints in all plans, or one altitude",
            got=f"{len(points)} places, {len(heights)} altitudes",
        )  # fmt: skip
    notes.append(
        f"{way.where}: more than {TASKS_MOST} waypoints in all, so the way is one task: a line to fly along"
    )
    vehicle["cruise_m"] = heights.pop()
    return {
        "id": FIRST * k + 1,
        "kind": "line_search",
        "label": way.label,
        "eligible": [k],
        "points": points,
    }


def _zone(k: int, fence: Fence, asked: Asked, settings: dict[str, Setting]) -> dict[str, Any]:
    up_m = asked.terrain_m if fence.above_ground else 0.0
    found: dict[str, Any] = {
        "id": k,
        "kind": "keep_out" if fence.keep_out else "keep_in",
        "label": fence.label,
        "vertices": [{"latitude_deg": lat, "longitude_deg": lon} for lat, lon in fence.corners],
        "floor_m": LOWEST_M if fence.floor_m is None else fence.floor_m + up_m,
        "ceiling_m": HIGHEST_M if fence.ceiling_m is None else fence.ceiling_m + up_m,
    }
    padding = settings.get("zones[].padding_m")
    if padding is not None and fence.keep_out:
        found["padding_m"] = padding.value
    return found


def _traffic(
    intruders: Sequence[Intruder], vehicles: Sequence[int], asked: Asked, notes: list[str]
) -> list[dict[str, Any]]:
    taken, rows = set(vehicles), []
    for one in intruders:
        number = one.id
        while number in taken:
            number += 1000
        if number != one.id:
            notes.append(f"{one.where}: aircraft {one.id} is traffic {number}: the id is taken")
        taken.add(number)
        up_m = asked.terrain_m
        if one.place is None:
            position = {
                "north_m": round(one.north_m, 6), "east_m": round(one.east_m, 6),
                "alt_m": one.alt_m + up_m,
            }  # fmt: skip
        else:
            position = _point(one.place, asked)
        north, east, down = (round(v, 9) + 0.0 for v in one.velocity)
        row: dict[str, Any] = {
            "id": number,
            "position": position,
            "velocity": {"north_m_s": north, "east_m_s": east, "down_m_s": down},
        }
        if one.appears_s:
            row["appears_s"] = one.appears_s
        rows.append(row)
    return rows


def _rest(settings: dict[str, Setting], parts: Parts, notes: list[str]) -> dict[str, Any]:
    """The parameters that apply to the whole mission."""
    found: dict[str, Any] = {}
    thresholds = {
        name: settings[f"daa.well_clear.{name}"].value
        for name in VOLUME
        if f"daa.well_clear.{name}" in settings
    }
    if thresholds:
        found["daa"] = {"well_clear": thresholds}
    if "daa.lookahead_s" in settings:
        found.setdefault("daa", {})["lookahead_s"] = settings["daa.lookahead_s"].value
    told = "daa.guidance."
    guidance = {
        item.removeprefix(told): one.value
        for item, one in settings.items()
        if item.startswith(told)
    }
    if guidance:
        found.setdefault("daa", {})["guidance"] = guidance
    if "bridge.instances" in settings:
        found["bridge"] = {"instances": settings["bridge.instances"].value}
    if found.get("bridge"):
        notes.append("passive_mode: no vehicle has an ICAROUS, so nobody avoids anybody")
    ours = Daa(DEFAULT_WELL_CLEAR)
    left = [
        f"{name.partition('_')[0].upper()} {getattr(ours.well_clear, name):g} {name[-1]}"
        for name in VOLUME
        if name not in thresholds
    ]
    if "daa.lookahead_s" not in settings:
        left.append(f"look-ahead {ours.lookahead_s:g} s")
    if left:
        why = "no" if parts.parameters is None else "not in the"
        notes.append(f"{why} parameter file: {', '.join(left)} (our default)")
    unused = [
        one.name.name
        for one in (parts.parameters or {}).values()
        if not one.name.item and one.value != default_of(one.name)
    ]
    if unused:
        notes.append(
            f"not the default of ICAROUS, and not used here: {', '.join(unused)} (`cratous params --icarous FILE` says why)"
        )
    return found
