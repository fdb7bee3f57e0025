"""Many requests to one process: answers follow from what is known now, and what is kept stays bounded."""

from __future__ import annotations

import gc
from pathlib import Path
from typing import Any

import pytest
from pipeline_tools import Rig, must_fly, place, request, vehicle

from cratous.bridge import lmcp

EAST = 0.02


def zone(least: float, most: float) -> list[Any]:
    box = lmcp.new(
        "Polygon", BoundaryPoints=[place(s, e) for s, e in
                                   ((least, -0.004), (least, 0.004), (most, 0.004), (most, -0.004))],
    )  # fmt: skip
    area = lmcp.new("KeepOutZone", ZoneID=3, MaxAltitude=1000.0, Boundary=box)
    return [area, lmcp.new("OperatingRegion", ID=7, KeepOutAreas=[3])]


def slower() -> Any:
    changed = vehicle(1)[0].copy(NominalSpeed=16.0)
    changed.NominalFlightProfile.Airspeed = 16.0
    return changed


def wider_turns() -> Any:
    changed = vehicle(1)[0]
    changed.NominalFlightProfile.MaxBankAngle = 20.0
    return changed


TASKS = (must_fly(5, 0.02), must_fly(6, 0.04), must_fly(8, 0.03, EAST))
CHANGES = {
    "zone moved": zone(0.030, 0.035),
    "vehicle slower": [slower()],
    "wider turns": [wider_turns()],
    "task moved": [must_fly(6, 0.05, EAST)],
}


def waypoints(rig: Rig) -> list[tuple[float, ...]]:
    (command,) = rig.got("AutomationResponse")[-1].MissionCommandList
    return [(w.Latitude, w.Longitude, w.Altitude, w.Speed) for w in command.WaypointList]


@pytest.mark.parametrize("change", [*CHANGES])
def test_what_has_changed_since_the_last_request_changes_its_answer(
    tmp_path: Path, change: str
) -> None:
    """The second answer is that of a process which only knows the changed world, and not the first."""
    known = [*vehicle(1), *zone(0.010, 0.015), *TASKS]
    asked = request(5, 6, 8, OperatingRegion=7)
    found = []
    for earlier in (True, False):
        (tmp_path / str(earlier)).mkdir()
        rig = Rig(tmp_path / str(earlier))
        rig.tell(*known)
        if earlier:
            rig.tell(asked)
            rig.wait(5000)
            found.append(waypoints(rig))
            rig.all.clear()
        rig.tell(*CHANGES[change], asked)
        rig.wait(5000)
        found.append(waypoints(rig))
    before, after, plain = found
    # the frame stays where the first request has put it
    assert after == [pytest.approx(one, abs=1e-6) for one in plain]
    assert after != before


def test_requests_leave_no_cycles_of_ours(tmp_path: Path) -> None:
    """A process collects garbage seldom: what a request has made must go without."""
    rig = Rig(tmp_path)
    rig.tell(*vehicle(1), *zone(0.010, 0.015), *TASKS)
    for _ in range(2):
        rig.tell(request(5, 6, 8, OperatingRegion=7))
        rig.wait(5000)
    gc.collect()
    gc.disable()
    try:
        for k in range(40):  # more than are kept
            rig.tell(must_fly(6, 0.04 + 0.001 * k), request(5, 6, 8, OperatingRegion=7))
            rig.wait(5000)
            rig.all.clear()
        gc.set_debug(gc.DEBUG_SAVEALL)
        gc.collect()
        left = [type(one) for one in gc.garbage]
    finally:
        gc.set_debug(0)
        gc.garbage.clear()
        gc.enable()
    assert {kind.__name__ for kind in left if kind.__module__.startswith("cratous")} == set()
    assert len(left) < 40 * 500
