"""A mission as ICAROUS files: a vehicle's route as `QGC WPL 110`, zones as geofence XML.

A plan's first waypoint is the vehicle's start. Altitudes of plans are above mean sea level (frame
0); floors and roofs of fences are above the ground at home, as `cratous import` reads them.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from cratous.services.mission.frames import Projection
from cratous.services.planning.smoothing import without_collinear
from cratous.spec import algebra
from cratous.spec.algebra import PARALLEL, SEQUENTIAL, Atom
from cratous.spec.errors import BadInput
from cratous.spec.mission import Mission, Position, TaskKind, Vehicle, ZoneKind
from cratous.spec.mission.plan import Plan

QGC, GEOFENCE = "qgc", "geofence"
HEAD = "QGC WPL 110"
MSL, WAYPOINT, SPEED, GROUND_SPEED = 0, 16, 178, 1


def flight_plan_text(mission: Mission, vehicle_id: int | None, plan: Plan | None) -> str:
    """The route of a vehicle (of the only one if none is named): its planned route, or without a
    plan the waypoints that the mission lets it fly in a unique order.

    Raises BadInput if there is no such vehicle, no unique order, or nothing to fly.
    """
    vehicle = _vehicle(mission, vehicle_id)
    points = _waypoints(mission, vehicle) if plan is None else _route(plan, vehicle)
    if not points:
        raise BadInput(
            "a vehicle that flies nowhere", where=mission.source, item=f"vehicle {vehicle.id}",
            expected="one with a task",
        )  # fmt: skip
    speed = vehicle.speed_m_s if plan is None else plan.chain(vehicle.id)[0].speed_m_s
    plane = Projection(mission.frame)
    rows = [HEAD, _row(0, WAYPOINT, vehicle.position, plane, home=True)]
    rows.append(
        "\t".join(["1", "0", "0", str(SPEED), str(GROUND_SPEED), f"{speed:.9g}", *"00000", "1"])
    )
    rows += [_row(k, WAYPOINT, point, plane) for k, point in enumerate(points, 2)]
    return "\n".join(rows) + "\n"


def _vehicle(mission: Mission, number: int | None) -> Vehicle:
    known = [vehicle.id for vehicle in mission.vehicles]
    if number is None and len(known) > 1:
        raise BadInput(
            "a flight plan is of one vehicle", where=mission.source, item="--vehicle",
            expected="one of " + ", ".join(map(str, known)),
        )  # fmt: skip
    if number is not None and number not in known:
        raise BadInput(
            f"vehicle {number} does not exist", where=mission.source, item="--vehicle",
            expected="one of " + ", ".join(map(str, known)), got=str(number),
        )  # fmt: skip
    return mission.vehicles[0] if number is None else mission.vehicle(number)


def _route(plan: Plan, vehicle: Vehicle) -> Sequence[Position]:
    """The flown path, without points on a straight leg of constant altitude."""
    points = [p for item in plan.chain(vehicle.id) for p in (*item.transit, *item.path)]
    if not points:
        return ()
    if not {p.alt_m for p in points} - {vehicle.position.alt_m}:
        points = list(without_collinear([vehicle.position, *points])[1:])
    return [p for k, p in enumerate(points) if p != (points[k - 1] if k else vehicle.position)]


def _waypoints(mission: Mission, vehicle: Vehicle) -> Sequence[Position]:
    alone = len(mission.vehicles) == 1
    mine = {
        t.id: t for t in mission.tasks if t.eligible == (vehicle.id,) or (alone and not t.eligible)
    }
    shared = [
        t.id
        for t in mission.tasks
        if t.id not in mine and vehicle.id in (t.eligible or (vehicle.id,))
    ]
    others = [t.id for t in mine.values() if t.kind is not TaskKind.MUST_FLY]
    order = _order(mission, mine)
    if shared or others or order is None:
        why = "tasks in no one order"
        if shared or others:
            why = f"task {(shared or others)[0]}"
        raise BadInput(
            "the way of the vehicle is for the plan to say", where=mission.source,
            item=f"vehicle {vehicle.id}", expected="a plan (--plan), or points to fly through in one order, its own",
            got=why,
        )  # fmt: skip
    return [mine[number].points[0] for number in order]


def _order(mission: Mission, mine: Iterable[int]) -> list[int] | None:
    """The tasks in the only order that the relations allow; None if there are several."""
    ids = frozenset(mine)
    if len(ids) <= 1:
        return list(ids)
    if not mission.relations.strip():
        return None
    known = frozenset(task.id for task in mission.tasks)
    term = algebra.parse(mission.relations, known, where=mission.source)
    if isinstance(term, Atom) or term.op not in (SEQUENTIAL, PARALLEL):
        return None
    for part in [term] if term.op == SEQUENTIAL else term.operands:
        if isinstance(part, Atom) or part.op != SEQUENTIAL:
            continue
        row = [one.task for one in part.operands if isinstance(one, Atom)]
        if len(row) == len(part.operands) and ids == set(row):
            return row
    return None


def _row(k: int, command: int, place: Position, plane: Projection, *, home: bool = False) -> str:
    latitude, longitude = plane.to_geodetic(place.north_m, place.east_m)
    places = [f"{latitude:.9f}", f"{longitude:.9f}", f"{place.alt_m:.3f}"]
    return "\t".join([str(k), str(int(home)), str(MSL), str(command), *"0000", *places, "1"])


def geofence_text(mission: Mission) -> str:
    """All zones, one fence each, with the mission's ids. BadInput if there is none."""
    if not mission.zones:
        raise BadInput(
            "a mission without zones", where=mission.source, item="zones", expected="one or more"
        )
    plane, ground_m = Projection(mission.frame), mission.frame.terrain_m
    rows = ['<?xml version="1.0" encoding="UTF-8"?>', "<Geofence>"]
    for zone in mission.zones:
        kind = "KEEPOUT" if zone.kind is ZoneKind.KEEP_OUT else "KEEPIN"
        rows += [
            f'  <fence id="{zone.id}">',
            f"    <type>{kind}</type>",
            f"    <num_vertices>{len(zone.vertices)}</num_vertices>",
            f"    <floor>{zone.floor_m - ground_m:.12g}</floor>",
            f"    <roof>{zone.ceiling_m - ground_m:.12g}</roof>",
        ]
        for k, (north_m, east_m) in enumerate(zone.vertices):
            lat, lon = plane.to_geodetic(north_m, east_m)
            rows.append(f'    <vertex id="{k}"><lat>{lat:.9f}</lat><lon>{lon:.9f}</lon></vertex>')
        rows.append("  </fence>")
    return "\n".join([*rows, "</Geofence>"]) + "\n"


def unsaid_of(mission: Mission, form: str) -> list[str]:
    """What these files do not represent of the mission, in words, section by section."""
    found = []
    if form == QGC:
        found.append("vehicles: limits and heading of the vehicle; other vehicles")
        if mission.zones:
            found.append("zones: they are a file of their own, --format geofence")
        if mission.relations.strip():
            found.append("relations: but for the order of the waypoints")
    else:
        found += ["vehicles: none", "tasks: none"]
        labels = [str(zone.id) for zone in mission.zones if zone.label]
        if labels:
            found.append(f"zones: the labels of {', '.join(labels)}")
    found += [f"{name}: none" for name in ("traffic", "changes") if getattr(mission, name)]
    return [*found, "daa: none, ICAROUS has a parameter file"]
