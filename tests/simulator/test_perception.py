"""What cameras of the simulator perceive, and gimbals that track it."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
from driving_tools import vehicle
from simulator_tools import CAMERA, DOWN, STARE, mission, ordered, scenario, waypoint
from terrain_tools import dted

from cratous.bridge import lmcp
from cratous.services.simulator import payload
from cratous.services.simulator.motion import Motion
from cratous.services.simulator.perception import Body, perceptions
from cratous.services.simulator.scenario import of_text
from cratous.services.simulator.terrain import Terrain
from cratous.services.simulator.world import Event, World
from cratous.spec.errors import BadInput

TRACK = """<TrackEntityAction Series="PERCEIVE"><EntityID>2</EntityID><SensorID>2</SensorID>
<ReturnToWaypoint>{}</ReturnToWaypoint></TrackEntityAction>"""
AT = {"Latitude": 45.01, "Longitude": -119.995}
"""Where the other vehicle is, which is where STARE looks."""


def car(number: int = 2) -> list[Any]:
    """One that may drive, and stands."""
    configuration, state = (body.copy(ID=number) for body in vehicle())
    return [configuration, state.copy(Location=lmcp.new("Location3D", **AT))]


def played(
    events: str, seconds: float, others: Sequence[tuple[float, Any]] = (), **how: Any
) -> tuple[World, list[Any]]:
    """A world with an aircraft with a camera and others, and what it tells."""
    plan = of_text(scenario(events, payloads=CAMERA), "test")
    more = [Event(time_s, body, "") for time_s, body in others]
    world, told = World([*plan.events, *more], 600, **how), list[Any]()
    while world.time_s < seconds:
        told += world.tick()
    return world, told


def of(told: Sequence[Any], kind: str, after_ms: int = 1) -> list[Any]:
    found = [b for b in told if type(b).__name__ == kind]
    time = "TimeLastSeen" if kind == "EntityPerception" else "Time"
    return [b for b in found if getattr(b, time) >= after_ms]


def test_what_is_in_a_picture_is_perceived_twice_a_second() -> None:
    others = [(0.5, body) for body in car()]
    _, told = played(ordered(1, STARE), 20, others)
    seen = of(told, "EntityPerception", 3000)
    assert [b.TimeLastSeen for b in seen] == [s.Time for s in of(told, "AirVehicleState", 3000)]
    assert len(seen) > 30
    one = seen[-1]
    assert (one.PerceiverID, one.PerceivedEntityID, list(one.PerceiverPayloads)) == (1, 2, [2])
    assert (one.Location.Latitude, one.Location.Longitude) == pytest.approx(tuple(AT.values()))
    assert one.VelocityValid
    assert one.AttitudeValid
    assert list(one.LocationError) == list(one.VelocityError) == [0, 0, 0]
    again = played(ordered(1, STARE), 20, others)[1]
    assert [lmcp.binary.pack(b) for b in told] == [lmcp.binary.pack(b) for b in again]
    assert of(played(ordered(1, DOWN), 15, others)[1], "EntityPerception", 5000) == []
    assert of(played(ordered(1, STARE), 20, others, compatible=True)[1], "EntityPerception") == []
    assert of(played(ordered(1, STARE), 5)[1], "EntityPerception") == [], "not its own carrier"


def test_ids_of_more_than_32_bits_are_unknown_or_tell_nothing() -> None:
    _, told = played(ordered(1, STARE), 8, [(0.5, body) for body in car(2**33)])
    assert {b.PerceivedEntityID for b in of(told, "EntityPerception")} == {0}
    configuration = of_text(scenario(payloads=CAMERA), "x").events[0].body
    mounted = payload.gimbals_of(configuration, "")
    here = Motion(0.8, -2.0, 400.0, *[0.0] * 9)
    below = Body(2, here._replace(alt_m=0.0), ())
    looking = tuple(g._replace(elevation_deg=-90.0) for g in mounted)
    assert len(list(perceptions([Body(1, here, looking), below], 0))) == 1
    assert list(perceptions([Body(2**32, here, looking), below], 0)) == []
    # of nine cameras the message has place for eight
    nine = tuple(g._replace(cameras=g.cameras * 9) for g in looking)
    (told,) = perceptions([Body(1, here, nine), below], 0)
    assert list(told.PerceiverPayloads) == [2] * 8
    assert lmcp.binary.pack(told)
    west, east = (side * (math.pi - 5e-6) for side in (1, -1))
    across = [Body(1, here._replace(lon_rad=west), looking),
              Body(2, below.motion._replace(lon_rad=east), ())]  # fmt: skip
    assert len(list(perceptions(across, 0))) == 1, "beyond the 180th meridian"


def inside(point: tuple[float, float], ring: Sequence[tuple[float, ...]]) -> bool:
    """Whether a place is on the same side of all edges of a convex ring."""
    sides = [
        (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0]) > 0
        for a, b in zip(ring, [*ring[1:], ring[0]], strict=True)
    ]
    return len(set(sides)) == 1


def test_on_the_ground_that_is_the_footprint() -> None:
    configuration = of_text(scenario(payloads=CAMERA), "x").events[0].body
    chosen, count = random.Random(5), 0
    for _ in range(60):
        turned = chosen.uniform(-3, 3), chosen.uniform(-0.2, 0.2), chosen.uniform(-0.3, 0.3)
        m = Motion(0.8, -2.0, 500.0, *turned, *[0.0] * 6)
        (g,) = payload.gimbals_of(configuration, "")
        g = g._replace(azimuth_deg=chosen.uniform(-180, 180), elevation_deg=-55.0)
        *ring, middle = payload.footprint(g, g.cameras[0], m, 0.0)
        for _ in range(20):
            lat, lon = (middle[k] + chosen.uniform(-6, 6) * 1e-5 for k in range(2))
            place = lat, lon
            other = Motion(*place, 0.0, *[0.0] * 9)
            seen = list(perceptions([Body(1, m, (g,)), Body(2, other, ())], 0))
            assert bool(seen) is inside(place, ring)
            count += bool(seen)
    assert 150 < count < 900


def test_a_ridge_hides_and_the_horizon_ends_it(tmp_path: Path) -> None:
    ridge = Terrain([dted(tmp_path, 45, -120, lambda lat, _: 700 * (0.19 < lat - 45 < 0.21))])
    configuration = of_text(scenario(payloads=CAMERA), "x").events[0].body
    (g,) = payload.gimbals_of(configuration, "")
    g = g._replace(azimuth_deg=0.0, elevation_deg=-1.0)
    m = Motion(math.radians(45.1), math.radians(-119.5), 600.0, *[0.0] * 9)
    for north, alt_m, flat, hilly in ((45.15, 0.0, True, True), (45.3, 0.0, True, False),
                                      (45.3, 1000.0, True, True), (46.5, 0.0, False, False),
                                      (46.5, 3000.0, True, True)):  # fmt: skip
        other = m._replace(lat_rad=math.radians(north), alt_m=alt_m)
        bodies = [Body(1, m, (g,)), Body(2, other, ())]
        assert bool(list(perceptions(bodies, 0))) is flat
        assert bool(list(perceptions(bodies, 0, ridge))) is hilly


def off_m(state: Any, lat: float, lon: float) -> float:
    """How far the middle of a state's picture is from a place."""
    middle = state.PayloadStateList[1].Centerpoint
    return math.hypot((middle.Latitude - lat) * 111_200, (middle.Longitude - lon) * 78_600)


def test_a_gimbal_tracks_what_moves_and_what_is_lost_is_circled() -> None:
    drive = lmcp.new("FlightDirectorAction", Heading=90.0, Speed=8.0)
    go = lmcp.new("VehicleActionCommand", VehicleID=2, VehicleActionList=[drive])
    others = [*((0.5, body) for body in car()), (10.0, go),
              (60.0, lmcp.new("RemoveEntities", EntityList=[2]))]  # fmt: skip
    world, told = played(ordered(1, STARE) + ordered(5, TRACK.format(0)), 250, others)
    cars = {s.Time: s.Location for s in of(told, "GroundVehicleState")}
    states = [s for s in of(told, "AirVehicleState", 8000) if s.Time in cars]
    assert len(states) > 90
    for state in states:
        place = cars[state.Time]
        assert off_m(state, place.Latitude, place.Longitude) < 25, "as the aircraft flies on"
        assert state.Mode.name == "FlightDirector"
    last = cars[max(cars)]
    assert last.Longitude > -119.991, "it has driven"
    (said,) = world.warnings()
    assert "vehicle 1 has lost entity 2 at 62.5 s" in said
    assert said.endswith("it stays about the place")
    for state in of(told, "AirVehicleState", 180_000):
        assert state.Mode.name == "Loiter"
        assert off_m(state, last.Latitude, last.Longitude) < 25
        away = (state.Location.Latitude - last.Latitude) * 111_200
        assert abs(away) < 300
        assert state.Location.Altitude == pytest.approx(400, abs=1)


@pytest.mark.parametrize(("number", "later", "said"), [
    (2, "", "it goes to waypoint 2"), (9, "", "it stays about the place"),
    (2, mission(waypoint(1, 1, 45.3)).replace('Time="1"', 'Time="20"'), "told since"),
])  # fmt: skip
def test_who_has_lost_it_goes_to_a_waypoint_but_not_if_told_otherwise(
    number: int, later: str, said: str
) -> None:
    route = mission(waypoint(1, 2, 45.02), waypoint(2, 3, 45.2), waypoint(3, 3, 45.3))
    track = ordered(5, TRACK.format(number))
    others = [*((0.5, body) for body in car()), (15.0, lmcp.new("RemoveEntities", EntityList=[2]))]
    if later:
        others = [*((0.5, body) for body in car()), (25.0, others[-1][1])]
    world, told = played(route + ordered(4, STARE) + track + later, 32, others)
    assert said in world.warnings()[0]
    last = of(told, "AirVehicleState")[-1]
    wanted = {2: ("Waypoint", 2), 9: ("Loiter", 1)}[number] if not later else ("Waypoint", 1)
    assert (last.Mode.name, last.CurrentWaypoint) == wanted


def test_a_track_follows_perceptions_of_others_and_ends_by_another_action() -> None:
    plan = of_text(scenario(ordered(1, TRACK.format(0)), payloads=CAMERA), "test")
    world = World(plan.events, 600, compatible=True)
    seen = lmcp.new("EntityPerception", PerceivedEntityID=2, Location=lmcp.new("Location3D", **AT))

    def pointing(seconds: float, *bodies: Any) -> str:
        for body in bodies:
            world.receive(body, "a client")
        end = world.time_s + seconds
        while world.time_s < end:
            world.tick()
        return str(world.states()[0].PayloadStateList[0].PointingMode.name)

    assert pointing(2) == "AirVehicleRelativeAngle", "nobody has seen it"
    assert pointing(1, seen) == "LatLonSlaved"
    down = lmcp.new("GimbalAngleAction", PayloadID=1, Elevation=-90.0)
    command = lmcp.new("VehicleActionCommand", VehicleID=1, VehicleActionList=[down])
    assert pointing(1, command, seen) == "AirVehicleRelativeAngle"
    assert world.unheard == {"EntityPerception": 1}
    assert world.warnings() == []
    with pytest.raises(BadInput, match=r"EntityPerception of 2.*finite"):
        pointing(1, seen.copy(Location=lmcp.new("Location3D", Latitude=math.nan)))
    other = lmcp.new("TrackEntityAction", EntityID=2, SensorID=77)
    pointing(1, command.copy(VehicleActionList=[other]))
    assert world.unheard["TrackEntityAction"] == 1, "no such sensor"
    again = command.copy(VehicleActionList=[other.copy(SensorID=2)])
    assert pointing(1, again, seen) == "LatLonSlaved"
    assert world.unheard["EntityPerception"] == 1
    gone = lmcp.new("RemoveEntities", EntityList=[1])
    for body in (gone, seen):
        world.receive(body)
    assert world.unheard["EntityPerception"] == 2, "who tracked it is gone"


def test_what_drives_tracks_too() -> None:
    loads = of_text(scenario(payloads=CAMERA), "x").events[0].body.PayloadConfigurationList
    world = World((), 60)
    track = lmcp.new("TrackEntityAction", EntityID=2, SensorID=2)
    order = lmcp.new("VehicleActionCommand", VehicleID=1, VehicleActionList=[track])
    seen = lmcp.new("EntityPerception", PerceivedEntityID=2, Location=lmcp.new("Location3D", **AT))
    for body in (*vehicle(PayloadConfigurationList=list(loads)), order, seen):
        world.receive(body)
    assert world.warnings() == []
    assert world.states()[0].PayloadStateList[0].PointingMode.name == "LatLonSlaved"
