"""The decision logic of ICAROUS: one mode at a time, which says why the vehicle flies as it does and decides what it flies."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import product
from pathlib import Path
from typing import Any

import pytest
from flight_tools import flown, meeting, of_type
from ground_tools import assert_in_the_guide
from icarous_tools import ABILITY, NORTH, PROJECTION, VOLUME, head_on
from mission_tools import must_fly

from cratous.bridge import lmcp
from cratous.core.authority import cognition as kernels
from cratous.core.authority.cognition import Conditions, decide, resolution
from cratous.core.authority.gate import Gate
from cratous.core.authority.link_loss import LOITER
from cratous.core.avoidance.prediction import Intruder
from cratous.services.flight import legs
from cratous.services.icarous import cognition as logic
from cratous.services.icarous import instance
from cratous.services.icarous.decided import Decided
from cratous.services.icarous.foresight import ON_PATH_M
from cratous.services.icarous.inbox import Told
from cratous.services.icarous.instance import Instance
from cratous.services.icarous.lost_link import LostLink
from cratous.services.icarous.messages import Sensed
from cratous.services.icarous.state import Config, State
from cratous.services.loading import load
from cratous.spec.authority import cognition as meant
from cratous.spec.authority.cycle import AVOID
from cratous.spec.mission import Daa, Position, Zone, ZoneKind

MISSION = Path(__file__).resolve().parents[1] / "missions" / "hovering_behind.yaml"
ALL = [Conditions(*seen) for seen in product((False, True), repeat=len(Conditions._fields))]


def modes(log: list[Any], vehicle: int = 1) -> list[str]:
    """The modes that a vehicle went through, each once."""
    told = [b.Mode.name for b in of_type(log, "CognitionState") if b.VehicleID == vehicle]
    return [one for k, one in enumerate(told) if k == 0 or told[k - 1] != one]


@cache
def met() -> tuple[Any, list[Any]]:
    """A flight with one conflict, and its log."""
    return flown(meeting())


def test_the_names_are_those_of_the_specification() -> None:
    body: Any = lmcp.new("CognitionState")
    for field in ("Mode", "Resolution"):
        for one in type(getattr(body, field)):
            words = "".join(f"_{c}" if c.isupper() else c for c in one.name)[1:].upper()
            assert getattr(meant, words.replace("NO_RESOLUTION", "NONE")) == int(one)
    assert {name.capitalize() for name in Conditions._fields} <= set(dir(body))


def test_the_gravest_mode_with_a_reason_is_flown() -> None:
    for mode in (meant.NOMINAL, meant.TRAFFIC_CONFLICT, meant.LAND, meant.LANDED):
        for seen in ALL:
            found = [m for m in range(13) if meant.has_reason(m, mode, meant.Conditions(*seen))]
            assert decide(mode, seen) == max(found)


@pytest.mark.parametrize(
    ("flown_by", "found"),
    [((1, 0, 0, 1), meant.TURN), ((0, 1, 0, 1), meant.ALTITUDE), ((0, 0, 1, 1), meant.SPEED),
     ((1, 1, 0, 1), meant.COMBINED), ((1, 0, 1, 1), meant.COMBINED), ((1, 0, 0, 0), meant.LEAST_BAD)],
)  # fmt: skip
def test_how_a_conflict_is_avoided(flown_by: tuple[int, ...], found: int) -> None:
    told = [bool(one) for one in flown_by]
    assert resolution(meant.TRAFFIC_CONFLICT, *told) == found
    assert resolution(meant.FENCE_CONFLICT, *told) == found
    assert resolution(meant.RETURN_TO_PATH, *told) == meant.NONE


def test_each_mode_in_the_log_is_the_kernel_s() -> None:
    result, log = met()
    assert result.outcome == "complete"
    assert modes(log) == ["TrafficConflict", "ReturnToPath", "Nominal"]
    before, states = kernels.NOMINAL, of_type(log, "CognitionState")
    assert len(states) > 3
    for body in states:
        seen = Conditions(*(getattr(body, name.capitalize()) for name in Conditions._fields))
        before = decide(before, seen)
        assert int(body.Mode) == before
    taken = of_type(log, "AuthorityChange")[0]
    first = states[0]
    assert (first.Time, first.IntruderID) == (taken.Time, taken.IntruderID)
    assert first.Resolution.name == "Turn"
    assert all(b.Mode.name in ("Nominal", "Deviation") or b.Has or b is first for b in states)


def test_without_the_machine_nothing_is_avoided(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is flown follows from the mode: in one that is always nominal ICAROUS takes nothing over."""
    monkeypatch.setattr(logic, "decide", lambda mode, seen: kernels.NOMINAL)
    result, log = flown(meeting())
    assert result.takeovers == 0
    assert modes(log) in ([], ["Nominal"])


def test_a_mode_that_never_goes_back_keeps_the_vehicle(monkeypatch: pytest.MonkeyPatch) -> None:
    mission = meeting()
    limit = replace(mission.simulation, limit_ms=60_000)
    back = of_type(met()[1], "AuthorityChange")[-1]
    assert (back.Owner.name, back.Time < limit.limit_ms) == ("UxAS", True)
    monkeypatch.setattr(instance, "mode_lets_go", lambda mode: False)
    _, log = flown(replace(mission, simulation=limit))
    assert of_type(log, "AuthorityChange")[-1].Owner.name == "ICAROUS"


def test_a_goal_that_is_blocked_is_left_out_by_name(monkeypatch: pytest.MonkeyPatch) -> None:
    """A drone hovers over the first of two goals: the leg is given up, the next waypoint is flown to."""
    monkeypatch.setattr(legs, "LONGEST_LOOKAHEADS", 0.5)
    mission = load(MISSION)
    (drone,) = mission.traffic
    over = replace(drone, position=Position(1500.0, 0.0, 300.0))
    second = must_fly(2, (0.0, -2500.0, 300.0))
    tasks = (mission.tasks[0], second)
    result, log = flown(replace(mission, traffic=(over,), tasks=tasks, relations="|(p1 p2)"))
    assert modes(log) == ["TrafficConflict", "NextWaypoint", "Nominal"]
    skips = [b for b in of_type(log, "CognitionState") if b.Mode.name == "NextWaypoint"]
    assert all(b.Skips and b.Skipped > 0 for b in skips)
    assert result.failed[1].startswith("blocked: ")
    assert list(result.ends) == [2]
    assert result.outcome == "failed"


AHEAD = Zone(1, ZoneKind.KEEP_OUT, ((100, -300), (100, 300), (700, 300), (700, -300)), 0.0, 1000.0)
NARROW = Zone(2, ZoneKind.KEEP_IN, ((-99, -99), (-99, 99), (99, 99), (99, -99)), 0.0, 1000.0)
ROUTE = tuple(Position(n, 0.0, 300.0) for n in (-100.0, 5000.0))
CONFIG = Config(1, Daa(VOLUME, 60.0, 1.25), PROJECTION, 500, records=True)
FREE, OWNED = Gate(0, 0, False), Gate(1, 1, False)


def beat(state: State, gate: Gate = FREE, east_m: float = 0.0, *others: Intruder) -> State:
    """The state after a heartbeat in which the vehicle flies north, so far beside its route."""
    motion = NORTH._replace(position=Position(0.0, east_m, 300.0))
    return Instance(CONFIG).handle(state, Sensed(500, motion, ABILITY, others, gate))[0]


def told(*zones: Zone) -> State:
    return State(told=Told(zones=zones, waypoints=ROUTE, next_index=1, heard_ms=500, started=True))


def test_under_uxas_the_vehicle_is_off_its_plan_or_not() -> None:
    assert beat(told()).decided.mode == meant.NOMINAL
    assert beat(told(), FREE, ON_PATH_M + 1.0).decided.mode == meant.DEVIATION
    assert beat(State(), FREE, 500.0).decided.mode == meant.NOMINAL  # it has no plan


def test_a_zone_is_watched_off_the_plan_and_on_the_way_back() -> None:
    off = beat(told(AHEAD), FREE, 100.0)
    assert (off.decided.mode, off.cycle.mode) == (meant.FENCE_CONFLICT, AVOID)
    on = beat(told(AHEAD), OWNED)
    assert on.decided.mode == meant.FENCE_CONFLICT
    assert on.decided.resolution != meant.NONE
    assert beat(on, OWNED, 0.0, head_on(900.0)).decided.mode == meant.TRAFFIC_CONFLICT
    assert beat(told(), OWNED).decided.mode == meant.RETURN_TO_PATH


def test_without_the_link_a_conflict_is_answered_too() -> None:
    """Where traffic or a zone leaves no circle that is permitted, that is avoided until one is."""
    loiter = LostLink(LOITER, 1000, "a circle", lambda *_: ())
    config = CONFIG._replace(lost_link=loiter)

    def silent(*others: Intruder, zones: tuple[Zone, ...] = ()) -> Decided:
        state = State(told=Told(zones=zones, waypoints=ROUTE, next_index=1, heard_ms=-9000))
        here = Sensed(500, NORTH, ABILITY, others, FREE)
        return Instance(config).handle(state, here)[0].decided

    assert silent().mode == meant.LOST_LINK
    met = silent(head_on(400.0))
    assert (met.mode, met.seen.alone, met.seen.fence) == (meant.TRAFFIC_CONFLICT, True, False)
    shut = silent(zones=(NARROW,))
    assert (shut.mode, shut.seen.traffic) == (meant.FENCE_CONFLICT, False)


def test_the_diagram_in_the_guide_is_the_kernel_s(root: Path) -> None:
    assert_in_the_guide(root, "cognition_machine.py")
