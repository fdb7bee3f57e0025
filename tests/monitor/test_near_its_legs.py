"""The assumption that a vehicle under UxAS stays nearer to its legs than they are to a zone."""

from __future__ import annotations

import copy
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import pytest
from flight_tools import meeting
from tampering import Log, at, other

from cratous.bridge import lmcp
from cratous.services.assumptions.listing import State
from cratous.services.assumptions.observations import Message, Observed
from cratous.services.assumptions.path_deviation import NearLegsWatch
from cratous.services.bus import Bus, Envelope
from cratous.services.flight.loop import fly
from cratous.services.pipeline.plan import make_plan
from cratous.spec.mission import Mission, Zone, ZoneKind

FAR = ((2000.0, 500.0), (4000.0, 500.0), (4000.0, 900.0), (2000.0, 900.0))


def zone(east_m: float, kind: ZoneKind = ZoneKind.KEEP_OUT) -> Zone:
    """Two kilometres along the way north, from a distance east of it on."""
    corners = tuple((north, east - 500.0 + east_m) for north, east in FAR)
    return Zone(21, kind, corners, 0.0, 1000.0)


ALONE = replace(meeting(), traffic=())
"""North along the axis, at 300 m."""


@cache
def flown() -> tuple[Envelope, ...]:
    bus, log = Bus(lmcp.full_names), list[Any]()
    bus.tap(log.append)
    fly(ALONE, make_plan(ALONE), bus)
    return tuple(log)


def seen(mission: Mission, change: Callable[[Log], None] = lambda log: None) -> Observed:
    log = [copy.copy(one) for one in flown()]
    change(log)
    watch = NearLegsWatch(mission)
    for one in log:
        kind = one.topic.rpartition(".")[2]
        watch.message(Message(kind, one.time_ms, one.source, one.body))
    watch.end(log[-1].time_ms)
    return watch.records()["near its legs"].observed(log[-1].time_ms, True)


def at_zone(*zones: Zone) -> Mission:
    return replace(ALONE, zones=zones)


def beside_the_zone(log: Log) -> int:
    """The first state of the vehicle there."""
    return next(
        k for k, one in enumerate(log)
        if one.topic.endswith("TruthState") and one.body.North > 2500.0
    )  # fmt: skip


def aside(**off: float) -> Callable[[Log], None]:
    """The vehicle is elsewhere at one sample beside the zone."""

    def change(log: Log) -> None:
        k = beside_the_zone(log)
        body = log[k].body
        log[k] = other(log[k], **{key: getattr(body, key) + by for key, by in off.items()})

    return change


def test_far_from_every_zone_it_holds() -> None:
    found = seen(at_zone(zone(100.0)))
    assert (found.state, found.note) == (State.HELD, "")
    assert found.extreme is not None
    assert found.extreme < 1.0
    assert found.checks > 100


@pytest.mark.parametrize(
    ("east_m", "off", "state"),
    [
        (6.0, {"East": -4.0}, State.HELD),  # 4 m off: the leg has to keep a margin of 5 m
        (4.5, {"East": -4.0}, State.BROKEN),
        (4.5, {"East": -1.5}, State.HELD),  # of 2 m
        (4.5, {"Altitude": 3.0}, State.BROKEN),
        (4.5, {"Altitude": 1.9}, State.HELD),
        (30.0, {"East": -19.0}, State.HELD),
        (30.0, {"East": -21.0}, State.BROKEN),  # more than any margin
    ],
)
def test_off_its_leg_it_needs_a_leg_with_more_room(
    east_m: float, off: dict[str, float], state: State
) -> None:
    found = seen(at_zone(zone(east_m)), aside(**off))
    assert found.state is state, found.note
    if state is State.BROKEN:
        assert found.broken is not None
        assert found.broken.vehicle_id == 1
        assert "off the leg that UxAS commanded at 0.00 s" in found.note
        said = "more than any margin" if east_m == 30.0 else "keeps zone 21 by less than 5 m"
        assert said in found.note


def test_a_leg_through_a_zone_or_out_of_one_keeps_it_by_no_margin() -> None:
    assert seen(at_zone(zone(-200.0))).state is State.BROKEN
    assert seen(at_zone(zone(-200.0, ZoneKind.KEEP_IN))).state is State.BROKEN


def test_a_zone_that_is_above_is_kept() -> None:
    above = replace(zone(-200.0), floor_m=310.0)
    assert seen(at_zone(above)).state is State.HELD
    assert seen(at_zone(replace(above, floor_m=300.5))).state is State.BROKEN


def test_what_is_not_seen_is_not_said_to_be_near() -> None:
    def change(log: Log) -> None:
        k = beside_the_zone(log)
        del log[k]

    found = seen(at_zone(zone(100.0)), change)
    assert (found.state, "vehicle 1 was not seen" in found.note) == (State.NOT_OBSERVED, True)


def test_what_is_not_seen_to_the_end_is_not_said_to_be_near() -> None:
    def change(log: Log) -> None:
        log[:] = [
            one for one in log if not one.topic.endswith("TruthState") or one.time_ms < 60_000
        ]

    found = seen(at_zone(zone(100.0)), change)
    assert (found.state, found.checks > 100) == (State.NOT_OBSERVED, True)
    assert "vehicle 1 was not seen from" in found.note


def test_what_flies_on_no_path_is_not_said_to_be_near() -> None:
    """Its gate was ICAROUS's and is back, and UxAS has commanded nothing since."""

    def change(log: Log) -> None:
        topic = log[at(log, "TruthState")].topic.replace("TruthState", "GateState")
        for since_ms, owner, epoch in ((55_000, "UxAS", 2), (50_000, "ICAROUS", 1)):
            k = at(log, "TruthState", since_ms, VehicleID=1)
            gate = lmcp.new("GateState", VehicleID=1, Time=since_ms, Epoch=epoch)
            gate.Owner = type(gate.Owner)[owner]
            log.insert(k, replace(log[k], topic=topic, body=gate))

    found = seen(at_zone(zone(100.0)), change)
    assert (found.state, found.checks > 100) == (State.NOT_OBSERVED, True)
    assert "vehicle 1 flew on no one path of UxAS from 55.00 s" in found.note


def test_a_lap_that_is_commanded_anew_ahead_of_the_vehicle_is_near_by_its_last_legs() -> None:
    def change(log: Log) -> None:
        command = log[at(log, "GatedCommand", VehicleID=1)]
        legs = command.body.Command.WaypointList
        ahead = lmcp.new("Location3D", Latitude=legs[-1].Latitude + 0.01, Altitude=300.0)
        first = legs[-1].copy(Latitude=ahead.Latitude)
        lap = command.body.Command.copy(WaypointList=[first, *legs, first])
        log[at(log, "GatedCommand", VehicleID=1)] = replace(
            command, body=command.body.copy(Command=lap)
        )

    assert seen(at_zone(zone(100.0)), change).state is State.HELD


def test_what_was_flown_until_a_command_is_held_against_the_one_before() -> None:
    """The last flight before another path, which begins where the vehicle has got to by then."""
    last: list[float] = []

    def change(log: Log) -> None:
        k = beside_the_zone(log)
        body = log[k].body
        log[k] = other(log[k], East=body.East - 21.0)
        command = log[at(log, "GatedCommand", VehicleID=1)]
        log.insert(k, replace(command, time_ms=log[k].time_ms))
        last.append(log[k].time_ms / 1000)

    found = seen(at_zone(zone(30.0)), change)
    assert found.state is State.BROKEN
    assert found.broken is not None
    assert found.broken.since_ms / 1000 < last[0]


def test_a_command_between_two_samples_leaves_what_is_flown_between_them_not_observed() -> None:
    """Where the vehicle was when the path changed is not in the log."""

    def change(log: Log) -> None:
        k = beside_the_zone(log)
        command = log[at(log, "GatedCommand", VehicleID=1)]
        log.insert(k, replace(command, time_ms=log[k].time_ms - 100))

    found = seen(at_zone(zone(100.0)), change)
    assert (found.state, found.checks > 100) == (State.NOT_OBSERVED, True)
    assert "vehicle 1 flew on no one path of UxAS" in found.note


def test_another_kind_of_command_is_told() -> None:
    def change(log: Log) -> None:
        k = at(log, "GatedCommand", VehicleID=1)
        circle = lmcp.new("VehicleActionCommand", VehicleID=1)
        log[k] = replace(log[k], body=log[k].body.copy(Command=circle))

    found = seen(at_zone(zone(100.0)), change)
    assert found.state is State.NOT_OBSERVED
    assert "something else than a path" in found.note or "no flight on a path" in found.note
