"""The log of a flight in processes: places with the velocities that lead on, UxAS's messages at their time."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import pytest

from cratous.bridge import lmcp
from cratous.services.cli.job import new_bus
from cratous.services.exporting.messages import payloads_of, state_of
from cratous.services.loading import load
from cratous.services.mission.frames import Projection
from cratous.services.processes.recorder import HELD, Recorder
from cratous.spec.mission import Mission, Position

ZERO_MS = 1010
STEP_MS = 530


@pytest.fixture
def mission(root: Any) -> Mission:
    return load(root / "examples/crossing/mission.yaml", 0)


class Rig:
    """A recorder, and all that it publishes."""

    def __init__(self, mission: Mission) -> None:
        self.bus, self.plane, self.log = new_bus(), Projection(mission.frame), list[Any]()
        self.bus.tap(self.log.append)
        self.recorder, self.mission = Recorder(mission, self.bus), mission

    def place(self, k: int) -> Position:
        """Of vehicle 1 at its k-th state: on a circle."""
        turn = 0.25 * k
        return Position(100 * math.cos(turn), 100 * math.sin(turn), 300.0 + k)

    def state(self, k: int) -> None:
        (_, camera), *_ = payloads_of(self.mission.vehicle(1))
        seen = [lmcp.new("CameraState", PayloadID=camera.PayloadID)]
        for vehicle, place in ((1, self.place(k)), (2, Position(5000.0, 20.0 * k, 300.0))):
            payloads = seen if vehicle == 1 else []
            body = state_of(vehicle, place, 0.0, 22.0, self.plane, payloads)
            self.recorder.state(body.copy(Time=ZERO_MS + STEP_MS * k))

    def of(self, kind: str) -> list[Any]:
        return [e for e in self.log if type(e.body).__name__ == kind]


def test_each_velocity_leads_to_the_next_place(mission: Mission) -> None:
    rig = Rig(mission)
    for k in range(HELD + 5):
        rig.state(k)
    rig.recorder.end("complete")
    truths = [e.body for e in rig.of("TruthState") if e.body.VehicleID == 1]
    assert [t.Time for t in truths] == [STEP_MS * k for k in range(HELD + 5)]
    for k, (now, after) in enumerate(pairwise(truths)):
        place, dt_s = rig.place(k), STEP_MS / 1000
        assert (now.North, now.East, now.Altitude) == pytest.approx(place, abs=1e-3)
        assert now.North + now.VelocityNorth * dt_s == pytest.approx(after.North, abs=1e-6)
        assert now.East + now.VelocityEast * dt_s == pytest.approx(after.East, abs=1e-6)
        assert now.Altitude - now.VelocityDown * dt_s == pytest.approx(after.Altitude, abs=1e-6)
    times = [e.time_ms for e in rig.log]
    assert times == sorted(times)
    (end,) = rig.of("MissionEnd")
    assert (end.body.Time, end.body.Outcome) == (truths[-1].Time, "complete")
    states = [e.body for e in rig.of("AirVehicleState") if e.body.ID == 1]
    assert {s.PayloadStateList[0].PayloadID for s in states} == {1}, (
        "the camera as the mission names it"
    )


def test_what_uxas_says_late_stands_at_its_time(mission: Mission) -> None:
    rig = Rig(mission)
    for k in range(4):
        rig.state(k)
    # UxAS hears of the states later than the recorder, and may be ahead of it as well
    for k in (1, 2, 6):
        beat = lmcp.new(
            "Heartbeat", VehicleID=1, Direction="Up", Sequence=k, Time=ZERO_MS + STEP_MS * k
        )
        rig.recorder.heard(beat)
        rig.recorder.heard(lmcp.new("TaskPause", TaskID=k))
    for k in range(4, 9):
        rig.state(k)
    rig.recorder.end("limit")
    assert [(e.body.Time, e.time_ms) for e in rig.of("Heartbeat")] == [
        (STEP_MS * k, STEP_MS * k) for k in (1, 2, 6)
    ]
    assert [e.time_ms for e in rig.of("TaskPause")] == [STEP_MS * k for k in (1, 2, 6)]


def test_tasks_are_suspended_by_takeovers_and_end_as_uxas_says(mission: Mission) -> None:
    rig = Rig(mission)
    for k in range(6):
        rig.state(k)

    def at(k: int) -> int:
        return ZERO_MS + STEP_MS * k

    rig.recorder.heard(lmcp.new("TaskActive", TaskID=7, EntityID=1, TimeTaskActivated=at(1)))
    for k, owner in ((2, "ICAROUS"), (3, "UxAS")):
        rig.recorder.heard(
            lmcp.new("AuthorityChange", VehicleID=1, Owner=owner, Epoch=k, Time=at(k))
        )
    done = lmcp.new("TaskComplete", TaskID=7, EntitiesInvolved=[1], TimeTaskCompleted=at(4))
    rig.recorder.heard(done)
    rig.recorder.failed(8, 2, "too late")
    rig.recorder.end("failed")
    told = [
        (e.body.TaskID, e.body.Phase.name, e.body.Time, e.time_ms) for e in rig.of("TaskProgress")
    ]
    assert told == [
        (7, phase, STEP_MS * k, STEP_MS * k)
        for k, phase in ((1, "Active"), (2, "Suspended"), (3, "Active"), (4, "Complete"))
    ] + [(8, "Failed", STEP_MS * 4, STEP_MS * 4)]


def test_a_task_that_begins_before_the_last_one_is_told_complete_is_the_one_that_is_suspended(
    mission: Mission,
) -> None:
    rig = Rig(mission)
    rig.state(0)
    for task in (7, 8):
        rig.recorder.heard(lmcp.new("TaskActive", TaskID=task, EntityID=1))
    rig.recorder.heard(lmcp.new("TaskComplete", TaskID=7, EntitiesInvolved=[1]))
    rig.recorder.heard(lmcp.new("AuthorityChange", VehicleID=1, Owner="ICAROUS", Epoch=1))
    rig.recorder.end("limit")
    told = [(e.body.TaskID, e.body.Phase.name) for e in rig.of("TaskProgress")]
    assert told == [(7, "Active"), (8, "Active"), (7, "Complete"), (8, "Suspended")]


def test_a_log_that_just_stops_has_no_end_of_mission(mission: Mission) -> None:
    rig = Rig(mission)
    for k in range(3):
        rig.state(k)
    rig.recorder.end("")
    assert len(rig.of("TruthState")) == 6
    assert rig.of("MissionEnd") == []
