"""UxAS's end with peers of several dialects at once: each at its own address, each in its own form."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from bridge_flight import PLANE, way
from icarous_rig import Fake, Rig, state

from cratous.bridge import lmcp
from cratous.bridge import text_protocol as tp
from cratous.spec.errors import BadInput

SERVICE = "IcarousCommunicationService"  # named here for the table of services
OURS, ORIGINAL, THESIS = tp.Dialect.CRATOUS, tp.Dialect.ORIGINAL, tp.Dialect.THESIS
OTHERS = "2=original@tcp://127.0.0.2:0 3=thesis@tcp://127.0.0.3:0"
THREE = f'NumberOfUAVs="3" VehicleIDs="1 2 3" Dialect="cratous" OtherDialects="{OTHERS}"'


def peer(rig: Rig, door: int, hello: int | None = None) -> Fake:
    """A peer that comes in at a door and speaks what is spoken there."""
    host, port = rig.service.port.ports[door].bound
    one = Fake(port, hello, (OURS, ORIGINAL, THESIS)[door], host)
    rig.opened.append(one)
    rig.until(lambda: one.read() is not None and (one.handshake.done or one.ended))
    return one


def zone(corners: int, number: int) -> Any:
    """A keep-out zone far away with so many corners."""
    points = []
    for k in range(corners):
        lat, lon = PLANE.to_geodetic(20_000.0 + 10.0 * k, 20_000.0 + (k * (corners - k)))
        points.append(lmcp.new("Location3D", Latitude=lat, Longitude=lon))
    return lmcp.new(
        "KeepOutZone", ZoneID=number, MinAltitude=0.0, MaxAltitude=1000.0,
        MinAltitudeType="MSL", MaxAltitudeType="MSL",
        Boundary=lmcp.new("Polygon", BoundaryPoints=points),
    )  # fmt: skip


@pytest.mark.shows(SERVICE, "OtherDialects")
def test_each_peer_is_told_in_its_own_form_and_steers_its_own_vehicle(
    tmp_path: Path, opened: list[Any]
) -> None:
    rig = Rig(tmp_path, THREE, opened)
    peers = {1: peer(rig, 0, hello=1), 2: peer(rig, 1), 3: peer(rig, 2)}
    rig.tell(zone(60, 7), zone(4, 9))
    for vid in peers:
        command = way((0.0, 0.0), (5000.0, 0.0), (9000.0, 0.0)).copy(VehicleID=vid)
        rig.tell(state(vid, 400.0 * vid), command)
    for vid, one in peers.items():
        rig.until(
            lambda one=one, vid=vid: one.all(tp.OwnPosition) or rig.tell(state(vid, 400.0 * vid))
        )
        rig.until(lambda one=one: one.all(tp.StartMission) and one.all(tp.FenceDone))
    ours, original, thesis = peers.values()
    assert b"WAYPT,total" in ours.raw
    assert b"WAYPTtotal" in thesis.raw
    assert b"WAYPT," not in thesis.raw
    totals = [line.total for line in original.all(tp.Waypoint)]
    assert totals == list(range(1, len(totals) + 1)), "a running count is what its client reads"
    assert {line.total for line in ours.all(tp.Waypoint)} == {len(totals)}
    assert all(line.lat_deg is not None for line in original.all(tp.SoftReset))
    # its client holds no zone of more than 50 vertices, and counts those that it holds; the others are told both
    assert [line.zone for line in original.all(tp.FenceDone)] == [1]
    assert [(line.zone, line.total) for line in original.all(tp.FenceVertex)] == [(1, 4)] * 4
    for one in (ours, thesis):
        assert {line.zone for line in one.all(tp.FenceDone)} == {1, 2}
    # epochs are ours alone, and each steers the vehicle that it speaks for
    for vid, one in peers.items():
        epoch = 1 if one is ours else None
        one.say(tp.SetMode("ACTIVE", epoch), tp.SetVelocity(20.0, float(vid), 0.0))
    rig.until(lambda: len(rig.got("VehicleActionCommand")) == 3)
    assert {c.VehicleID for c in rig.got("AuthorityChange")} == {1, 2, 3}
    steered = {c.VehicleID: c.VehicleActionList[0].Heading for c in rig.got("VehicleActionCommand")}
    assert steered[1] < steered[2] < steered[3]


def test_zones_that_are_removed_and_a_mission_that_is_over_are_told_to_each_as_it_knows(
    tmp_path: Path, opened: list[Any]
) -> None:
    rig = Rig(tmp_path, THREE, opened)
    peers = {1: peer(rig, 0, hello=1), 2: peer(rig, 1), 3: peer(rig, 2)}
    rig.tell(zone(4, 9))
    for vid, one in peers.items():
        command = way((0.0, 0.0), (5000.0, 0.0)).copy(VehicleID=vid)
        rig.tell(state(vid, 400.0 * vid), command)
        rig.until(lambda one=one: one.all(tp.StartMission) and one.all(tp.FenceDone))
    ours, original, thesis = peers.values()
    waypoints = {one: len(one.all(tp.Waypoint)) for one in peers.values()}
    rig.tell(lmcp.new("RemoveZones", ZoneList=[9]))
    rig.until(lambda: ours.all(tp.ForgetFences))
    assert len(ours.all(tp.Waypoint)) == waypoints[ours], "the plan stays"
    for one in (
        original,
        thesis,
    ):  # which have no such word: all is forgotten, and the plan told again
        rig.until(lambda one=one: len(one.all(tp.Waypoint)) == 2 * waypoints[one])
        assert one.all(tp.HardReset)
        assert not one.all(tp.ForgetFences)
    rig.tell(lmcp.new("MissionCommand", VehicleID=1))
    rig.until(lambda: ours.all(tp.StopMission) and ours.all(tp.ForgetWaypoints))
    again = peer_again(rig, ours)
    rig.until(lambda: again.all(tp.OwnPosition) or rig.tell(state(1, 400.0, 1500)))
    assert not again.all(tp.Waypoint), "on a new connection there is no plan either"


def peer_again(rig: Rig, one: Fake) -> Fake:
    """The instance of vehicle 1 on a new connection."""
    one.close()
    rig.until(lambda: any(not b.Alive and b.VehicleID == 1 for b in rig.got("BridgeStatus")))
    return peer(rig, 0, hello=1)


def test_only_whom_a_heartbeat_is_owed_by_is_taken_for_lost(
    tmp_path: Path, opened: list[Any]
) -> None:
    rig = Rig(tmp_path, THREE, opened)
    peers = {1: peer(rig, 0, hello=1), 2: peer(rig, 1), 3: peer(rig, 2)}
    for vid in peers:
        command = way((0.0, 0.0), (5000.0, 0.0)).copy(VehicleID=vid)
        rig.tell(state(vid, 400.0 * vid), command)
    for one in peers.values():
        rig.until(lambda one=one: one.all(tp.StartMission))
        one.say(tp.SetMode("ACTIVE", 1 if one.dialect is OURS else None))
    rig.until(lambda: len(rig.got("AuthorityChange")) == 3)
    # an instance of ours that owns a vehicle and says nothing for 2 s is lost; the others owe no sign of life
    watch = rig.service.wake
    now_ms = rig.process.bus.now_ms + 60_000
    rig.process.bus.call(SERVICE, lambda state: watch(state, None, now_ms))
    rig.until(lambda: rig.got("ServiceStatus"))
    held = [p.Value for s in rig.got("ServiceStatus") for p in s.Info if "holds" in p.Value]
    assert [text.split(" holds")[0] for text in held] == ["vehicle 1"]


def test_a_peer_speaks_for_nobody_who_comes_in_elsewhere(tmp_path: Path, opened: list[Any]) -> None:
    rig = Rig(tmp_path, THREE, opened)
    stranger = peer(rig, 0, hello=2)
    rig.until(lambda: stranger.read() is not None and stranger.ended)
    assert rig.said.has("HELLO of vehicle 2, expected one of 1")
    first, second = peer(rig, 1), peer(rig, 1)
    rig.until(lambda: second.read() is not None and second.ended)
    assert rig.said.has("more instances than of the vehicles 2, which come in here")
    assert not first.ended


def lines(*said: tp.Message) -> bytes:
    return b"".join(tp.encode(line, dialect=OURS, limits=tp.WIDE_LIMITS) for line in said)


def test_nothing_that_comes_with_a_refused_line_counts(tmp_path: Path, opened: list[Any]) -> None:
    """A peer of a door without keys may not speak for the vehicle of another one, by a second HELLO in one packet."""
    others = "2=cratous@tcp://127.0.0.2:0"
    rig = Rig(tmp_path, THREE.replace(OTHERS, others), opened)
    rig.tell(state(1, 400.0), way((0.0, 0.0), (5000.0, 0.0)).copy(VehicleID=1))
    stranger = peer(rig, 1)
    stranger.sock.sendall(lines(tp.Hello(9), tp.Hello(1), tp.SetMode("ACTIVE", 1)))
    rig.until(lambda: stranger.read() is not None and stranger.ended)
    assert rig.said.has("HELLO of vehicle 9, expected one of 2")
    assert not rig.said.has("is the ICAROUS of vehicle 1")
    assert not rig.got("AuthorityChange")
    own = peer(rig, 0, hello=1)
    rig.until(lambda: rig.said.has("is the ICAROUS of vehicle 1"))
    assert own.read() is not None
    assert not own.ended


def test_one_too_many_speaks_for_nobody_and_the_next_is_dealt_with(
    tmp_path: Path, opened: list[Any]
) -> None:
    others = "2=cratous@tcp://127.0.0.2:0"
    rig = Rig(tmp_path, THREE.replace(OTHERS, others), opened)
    first = peer(rig, 1, hello=2)
    rig.until(lambda: rig.said.has("is the ICAROUS of vehicle 2"))
    host, port = rig.service.port.ports[1].bound
    second = Fake(port, None, OURS, host)
    opened.append(second)
    answer = second.handshake.feed

    def at_once(data: bytes) -> bytes:
        said = answer(data)
        return said + lines(tp.Hello(1)) if said else said

    second.handshake.feed = at_once
    rig.until(lambda: second.read() is not None and second.handshake.done)
    third = peer(rig, 1)  # while the second one is still told why
    rig.until(lambda: second.read() is not None and second.ended)
    rig.until(lambda: third.read() is not None and third.ended)
    assert not rig.said.has("is the ICAROUS of vehicle 1")
    assert not first.ended


def test_one_of_another_dialect_than_its_door_s_is_refused_with_the_reason(
    tmp_path: Path, opened: list[Any]
) -> None:
    rig = Rig(tmp_path, THREE, opened)
    host, port = rig.service.port.ports[2].bound
    one = Fake(port, None, OURS, host)
    opened.append(one)
    rig.until(lambda: one.read() is not None and one.handshake.done)
    one.say(tp.SetMode("PASSIVE", 0))
    rig.until(lambda: one.read() is not None and one.ended)
    assert b"error," in one.raw
    assert rig.said.has("thesis is spoken here")


@pytest.mark.parametrize(
    ("others", "what"),
    [
        ("2=german@tcp://127.0.0.1:5600", "not a vehicle and its dialect"),
        ("9=original@tcp://127.0.0.1:5600", "not a vehicle and its dialect"),
        ("2=thesis@tcp://127.0.0.1:5600 2=thesis@tcp://127.0.0.1:5601", "not a vehicle and its"),
        ("2=thesis@tcp://127.0.0.1:5600 1=thesis@tcp://127.0.0.1:5600", "not a vehicle and its"),
        ("2=original@tcp://192.0.2.1:5600", "no authentication"),
        ("2=original@udp://127.0.0.1:5600", "not a vehicle and its dialect"),
        ("2=v2@tcp://127.0.0.1:5600", "no key of the bridge"),
    ],
)
def test_what_cannot_be_spoken_is_refused(
    tmp_path: Path, opened: list[Any], others: str, what: str
) -> None:
    more = f'NumberOfUAVs="2" VehicleIDs="1 2" Dialect="cratous" OtherDialects="{others}"'
    with pytest.raises(BadInput, match=what):
        Rig(tmp_path, more, opened)
