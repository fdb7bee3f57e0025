"""FollowPathCommand: paths as missions, and their begin and end times."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from itertools import count
from typing import Any, NamedTuple

from cratous.bridge import lmcp
from cratous.spec.errors import BadInput

COPIED = ("Latitude", "Longitude", "Altitude", "Speed", "TurnType", "AssociatedTasks")
STEERING = frozenset(("LoiterAction", "GoToWaypointAction", "FlightDirectorAction"))
"""Actions that direct a vehicle somewhere."""


def steers(body: Any) -> bool:
    """Whether a command directs a vehicle somewhere."""
    kinds = {type(one).__name__ for one in body.VehicleActionList}
    return type(body).__name__ != "VehicleActionCommand" or bool(kinds & STEERING)


def is_over(body: Any) -> bool:
    """Whether a command ends its vehicle's mission: a MissionCommand without waypoints."""
    return type(body).__name__ == "MissionCommand" and not body.WaypointList


class Path(NamedTuple):
    """A path as a MissionCommand. told: reported numbers of duplicated waypoints, by their numbers in the
    mission.
    """

    mission: Any
    told: Mapping[int, int]


def path_of(body: Any, circle_m: Callable[[float], float] | None) -> Path:
    """The mission for a FollowPathCommand: a pause becomes a loiter of type Hover.

    circle_m: circle radius by speed [m/s] of a vehicle that flies, which ends circling at the last place;
    None for one that stops there. A loop leads from the end to the beginning; for a reversing path the
    waypoints of the way back get new numbers.
    """
    known = {w.Number: w for w in reversed(body.WaypointList)}
    order, number = list[Any](), body.FirstWaypoint
    while number in known:
        order.append(known.pop(number))
        number = order[-1].NextWaypoint
    mode = body.RepeatMode.name
    numbers, told = [w.Number for w in order], dict[int, int]()
    if mode == "ReverseCourse":
        taken = {w.Number for w in body.WaypointList}
        free = (n for n in count(1) if n not in taken)
        for w, number in zip(order[-2:0:-1], free, strict=False):
            numbers.append(number)
            told[number] = w.Number
            order.append(w)
    again = mode != "SinglePass" and len(order) > 1
    ways = []
    for k, w in enumerate(order):
        last = k == len(order) - 1 and not again
        actions = list(w.VehicleActionList)
        if w.PauseTime > 0 or (last and circle_m is not None):
            # duration 0 means unlimited
            actions.append(_pause(w, 0 if last and circle_m is not None else w.PauseTime, circle_m))
        then = numbers[k] if last else numbers[(k + 1) % len(numbers)]
        ways.append(
            lmcp.new(
                "Waypoint", Number=numbers[k], NextWaypoint=then, VehicleActionList=actions,
                **{name: getattr(w, name) for name in COPIED},
            )
        )  # fmt: skip
    mission = lmcp.new(
        "MissionCommand", CommandID=body.CommandID, VehicleID=body.VehicleID,
        FirstWaypoint=body.FirstWaypoint, WaypointList=ways,
    )  # fmt: skip
    return Path(mission, told)


def _pause(w: Any, duration_ms: int, circle_m: Callable[[float], float] | None) -> Any:
    place = {name: getattr(w, name) for name in ("Latitude", "Longitude", "Altitude")}
    circle = {} if circle_m is None else {"Radius": circle_m(w.Speed), "Airspeed": w.Speed}
    return lmcp.new(
        "LoiterAction", LoiterType="Hover", Duration=duration_ms,
        Location=lmcp.new("Location3D", **place), **circle,
    )  # fmt: skip


def check_times(body: Any, where: str) -> None:
    """BadInput for a FollowPathCommand with invalid times, or one that ends before it begins."""
    begins, ends = body.StartTime, body.StopTime
    if begins < 0 or ends < 0 or 0 < ends <= begins:
        raise BadInput(
            "a path that ends before it begins", where=where,
            item=f"FollowPathCommand {body.CommandID}",
            expected="StartTime at least 0, StopTime 0 or after it [ms]", got=f"{begins}, {ends}",
        )  # fmt: skip


class Paths:
    """The paths of vehicles that are still to begin or end; the last one commanded for each."""

    def __init__(self) -> None:
        self._held: dict[int, tuple[Any, bool]] = {}

    def __bool__(self) -> bool:
        return bool(self._held)

    def hold(self, body: Any) -> None:
        """Accept a FollowPathCommand, which begins when it is due."""
        self._held[body.VehicleID] = body, False

    def drop(self, key: int) -> None:
        """Drop a vehicle's path: it got another command, or was removed."""
        self._held.pop(key, None)

    def due(self, time_ms: int) -> Iterator[tuple[Any, bool]]:
        """Paths that begin by now, with True, and those that end, with False."""
        for key, (body, begun) in list(self._held.items()):
            if not begun and body.StartTime <= time_ms:
                self._held[key] = body, True
                yield body, True
                begun = True
            if begun and not body.StopTime:
                del self._held[key]
            elif begun and body.StopTime <= time_ms:
                del self._held[key]
                yield body, False
