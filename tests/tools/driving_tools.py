"""What drives or sails, for tests of the simulator: one vehicle at 30 N, 87 W, and what it is told."""

from __future__ import annotations

import math
from typing import Any

from cratous.bridge import lmcp

LAT, LON = 30.0, -87.0
METRE = math.degrees(1 / 6_378_137.0)


def at(north_m: float, east_m: float) -> dict[str, float]:
    """A place by metres from where the vehicle begins."""
    scale = METRE / math.cos(math.radians(LAT))
    return {"Latitude": LAT + METRE * north_m, "Longitude": LON + scale * east_m}


def vehicle(kind: str = "Ground", **more: Any) -> list[Any]:
    """Configuration and state of one that stands and heads north, 8 m/s as a rule and 12 at most."""
    values = {"ID": 1, "NominalSpeed": 8.0, "MaximumSpeed": 12.0, **more}
    state = lmcp.new(f"{kind}VehicleState", ID=1, Location=lmcp.new("Location3D", **at(0, 0)))
    return [lmcp.new(f"{kind}VehicleConfiguration", **values), state]


def hover(north_m: float, east_m: float, duration: int, kind: str = "Hover") -> Any:
    place = lmcp.new("Location3D", **at(north_m, east_m))
    return lmcp.new("LoiterAction", LoiterType=kind, Duration=duration, Location=place)


def mission(*places: tuple[float, float], stand: int = -1, actions: Any = (), **more: Any) -> Any:
    """Along places, the last one for good; actions: at the place of the number `stand`."""
    ways = [
        lmcp.new(
            "Waypoint", Number=k, NextWaypoint=min(k + 1, len(places)), AssociatedTasks=[k],
            VehicleActionList=list(actions) if k == stand else [], **at(*p), **more,
        )
        for k, p in enumerate(places, 1)
    ]  # fmt: skip
    return lmcp.new("MissionCommand", CommandID=7, VehicleID=1, FirstWaypoint=1, WaypointList=ways)


def order(*actions: Any) -> Any:
    return lmcp.new(
        "VehicleActionCommand", CommandID=8, VehicleID=1, VehicleActionList=list(actions)
    )


def path(*places: tuple[float, float], **more: Any) -> Any:
    """To follow along places, with a pause of 9 s at the second one."""
    ways = [
        lmcp.new("PathWaypoint", Number=k, NextWaypoint=k + 1, PauseTime=9000 * (k == 2), **at(*p))
        for k, p in enumerate(places, 1)
    ]
    values = {"CommandID": 7, "VehicleID": 1, "FirstWaypoint": 1, "WaypointList": ways, **more}
    return lmcp.new("FollowPathCommand", **values)
