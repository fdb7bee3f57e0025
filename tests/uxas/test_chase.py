"""The way to what moves at the usual speed, and the chase of it at the greatest."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest
from following_tools import ENTITY, aircraft, escort, moving
from pipeline_tools import Rig, place, request
from uxas_flight import local

from cratous.bridge import lmcp

RADIUS_M = 1.1 * 20**2 / (9.80665 * math.tan(math.radians(30)))
"""The tightest planned turn, and the circle."""
SLOW_M = (30**2 - 20**2) / (2 * 1.0)
"""What slowing down from 30 to 20 m/s takes at 1 m/s2."""


def test_who_follows_is_planned_to_its_circle_as_it_is_when_he_gets_there(tmp_path: Path) -> None:
    """One who flies 20 m/s, 3 km behind what flies 15 m/s away, is a turn behind it after so much less; at his
    greatest speed, 30 m/s, from 3 s ahead of him on, after a third of that, and a little more, since he slows down.
    """
    rig = Rig(tmp_path)
    task = lmcp.new("WatchTask", TaskID=5, WatchedEntityID=ENTITY)
    rig.tell(*aircraft(1, 0.0), *moving(15.0), task, request(5))
    usual, chase = rig.got("TaskPlanOptions")[0].Options
    (end, gate, rim, entity) = local(
        [usual.EndLocation, chase.StartLocation, chase.EndLocation, moving()[1].Location],
        place(0.0),
    )
    seconds = (math.hypot(*entity) - RADIUS_M) / (20 - 15)
    assert math.hypot(*end) == pytest.approx(20 * seconds, rel=0.02)
    assert math.hypot(*gate) == pytest.approx(3 * 20, abs=1)
    gap_m = math.hypot(*entity) + 3 * 15 - RADIUS_M - 3 * 20
    seconds = (gap_m + SLOW_M / 20 * (30 - 20)) / (30 - 15)
    assert math.dist(gate, rim) == pytest.approx(gap_m + 15 * seconds, rel=0.02)
    assert chase.Cost == pytest.approx(1000 * seconds, rel=0.02)


def test_who_chases_flies_his_greatest_speed_until_he_is_near(tmp_path: Path) -> None:
    rig = Rig(tmp_path)
    task = lmcp.new("WatchTask", TaskID=5, WatchedEntityID=ENTITY)
    rig.tell(*aircraft(1, 0.0), *moving(15.0), task, request(5))
    (command,) = rig.got("AutomationResponse")[0].MissionCommandList
    begins = next(k for k, w in enumerate(command.WaypointList) if w.AssociatedTasks)
    speeds = [w.Speed for w in command.WaypointList]
    assert set(speeds[: begins + 1]) == {20}, "as usual to where the chase begins"
    assert set(speeds[begins + 1 :]) == {30}
    state = aircraft(1, 0.0)[1].copy(AssociatedTasks=[5], CurrentWaypoint=99, Mode="Waypoint")
    rig.tell(state)
    for k, short_m in enumerate((1.1 * SLOW_M, 0.9 * SLOW_M, 0.0), 1):
        away = place(0.03 - (RADIUS_M + short_m) / 111_000, 0.002)
        rig.tell(state.copy(Location=away, Time=k))
    told = [c.VehicleActionList[0] for c in rig.got("VehicleActionCommand")]
    assert [one.Airspeed for one in told] == pytest.approx([30, 30, 20, 20])
    assert [one.Radius for one in told] == pytest.approx([RADIUS_M] * 4, abs=0.1)


@pytest.mark.parametrize(
    "why", ["", "escort", "no faster", "too near", "stands", "zone", "way", "circle"]
)
def test_no_chase_is_offered_where_none_is_possible_or_of_use(tmp_path: Path, why: str) -> None:
    task = lmcp.new("BlockadeTask", TaskID=5, BlockedEntityID=ENTITY)
    configuration, state = aircraft(1, 0.028 if why == "too near" else 0.0)
    # where a chase would begin, 100 m ahead; halfway to its circle; on the far side of this
    places = {"zone": (0.0009, 0.0), "way": (0.03, 0.001), "circle": (0.0616, 0.002)}
    at = place(*places.get(why, (0.0, 0.0)))
    area = lmcp.new("Circle", CenterPoint=at, Radius=40.0)
    zone = lmcp.new("KeepOutZone", ZoneID=3, Boundary=area, MaxAltitude=1000.0)
    region = lmcp.new("OperatingRegion", ID=4, KeepOutAreas=[3] if why in places else [])
    if why == "no faster":
        configuration = configuration.copy(MaximumSpeed=20.5)
    what = moving({"stands": 0.0, "too near": 3.0}.get(why, 15.0))
    rig = Rig(tmp_path)
    rig.tell(configuration, state, *what, zone, region, escort() if why == "escort" else task)
    rig.tell(request(5, OperatingRegion=4))
    assert len(rig.got("TaskPlanOptions")[0].Options) == (1 if why else 2)


def test_of_several_all_chase_or_none_does(tmp_path: Path) -> None:
    """Each way to give two vehicles their circles is offered at the usual speeds and as chases."""
    rig = Rig(tmp_path)
    task = lmcp.new("MultiVehicleWatchTask", TaskID=5, WatchedEntityID=ENTITY, NumberVehicles=2)
    rig.tell(*aircraft(1, 0.0), *aircraft(2, 0.001), *moving(15.0), task)
    rig.tell(request(5, vehicles=(1, 2)))
    (made,) = rig.got("TaskPlanOptions")
    usual, chases = ({o.OptionID for o in made.Options if o.OptionID % 2 == k} for k in (1, 0))
    ways = [
        {int(p) for p in way.split(" p")} for way in re.findall(r"\|\(p([^)]*)\)", made.Composition)
    ]
    assert [way <= chases for way in ways] == [True, True, False, False]
    assert [way <= usual for way in ways] == [False, False, True, True]
    assert all(len(way) == 2 for way in ways)
