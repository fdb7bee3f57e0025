"""UxAS's end with the original's client: what that one has sent in a flight, and what it must not be sent."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from bridge_flight import PLANE, TASK, Aircraft, way
from icarous_rig import Fake, Rig, state

from cratous.bridge import lmcp
from cratous.bridge import text_protocol as tp
from cratous.bridge.text_protocol.layouts import ORIGINAL_LIMITS

# of the original's client in a flight of examples/crossing, its ICAROUS behind a stub of its bus
TAKES_OVER = b"SETMOD,type_ACTIVE_,\nSETVEL,north1.908598,east21.917054,down-0.000000,\n"
STEERS = b"SETVEL,north-3.835357,east21.663103,down-0.000000,\n"
OFFERS = b"SETMOD,type_PASSIVE_,\nSETVEL,north-0.010989,east21.999997,down-0.000000,\n"
MORE = 'NumberOfUAVs="1" Dialect="original" DeviationAllowed="0" DeviationOrigin="path"'


def flying(north: float, east: float, at_ms: int) -> Any:
    """A state of vehicle 1, on the way to its second waypoint."""
    craft = Aircraft(1, north, east, 0.0)
    craft.waypoint = 2
    body = craft.state(at_ms)
    body.AssociatedTasks = [TASK]
    return body


def begun(tmp_path: Path, opened: list[Any]) -> tuple[Rig, Fake]:
    """A client that was told a mission, and its vehicle on the way."""
    rig = Rig(tmp_path, MORE, opened)
    one = rig.fake()
    rig.until(lambda: one.all(tp.OwnPosition) or rig.tell(state(1)))
    rig.tell(way((0.0, 0.0), (5000.0, 0.0), (9000.0, 0.0)))
    rig.tell(state(1, 50.0, 1500), flying(100.0, 0.0, 2000))
    rig.until(lambda: one.all(tp.WaypointReached))
    return rig, one


def test_its_icarous_forgets_nothing_while_it_avoids(tmp_path: Path, opened: list[Any]) -> None:
    """At RESET_SFT the client resets its ICAROUS, traffic, zones and all: it comes with the handback alone."""
    rig, one = begun(tmp_path, opened)
    one.sock.sendall(TAKES_OVER)
    rig.until(lambda: rig.got("AuthorityChange"))
    resets = len(one.all(tp.SoftReset))
    rig.tell(flying(400.0, 60.0, 2500))
    one.sock.sendall(STEERS)
    rig.tell(flying(500.0, 90.0, 3000))
    rig.until(lambda: rig.got("TaskPause") and len(one.all(tp.OwnPosition)) > 3)
    rig.until(lambda: len(rig.got("VehicleActionCommand")) == 2)
    assert len(one.all(tp.SoftReset)) == resets
    one.sock.sendall(OFFERS)
    rig.until(lambda: rig.got("MissionCommand") and len(one.all(tp.SoftReset)) > resets)
    assert rig.got("TaskResume")
    assert len(one.all(tp.SoftReset)) == resets + 1


def test_a_way_back_that_a_waypoint_manager_hands_on_is_told_once(
    tmp_path: Path, opened: list[Any]
) -> None:
    """Each telling resets the ICAROUS behind the client, and the second would be taken for the mission's own way."""
    rig, one = begun(tmp_path, opened)
    one.sock.sendall(TAKES_OVER)
    rig.until(lambda: rig.got("AuthorityChange"))
    rig.tell(flying(500.0, 90.0, 2500))
    one.sock.sendall(OFFERS)
    rig.until(lambda: rig.got("MissionCommand"))
    (back,) = rig.got("MissionCommand")
    rig.until(lambda: len(one.all(tp.StartMission)) == 2)
    resume = craft_of(rig).plan.resume
    assert resume is not None
    rig.tell(back.copy(CommandID=2, VehicleActionList=[]), flying(510.0, 90.0, 3000))
    rig.until(lambda: any(p.time_s == 3.0 for p in one.all(tp.OwnPosition)))
    assert len(one.all(tp.StartMission)) == 2
    assert craft_of(rig).plan.resume == resume
    # another way is told, and so is the same one again once some of it is behind
    rig.tell(way((0.0, 0.0), (5000.0, 0.0), (9500.0, 0.0)))
    rig.until(lambda: len(one.all(tp.StartMission)) == 3)
    rig.tell(state(1, 550.0, 5500), flying(600.0, 0.0, 6000))
    rig.tell(way((0.0, 0.0), (5000.0, 0.0), (9500.0, 0.0)))
    rig.until(lambda: len(one.all(tp.StartMission)) == 4)


def craft_of(rig: Rig) -> Any:
    """What the service knows of vehicle 1."""
    found: list[Any] = []

    def look(known: Any) -> tuple[Any, list[Any]]:
        found.append(known.craft(1))
        return known, []

    rig.process.bus.call(rig.service.name, look)
    return found[-1]


def fence(number: int, corners: int) -> Any:
    """A zone around where the vehicle is."""
    turn = 2 * math.pi / corners
    places = [
        PLANE.to_geodetic(20_000 * math.cos(k * turn), 20_000 * math.sin(k * turn))
        for k in range(corners)
    ]
    points = [lmcp.new("Location3D", Latitude=lat, Longitude=long) for lat, long in places]
    boundary = lmcp.new("Polygon", BoundaryPoints=points)
    return lmcp.new(
        "KeepInZone", ZoneID=number, MaxAltitude=500.0, MaxAltitudeType="MSL",
        MinAltitudeType="MSL", Boundary=boundary,
    )  # fmt: skip


def test_a_zone_that_it_cannot_hold_is_none_of_those_that_it_counts(
    tmp_path: Path, opened: list[Any]
) -> None:
    """It publishes a fence for each GEOFN_SEND, also of a zone of which it was told no vertex."""
    rig, most = Rig(tmp_path, MORE, opened), ORIGINAL_LIMITS.zones
    one = rig.fake()
    rig.tell(state(1), fence(7, 51), *(fence(100 + k, 4) for k in range(most + 1)))
    rig.until(lambda: len(one.all(tp.FenceDone)) >= most or rig.tell(state(1)))
    assert rig.said.has("zone 7: more than 50 vertices; the original's client is not told of it")
    assert rig.said.has(f"zone {100 + most}: more than {most} zones")
    told = [line for line in one.got if isinstance(line, (tp.FenceVertex, tp.FenceDone))]
    whole = [tp.FenceDone(k) for k in range(1, most + 1)]
    assert [line for line in told if isinstance(line, tp.FenceDone)] == whole
    assert [line.zone for line in told if isinstance(line, tp.FenceVertex)] == [
        k for k in range(1, most + 1) for _ in range(4)
    ]
