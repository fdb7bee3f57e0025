"""The way on which UxAS's end leads a vehicle to a place while its ICAROUS is not heard, and its MissionCommand."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from cratous.bridge import lmcp
from cratous.core.avoidance.way_ahead import near_line
from cratous.core.kernel import Vec2
from cratous.core.tasks.stations import in_ring
from cratous.services.flight.messages import Say
from cratous.services.flight.rejoining import Router
from cratous.services.icarous.return_to_path import bearing_rad
from cratous.services.icarous_communication.holding import Sender, by_uxas
from cratous.services.icarous_communication.state import (
    COMMANDS_FROM,
    Craft,
    Out,
    State,
    plane,
    tellable,
    turn_radius_of,
)
from cratous.services.loading.lost_link_attributes import Place
from cratous.spec.errors import CratousError
from cratous.spec.mission import Position
from cratous.spec.mission.plan import Pose

HERE_M = 1.0
"""A way's first point within this distance of the vehicle is left out [m]."""
WAITS = {
    True: "while ICAROUS has it, and waits for the handback",
    False: "while its ICAROUS is not heard, and waits until it is",
}
"""By whether ICAROUS has a vehicle that is off its plan: why a mission for it waits, and how long."""


def goal_of(state: State, vid: int, to: Place | None) -> Position | None:
    """The place in the plane: `to`, or where the vehicle was first seen; None if that is not known."""
    if to is None or state.frame is None:
        return state.craft(vid).first
    return Position(*plane(state.frame).to_local(to.lat_deg, to.long_deg), to.alt_m)


def way_to(state: State, vid: int, to: Place | None) -> tuple[Position, ...]:
    """A flyable way to the place around all known zones; () if none is found."""
    craft, goal = state.craft(vid), goal_of(state, vid, to)
    if craft.air is None or goal is None or state.frame is None:
        return ()
    zones, _ = tellable(state.frame, state.zones.values())
    end = Pose(*goal, bearing_rad(craft.air.position, goal))
    try:
        way = Router(tuple(zones)).way_to(craft.air, turn_radius_of(craft, craft.air), end)
    except (CratousError, MemoryError):
        return ()
    here = Vec2(*craft.air.position[:2])
    begun = bool(way) and in_ring(Vec2(*way[0][:2]), here, 0.0, HERE_M)
    return tuple(way[1:] if begun else way) or tuple(way)


def is_there(state: State, vid: int, to: Place | None) -> bool:
    """Whether a vehicle is within a turn of the place."""
    craft, goal = state.craft(vid), goal_of(state, vid, to)
    if craft.air is None or goal is None:
        return False
    place = Vec2(goal.north_m, goal.east_m)
    here = Vec2(craft.air.position.north_m, craft.air.position.east_m)
    return near_line(here, place, place, turn_radius_of(craft, craft.air))


def sent(
    sender: Sender, state: State, vid: int, way: tuple[Position, ...]
) -> tuple[State, list[Out]]:
    """The MissionCommand for a way, by UxAS's authority."""
    craft = state.craft(vid)
    assert craft.air is not None
    projection = plane(state.frame) if state.frame is not None else state.plane
    number = 1 + max((w.Number for w in _waypoints(craft)), default=0)
    points = list[Any]()
    for k, place in enumerate(way):
        lat_deg, long_deg = projection.to_geodetic(place.north_m, place.east_m)
        points.append(
            lmcp.new(
                "Waypoint", Number=number + k, NextWaypoint=number + min(k + 1, len(way) - 1),
                Latitude=lat_deg, Longitude=long_deg, Altitude=place.alt_m, AltitudeType="MSL",
                Speed=craft.air.speed_m_s,
            )
        )  # fmt: skip
    state = replace(state, commands=state.commands + 1)
    command = lmcp.new(
        "MissionCommand", CommandID=COMMANDS_FROM + state.commands, VehicleID=vid,
        FirstWaypoint=number, WaypointList=points,
    )  # fmt: skip
    state = state.put(vid, replace(craft, returns=command))
    return state, [*by_uxas(sender, state, vid, command), Say(command, sender.name)]


def is_part(command: Any, craft: Craft) -> bool:
    """Whether a MissionCommand is the way back or a part of it: a waypoint manager sends it on as its own."""
    if craft.returns is None:
        return False
    return {_place(w) for w in command.WaypointList} <= {
        _place(w) for w in craft.returns.WaypointList
    }


def _waypoints(craft: Craft) -> list[Any]:
    return [] if craft.plan is None else list(craft.plan.command.WaypointList)


def _place(waypoint: Any) -> tuple[float, ...]:
    return (waypoint.Number, waypoint.Latitude, waypoint.Longitude, waypoint.Altitude)
