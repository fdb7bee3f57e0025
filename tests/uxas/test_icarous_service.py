"""UxAS's end of the bridge in one process with fake ICAROUS clients: who speaks for whom, what they are told,
whose SETMOD is believed, and what cannot be honoured."""

from __future__ import annotations

import math
import re
import time
from pathlib import Path
from typing import Any

import pytest
from bridge_flight import PLANE, Aircraft, way
from icarous_rig import Fake, Rig, state

from cratous.bridge import lmcp, text_connection
from cratous.bridge import text_protocol as tp
from cratous.services.icarous_communication import service
from cratous.services.icarous_communication.service import NobodyCame
from cratous.services.icarous_communication.settings import ATTRIBUTES, Settings, settings_of
from cratous.services.loading.uxas_settings import Entry, values_of
from cratous.spec.errors import BadInput

SERVICE = "IcarousCommunicationService"


def zone(kind: str, number: int) -> Any:
    corners = [(-9000, -9000), (-9000, 9000), (9000, 9000), (9000, -9000)]
    points = [PLANE.to_geodetic(n / number, e / number) for n, e in corners]
    boundary = lmcp.new(
        "Polygon",
        BoundaryPoints=[lmcp.new("Location3D", Latitude=a, Longitude=b) for a, b in points],
    )
    return lmcp.new(
        kind, ZoneID=number, MaxAltitude=500.0, MaxAltitudeType="MSL", MinAltitudeType="MSL",
        Boundary=boundary,
    )  # fmt: skip


@pytest.mark.shows(SERVICE, "VehicleIDs", "Timeout_s")
def test_it_waits_and_says_who_is_missing(tmp_path: Path, opened: list[Any]) -> None:
    begun = time.monotonic()
    rig = Rig(tmp_path, 'NumberOfUAVs="2" VehicleIDs="3 5" Timeout_s="3"', opened)
    one = Fake(rig.port, hello=5)
    opened.append(one)
    # as `Process.run` does before StartupComplete
    with pytest.raises(NobodyCame) as wrong:
        rig.until(lambda: (one.read(), not rig.process._awaits())[1])
    assert time.monotonic() - begun > 2.9
    text = "1 of 2 ICAROUS instances are there (vehicle 5); 1 missing (of the vehicles 3)"
    assert text in str(wrong.value)
    assert wrong.value.exit_code == 3
    assert rig.said.has(f"waiting: {text}")
    assert rig.said.has("0 of 2 ICAROUS instances are there (none); 2 missing")


def test_instances_without_a_hello_get_the_lowest_ids_in_the_order_of_arrival(
    tmp_path: Path, opened: list[Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(text_connection, "PARTING_S", 0.3)
    rig = Rig(tmp_path, 'NumberOfUAVs="2"', opened)
    first = rig.fake()
    second = rig.fake()
    rig.tell(state(12), lmcp.new("AirVehicleConfiguration", ID=7), state(4))
    rig.until(lambda: first.all(tp.OwnPosition) or rig.tell(state(4), state(7), state(12)))
    rig.until(lambda: second.all(tp.OwnPosition))
    assert {p.vehicle_id for p in first.all(tp.OwnPosition)} == {4}
    assert {p.vehicle_id for p in second.all(tp.OwnPosition)} == {7}
    rig.tell(state(4, now_ms=2000))
    rig.until(lambda: {t.index for t in first.all(tp.Traffic)} == {7, 12})
    third = rig.fake()
    rig.until(lambda: third.read() is not None and third.ended)
    assert rig.said.has("more instances than NumberOfUAVs = 2")


def test_no_more_vehicles_and_zones_are_kept_than_said(
    tmp_path: Path, opened: list[Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(service, "MOST_VEHICLES", 2)
    monkeypatch.setattr(service, "MOST_ZONES", 1)
    rig = Rig(tmp_path, 'NumberOfUAVs="1" VehicleIDs="4"', opened)
    one = rig.fake(hello=4)
    rig.tell(state(4), state(5), lmcp.new("AirVehicleConfiguration", ID=6), state(6))
    rig.tell(zone("KeepOutZone", 1), zone("KeepOutZone", 2), zone("KeepInZone", 1))
    rig.tell(state(5, now_ms=1000), state(4, now_ms=1000))
    rig.until(lambda: one.all(tp.Traffic))
    assert {t.index for t in one.all(tp.Traffic)} == {5}
    assert rig.said.has("more vehicles than are kept: vehicle 6 is not avoided")
    assert rig.said.has("more zones than are kept: zone 2 is not avoided")


def test_an_aircraft_of_another_time_is_no_traffic_and_that_is_said(
    tmp_path: Path, opened: list[Any]
) -> None:
    rig = Rig(tmp_path, 'NumberOfUAVs="1"', opened)
    one = rig.fake(hello=1)
    rig.tell(state(9, 500.0, 10_000), state(8, 700.0, 1000), state(1, 0.0, 11_000))
    rig.until(lambda: one.all(tp.Traffic))
    (other,) = one.all(tp.Traffic)
    assert other.index == 9
    # flown on to the time of the vehicle's own state: 22 m in a second
    assert PLANE.to_local(other.lat_deg, other.long_deg)[0] == pytest.approx(522.0, abs=0.01)
    rig.tell(state(1, 11.0, 11_500))
    assert len([line for line in rig.said if "vehicle 8: no state within 5000 ms" in line]) == 1


def test_two_instances_for_one_vehicle_and_a_stranger_are_refused(
    tmp_path: Path, opened: list[Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(text_connection, "PARTING_S", 0.3)
    rig = Rig(tmp_path, 'NumberOfUAVs="2" VehicleIDs="1 2"', opened)
    one = rig.fake(hello=1)
    for hello, why in ((1, "a second instance for vehicle 1"), (9, "expected one of 1, 2")):
        other = rig.fake(hello=hello)
        rig.until(lambda other=other: other.read() is not None and other.ended)
        assert rig.said.has(why)
        assert f"error,{'a second' if hello == 1 else 'HELLO of'}".encode() in other.raw, (
            "it is told why"
        )
        told = [p.Value for s in rig.got("ServiceStatus") for p in s.Info if p.Key == "reason"]
        assert told[-1].startswith("refused 127.0.0.1:")
        assert why in told[-1]
    for hello in range(10, 14):  # what is counted does not grow with what strangers say
        other = rig.fake(hello=hello)
        rig.until(lambda other=other: other.read() is not None and other.ended)
    assert rig.service.port.counts.refused == {"vehicle taken": 1, "HELLO of a stranger": 5}
    rig.tell(state(1))
    rig.until(lambda: one.all(tp.OwnPosition))
    assert not one.ended


@pytest.mark.shows(SERVICE, "AirVehicleConfiguration", "KeepInZone", "KeepOutZone", "RemoveZones")
def test_plans_and_zones_are_told_and_told_again(tmp_path: Path, opened: list[Any]) -> None:
    rig = Rig(tmp_path, 'NumberOfUAVs="1"', opened)
    rig.tell(zone("KeepInZone", 1), zone("KeepOutZone", 2), way((0.0, 0.0), (900.0, 0.0)))
    one = rig.fake(hello=1)
    rig.until(lambda: one.all(tp.StartMission))
    assert [v.fence for v in one.all(tp.FenceVertex)] == ["KEEPIN"] * 4 + ["KEEPOUT"] * 4
    assert [w.index for w in one.all(tp.Waypoint)] == [0, 1]
    rig.tell(state(1))
    one.got.clear()
    rig.tell(lmcp.new("RemoveZones", ZoneList=[1]))
    rig.until(lambda: one.all(tp.StartMission))
    told = [m for m in one.got if not isinstance(m, tp.OwnPosition | tp.Attitude | tp.Traffic)]
    assert isinstance(told[0], tp.HardReset)
    assert [v.fence for v in one.all(tp.FenceVertex)] == ["KEEPOUT"] * 4
    assert len(one.all(tp.Waypoint)) == 2
    # a connection that comes again is told everything
    one.close()
    rig.until(lambda: rig.said.has("eof"))
    two = rig.fake(hello=1)
    rig.until(lambda: two.all(tp.OwnPosition))
    assert (len(two.all(tp.Waypoint)), len(two.all(tp.FenceVertex))) == (2, 4)
    # the turns of a way back are as wide as the configuration's bank makes them
    lengths = []
    for number, bank in enumerate((10.0, 40.0)):
        profile = lmcp.new("FlightProfile", MaxBankAngle=bank)
        rig.tell(lmcp.new("AirVehicleConfiguration", ID=1, NominalFlightProfile=profile))
        rig.tell(way((-2000.0, 0.0), (-4000.0, 0.0)), state(1, now_ms=2000 + number))
        two.say(tp.SetMode("ACTIVE", 2 * number + 1), tp.SetMode("PASSIVE", 2 * number + 2))
        rig.until(lambda n=number: len(rig.got("MissionCommand")) == n + 1)
        points = rig.got("MissionCommand")[-1].WaypointList[2:]
        lengths.append(max(abs(PLANE.to_local(w.Latitude, w.Longitude)[1]) for w in points))
    assert lengths[0] > 3 * lengths[1]


@pytest.mark.shows(SERVICE, "ModeRefused", "ServiceStatus", "VehicleActionCommand")
def test_who_steers_is_what_the_modes_say(tmp_path: Path, opened: list[Any]) -> None:
    rig = Rig(tmp_path, 'NumberOfUAVs="1"', opened)
    one = rig.fake(hello=1)
    rig.tell(state(1), way((0.0, 0.0), (900.0, 0.0)), state(1, 1.0, 1500))
    one.say(tp.SetMode("PASSIVE", 4), tp.SetVelocity(0.0, 20.0, 0.0), tp.SetMode("ACTIVE", 9))
    rig.until(lambda: rig.got("ModeRefused"))
    assert rig.said.has("steering by one without authority")
    assert rig.got("VehicleActionCommand") == []
    one.say(
        tp.SetMode("ACTIVE", 5),
        tp.SetVelocity(0.0, 20.0, -2.0),
        tp.SetPosition(45.0, -121.0, 350.0),
    )
    one.say(tp.GoToWaypoint(1), tp.GoToWaypoint(7), tp.SetVelocity(0.0, 0.0, 0.0))
    rig.until(lambda: len(rig.got("VehicleActionCommand")) == 4)
    velocity, place, waypoint, stay = (
        c.VehicleActionList[0] for c in rig.got("VehicleActionCommand")
    )
    assert (velocity.Speed, velocity.Heading, velocity.ClimbRate) == (20.0, 90.0, 2.0)
    assert velocity.Altitude == pytest.approx(320.0)
    assert (place.Location.Latitude, place.Location.Altitude) == (45.0, 350.0)
    assert waypoint.WaypointNumber == 2
    assert stay.Location.Altitude == pytest.approx(300.0)
    assert rig.said.has("GOTOWP of a waypoint that is not there")
    # the instance is gone: the vehicle holds, until it comes again and hands back
    one.close()
    rig.until(lambda: rig.got("ServiceStatus"))
    assert type(rig.got("VehicleActionCommand")[-1].VehicleActionList[0]).__name__ == "LoiterAction"
    two = rig.fake(hello=1)
    two.say(tp.SetMode("PASSIVE", 12))
    rig.until(lambda: rig.got("MissionCommand"))
    assert [c.Owner.name for c in rig.got("AuthorityChange")] == ["ICAROUS", "UxAS"]


def test_a_mission_that_comes_during_a_takeover_waits_for_the_handback(
    tmp_path: Path, opened: list[Any]
) -> None:
    rig = Rig(tmp_path, 'NumberOfUAVs="1"', opened)
    one = rig.fake(hello=1)
    rig.tell(state(1), way((0.0, 0.0), (900.0, 0.0)), state(1, 1.0, 1500))
    one.say(tp.SetMode("ACTIVE", 1))
    rig.until(lambda: rig.got("AuthorityChange"))
    told = len(one.all(tp.Waypoint))
    later = way((0.0, 0.0), (0.0, 700.0), (0.0, 900.0))
    rig.tell(later)
    rig.until(lambda: rig.said.has("waits for the handback"))
    assert len(one.all(tp.Waypoint)) == told, "the way under ICAROUS was changed"
    assert rig.got("MissionCommand") == []
    one.say(tp.SetMode("PASSIVE", 2))
    rig.until(lambda: rig.got("MissionCommand"))
    assert rig.got("MissionCommand") == [later]
    rig.until(lambda: len(one.all(tp.Waypoint)) > told)
    assert one.all(tp.Waypoint)[-1].lat_deg == pytest.approx(
        later.WaypointList[-1].Latitude, abs=1e-6
    )


@pytest.mark.shows(SERVICE, "Dialect")
def test_the_original_s_modes_have_no_epochs(tmp_path: Path, opened: list[Any]) -> None:
    rig = Rig(tmp_path, 'NumberOfUAVs="1" Dialect="original"', opened)
    one = rig.fake()
    rig.tell(state(1), way((0.0, 0.0), (900.0, 0.0)))
    rig.until(lambda: one.all(tp.OwnPosition) or rig.tell(state(1)))
    assert b"lat44.99" in one.raw or b"lat45.00" in one.raw
    one.say(tp.SetMode("ACTIVE"))
    rig.until(lambda: rig.got("AuthorityChange"))
    one.say(tp.SetVelocity(10.0, 10.0, 0.0), tp.SetMode("PASSIVE"))
    rig.until(lambda: rig.got("MissionCommand"))
    assert len(rig.got("VehicleActionCommand")) == 1
    assert [c.Owner.name for c in rig.got("AuthorityChange")] == ["ICAROUS", "UxAS"]


def test_the_original_s_client_gets_what_it_can_hold(tmp_path: Path, opened: list[Any]) -> None:
    """Long plans in parts of 50, fences of ten vertices with `vertIndex1.0`, resets with a place."""
    rig = Rig(tmp_path, 'NumberOfUAVs="1" Dialect="original"', opened)
    one = rig.fake()
    fence = zone("KeepInZone", 1)
    corners = [(9000 * math.cos(k / 2), 9000 * math.sin(k / 2)) for k in range(12)]
    places = [PLANE.to_geodetic(*corner) for corner in corners]
    fence.Boundary.BoundaryPoints = [
        lmcp.new("Location3D", Latitude=lat, Longitude=lon) for lat, lon in places
    ]
    own = Aircraft(1, 0.0, 0.0, 0.0)
    rig.tell(fence, own.state(0))
    rig.until(lambda: one.all(tp.OwnPosition) or rig.tell(own.state(0)))
    rig.tell(way(*((100.0 * k, 0.0) for k in range(1, 121))))
    for number in range(1, 121):
        own.waypoint = number
        rig.tell(own.state(500 * number))
    last = PLANE.to_geodetic(12_000.0, 0.0)[0]
    rig.until(lambda: any(w.lat_deg == pytest.approx(last) for w in one.all(tp.Waypoint)))
    assert len(one.all(tp.FenceVertex)) == 12
    assert b"vertIndex12.0," in one.raw
    assert not [m for m in one.got if isinstance(m, tp.WireError)]
    resets = one.all(tp.SoftReset)
    assert len(resets) == 3
    assert all(reset.lat_deg == pytest.approx(45.0, abs=1e-4) for reset in resets)
    parts: list[list[float]] = []
    for line in one.got:
        if isinstance(line, tp.Waypoint):
            if line.index == 0:
                parts.append([])
            parts[-1].append(line.lat_deg)
            assert (line.index, line.total) == (len(parts[-1]) - 1, len(parts[-1]))
    assert max(map(len, parts)) == 50
    seen = sorted({lat for part in parts for lat in part})
    assert len(seen) == 121  # the vehicle's place and all waypoints, none lost
    # each WPRCH is of a waypoint of the part in force, in ascending order
    count, held = 0, 0
    for line in one.got:
        if isinstance(line, tp.StartMission):
            count = 0
        elif isinstance(line, tp.Waypoint):
            held = line.total
        elif isinstance(line, tp.WaypointReached):
            assert line.index == count < held
            count += 1


@pytest.mark.parametrize(
    ("attributes", "item"),
    [
        ('Dialect="cratous" Address="tcp://*:0"', "Dialect"),
        ('Dialect="thesis" Connect="tcp://192.0.2.1:9"', "Dialect"),
        ('Dialect="cratous" Keys="keys"', "Keys"),
        ('Dialect="v2"', "VehicleIDs"),
        ("", "VehicleIDs"),
    ],
)
@pytest.mark.shows(SERVICE, "PlainBeyondLoopback")
def test_what_is_not_authenticated_stays_on_this_machine_unless_asked_for(
    attributes: str, item: str
) -> None:
    given = {"NumberOfUAVs": "1", **dict(re.findall(r'(\w+)="([^"]*)"', attributes))}

    def settings(**more: str) -> Settings:
        problems = list[BadInput]()
        values = values_of(ATTRIBUTES, {**given, **more}, "cfg.xml", SERVICE, problems)
        assert problems == []
        return settings_of(Entry("Service", SERVICE, given, (), "cfg.xml"), values)

    with pytest.raises(BadInput, match="no authentication") as wrong:
        settings()
    assert f"{SERVICE}.{item}" in str(wrong.value)
    if item == "Dialect":
        assert settings(PlainBeyondLoopback="true").keys is None


@pytest.mark.shows(SERVICE, "RoutePlannerUsed", "Connect")
def test_what_cannot_be_honoured_is_refused(tmp_path: Path, opened: list[Any]) -> None:
    for attributes, what in (
        ('NumberOfUAVs="1" RoutePlannerUsed="4"', "from -1 to 3"),
        ('NumberOfUAVs="1" Connect="tcp://127.0.0.1:5600"', "Connect with what it excludes"),
        ("", "NumberOfUAVs"),
        ('NumberOfUAVs="2" VehicleIDs="3"', "2 different ids above 0"),
        ('NumberOfUAVs="1" DeviationOrigin="somewhere"', "line or path"),
        ('NumberOfUAVs="1" UseICAROUSRoutePlanner="true"', "unknown attribute"),
    ):
        with pytest.raises(BadInput, match=what):
            Rig(tmp_path, attributes, opened)
    Rig(tmp_path, 'NumberOfUAVs="1" RoutePlannerUsed="-1"', opened)


@pytest.mark.parametrize(
    ("tasks", "later", "onward"),
    [([], [], 3), ([7], [], 1), ([], [tp.SetVelocity(20.0, 0.0, 0.0)], 1)],
)
def test_the_waypoint_with_which_icarous_goes_on_is_flown_to_where_none_with_a_task_is_left_out(
    tmp_path: Path, opened: list[Any], tasks: list[int], later: list[tp.Message], onward: int
) -> None:
    rig = Rig(tmp_path, 'NumberOfUAVs="1" DeviationAllowed="5000"', opened)
    one = rig.fake(hello=1)
    plan = way((0.0, 0.0), (900.0, 0.0), (2400.0, 0.0), (4000.0, 0.0))
    for waypoint in plan.WaypointList:
        waypoint.AssociatedTasks = tasks
    rig.tell(state(1), plan, state(1, 1.0, 1500))
    one.say(tp.SetMode("ACTIVE", 1), tp.GoToWaypoint(2), *later)
    rig.until(lambda: len(rig.got("VehicleActionCommand")) == 1 + len(later))
    (go,) = rig.got("VehicleActionCommand")[0].VehicleActionList
    assert (type(go).__name__, go.WaypointNumber) == ("GoToWaypointAction", 3)
    one.say(tp.SetMode("PASSIVE", 2))
    rig.until(lambda: rig.got("MissionCommand"))
    command = rig.got("MissionCommand")[-1]
    known = {w.Number: w for w in command.WaypointList}
    number = command.FirstWaypoint
    while number > 4:  # the way back
        number = known[number].NextWaypoint
    assert number == onward


def test_others_are_told_where_one_flies_that_is_sent_to_a_place(
    tmp_path: Path, opened: list[Any]
) -> None:
    rig = Rig(tmp_path, 'NumberOfUAVs="2"', opened)
    one, two = rig.fake(hello=1), rig.fake(hello=2)
    rig.tell(state(1), state(2, 3000.0), way((0.0, 0.0), (9000.0, 0.0)))
    lat, lon = PLANE.to_geodetic(0.0, 4000.0)  # to the east
    one.say(tp.SetMode("ACTIVE", 1), tp.SetPosition(lat, lon, 300.0))
    rig.until(lambda: rig.got("VehicleActionCommand"))
    (action,) = rig.got("VehicleActionCommand")[0].VehicleActionList
    assert (action.LoiterType.name, action.Location.Latitude) == ("Circular", pytest.approx(lat))
    rig.until(lambda: two.all(tp.VelocityOfAnother) or rig.tell(state(2, 3000.0, 1500)))
    told = two.all(tp.VelocityOfAnother)[-1]
    assert told.vehicle_id == 1
    assert (told.north_mps, told.east_mps) == (pytest.approx(0.0, abs=0.1), pytest.approx(22.0))
