"""Answers to intervals on the bus, flown in a closed loop: manoeuvres, zones, right of way."""

from __future__ import annotations

import itertools
import math
from pathlib import Path
from typing import Any

import pytest
from daidalus_sky import ACTS, SEES, Craft, Sky, box, fly, head_on, intervals, mission, state, zone

from cratous.bridge import lmcp
from cratous.services.mission.zones import exact_leg_ok
from cratous.spec.mission import Zone, ZoneKind

DETECTION, RESPONSE = "DAIDALUS_WCV_Detection", "DAIDALUS_WCV_Response"


def encounter(
    tmp_path: Path, *services: str, others: list[Craft], **more: Any
) -> tuple[Sky, Craft]:
    """The ownship flies a mission northwards; the zones are told first."""
    sky = Sky(tmp_path, *(services or (SEES, ACTS)))
    own = Craft(2, 0.0, 0.0, 0.0, **{k: v for k, v in more.items() if k in ("wind",)})
    command = mission(2, (9000.0, 0.0), (14_000.0, 0.0), (30_000.0, 0.0))
    own.mission = command
    sky.tell(*more.get("zones", ()), command)
    return sky, own


def coming(number: int = 1, **more: Any) -> Craft:
    return Craft(number, 12_000.0, -100.0, 180.0, **more)


@pytest.mark.shows(
    RESPONSE,
    "WellClearViolationIntervals", "DAIDALUSConfiguration", "AirVehicleState", "MissionCommand",
    "VehicleActionCommand", "ServiceStatus", "VehicleID",
)  # fmt: skip
def test_a_vehicle_gives_way_holds_and_comes_back(tmp_path: Path) -> None:
    other = coming()
    sky, own = encounter(tmp_path, others=[other])
    losses = fly(sky, [own, other], 330)
    assert not any(losses)
    assert sky.states(2) == ["in conflict", "on hold", "resume", "on mission"]
    diverts, back = sky.got("VehicleActionCommand"), sky.got("MissionCommand")[1:]
    assert 1 <= len(diverts) <= 4
    assert [command.FirstWaypoint for command in back] == [1]  # none is left out
    assert (own.waypoint, abs(own.east) < 400.0) == (3, True)
    # the same without an answer loses well clear
    (tmp_path / "dull").mkdir()
    sky, own = encounter(tmp_path / "dull", SEES, others=[coming()])
    assert any(fly(sky, [own, coming()], 120))


@pytest.mark.shows(RESPONSE, "KeepOutZone", "KeepInZone", "RemoveZones")
def test_a_divert_obeys_zones(tmp_path: Path) -> None:
    def side(name: str, *zones: Any) -> Craft:
        folder = tmp_path / name
        folder.mkdir()
        sky, own = encounter(folder, others=[], zones=zones)
        if name == "removed":
            sky.tell(lmcp.new("RemoveZones", ZoneList=[7]))
        assert not any(fly(sky, [own, coming()], 110, 2.0)), name
        return own

    right = box(1500.0, 600.0, 9000.0, 9000.0)
    again = side("removed", zone("KeepOutZone", 7, *right))
    left = side("out", zone("KeepOutZone", 7, *right))
    inside = box(-2000.0, -9000.0, 40_000.0, 600.0)
    kept = side("in", zone("KeepInZone", 7, *inside))
    assert max(p.east_m for p in again.flown) > 400.0
    for own, kind, corners in (
        (left, ZoneKind.KEEP_OUT, right),
        (kept, ZoneKind.KEEP_IN, inside),
    ):
        binding = Zone(7, kind, tuple(corners), -1e9, 1e9)
        assert all(exact_leg_ok(p, q, binding) for p, q in itertools.pairwise(own.flown))
        assert min(p.east_m for p in own.flown) < -300.0


def test_without_a_free_manoeuvre_it_is_refused_with_the_reasons(tmp_path: Path) -> None:
    sky = Sky(tmp_path, SEES, ACTS)
    tube = zone("KeepInZone", 7, *box(-500.0, -200.0, 40_000.0, 200.0))
    sky.tell(tube, mission(2, (12_000.0, 0.0)), *head_on())
    assert sky.got("VehicleActionCommand") == []
    (why,) = sky.reasons("Error")
    assert why.startswith(
        "in conflict; no manoeuvre is free of bands and zones; loss with vehicle 1"
    )
    assert "outside of NEAR bands, but each meets zone 7" in why
    sky.tell(lmcp.new("RemoveZones", ZoneList=[7]), *head_on())
    assert len(sky.got("VehicleActionCommand")) == 1


def test_zones_that_cannot_be_taken_are_named(tmp_path: Path) -> None:
    sky = Sky(tmp_path, SEES, ACTS)
    bowtie = zone("KeepOutZone", 8, (0.0, 0.0), (900.0, 900.0), (0.0, 900.0), (900.0, 0.0))
    around = zone("KeepOutZone", 9, *box(-900.0, -900.0, 900.0, 900.0))
    above = zone("KeepOutZone", 10, *box(9000.0, -900.0, 9900.0, 900.0), MaxAltitude=50.0,
                 MaxAltitudeType="AGL")  # fmt: skip
    sky.tell(bowtie, around, above, mission(2, (12_000.0, 0.0)), *head_on())
    (told,) = [r for r in sky.reasons("Information") if r.startswith("in conflict")]
    assert "zone 8 binds nobody" in told
    assert "zone 9 is broken already and binds no more" in told
    assert "zone 10 binds at every altitude: its limits are not MSL" in told


def pair(number: int) -> tuple[str, str]:
    return (
        f'Type="{DETECTION}" VehicleID="{number}" TurnRate="3"',
        f'Type="{RESPONSE}" VehicleID="{number}"',
    )


def test_of_two_that_answer_the_lower_id_has_the_right_of_way(tmp_path: Path) -> None:
    sky = Sky(tmp_path, *pair(1), *pair(2))
    one, other = Craft(1, 0.0, 0.0, 0.0), Craft(2, 12_000.0, 100.0, 180.0)
    for craft, command in (
        (one, mission(1, (30_000.0, 0.0))),
        (other, mission(2, (-20_000.0, 100.0))),
    ):
        craft.mission = command
        sky.tell(command)
    assert not any(fly(sky, [one, other], 330))
    assert {b.VehicleID for b in sky.got("VehicleActionCommand")} == {2}
    assert sky.states(1) == ["right of way", "on mission"]
    assert sky.states(2)[-1] == "on mission"
    assert max(abs(p.east_m) for p in one.flown) < 1.0


@pytest.mark.shows(RESPONSE, "RightOfWayLimit")
def test_right_of_way_ends_where_the_other_does_not_act(tmp_path: Path) -> None:
    def acted_at(limit: str) -> float:
        folder = tmp_path / (limit or "default")
        folder.mkdir()
        text = f'RightOfWayLimit="{limit}"' if limit else ""
        one = f'Type="{RESPONSE}" VehicleID="1" {text}'
        sky = Sky(folder, pair(1)[0], one, pair(2)[0])  # 2 sees, and does nothing
        sky.tell(mission(1, (30_000.0, 0.0)))
        fly(sky, [Craft(1, 0.0, 0.0, 0.0), Craft(2, 12_000.0, 100.0, 180.0)], 90)
        assert sky.states(1)[:2] == ["right of way", "in conflict"]
        seen: Any = None
        for envelope in sky.all:
            if type(envelope.body).__name__ == "WellClearViolationIntervals":
                seen = envelope.body if envelope.body.EntityId == 1 else seen
            if type(envelope.body).__name__ == "VehicleActionCommand":
                return float(seen.TimeToViolationList[0])
        raise AssertionError("it never acted")

    assert acted_at("") == pytest.approx(12.5, abs=1.1)
    assert acted_at("5") == pytest.approx(5.0, abs=1.1)


def test_a_foreign_command_in_a_conflict_is_answered_by_the_manoeuvre_again(tmp_path: Path) -> None:
    sky = Sky(tmp_path, SEES, ACTS)
    sky.tell(mission(2, (12_000.0, 0.0)), *head_on())
    assert len(sky.got("VehicleActionCommand")) == 1
    sky.tell(*head_on())
    assert len(sky.got("VehicleActionCommand")) == 1
    sky.tell(mission(2, (12_000.0, 0.0)), *head_on())
    assert len(sky.got("VehicleActionCommand")) == 2


@pytest.mark.shows(RESPONSE, "AutomationResponse", "AirVehicleConfiguration")
def test_a_plan_is_the_mission_and_the_configuration_says_how_it_turns(tmp_path: Path) -> None:
    def commands(bank: float) -> tuple[Sky, list[Any]]:
        folder = tmp_path / str(bank)
        folder.mkdir()
        sees = f'Type="{DETECTION}" VehicleID="2"'  # no turn rate: bands as if it turned at once
        sky = Sky(folder, sees, ACTS)
        profile = lmcp.new("FlightProfile", Airspeed=50.0, MaxBankAngle=bank)
        sky.tell(
            lmcp.new("AutomationResponse", MissionCommandList=[mission(2, (9000.0, 0.0))]),
            lmcp.new("AirVehicleConfiguration", ID=2, NominalFlightProfile=profile),
            # a wall to the right that only a tight turn avoids
            zone("KeepOutZone", 7, *box(1200.0, -4000.0, 3000.0, 4000.0)),
            *head_on(),
        )
        return sky, sky.got("VehicleActionCommand")

    tight, slow = commands(60.0)[1], commands(4.0)
    assert len(tight) == 1
    assert slow[1] == []
    assert "meets zone 7" in slow[0].reasons("Error")[0]


@pytest.mark.shows(RESPONSE, "ManeuverType")
@pytest.mark.parametrize("kind", ["Heading", "GroundSpeed", "VerticalSpeed", "Altitude"])
def test_each_kind_of_manoeuvre_leaves_the_bands(tmp_path: Path, kind: str) -> None:
    sky = Sky(tmp_path, f'{SEES} VerticalRate="5"', f'{ACTS} ManeuverType="{kind}"')
    # overtaking: slower, higher, or beside are all ways out
    slow = state(1, 3500.0, 0.0, 0.0, 20.0, 1000)
    sky.tell(mission(2, (20_000.0, 0.0)), slow, state(2, 0.0, 0.0, 0.0, 70.0, 1000))
    (command,) = sky.got("VehicleActionCommand")
    (action,) = command.VehicleActionList
    said = intervals(sky)
    lists = {
        "Heading": ("WCVGroundHeadingIntervals", "GroundHeadings", action.Heading),
        "GroundSpeed": ("WCVGroundSpeedIntervals", "GroundSpeeds", action.Speed),
        "VerticalSpeed": (
            "WCVVerticalSpeedIntervals",
            "VerticalSpeeds",
            math.copysign(action.ClimbRate, action.Altitude - 1000.0),
        ),
        "Altitude": ("WCVAlitudeIntervals", "Altitude", action.Altitude),
    }
    name, field, value = lists[kind]
    spans = [list(getattr(i, field)) for i in getattr(said, name)]
    assert spans
    assert not any(low <= value <= high for low, high in spans)
    changed = (action.Heading != 0.0, action.Speed != 70.0, action.Altitude != 1000.0)
    assert changed == (
        kind == "Heading",
        kind == "GroundSpeed",
        kind in ("VerticalSpeed", "Altitude"),
    )


def test_a_divert_in_wind_is_checked_over_the_ground(tmp_path: Path) -> None:
    # the wind carries the vehicle eastwards: to the right it would be blown into the zone
    out = box(4000.0, 2600.0, 30_000.0, 9000.0)
    lean = math.degrees(math.asin(15.0 / 50.0))
    other = Craft(1, 12_000.0, 100.0, 180.0 + lean, wind=(0.0, 15.0))
    sky, own = encounter(
        tmp_path, others=[], zones=[zone("KeepOutZone", 7, *out)], wind=(0.0, 15.0)
    )
    own.heading = -lean
    fly(sky, [own, other], 150)
    binding = Zone(7, ZoneKind.KEEP_OUT, tuple(out), -1e9, 1e9)
    assert all(exact_leg_ok(p, q, binding) for p, q in itertools.pairwise(own.flown))
    assert sky.got("VehicleActionCommand")


def test_without_a_configuration_there_is_no_answer_and_it_is_said(tmp_path: Path) -> None:
    sky = Sky(tmp_path, ACTS)
    conflict = lmcp.new(
        "WellClearViolationIntervals", EntityId=2, EntityList=[1], TimeToViolationList=[5.0]
    )
    sky.tell(conflict)
    assert sky.reasons("Warning") == ["no answer: no DAIDALUSConfiguration of it has been heard"]
    assert sky.got("VehicleActionCommand") == []
