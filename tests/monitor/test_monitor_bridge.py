"""The monitor on authority and the bridge: who commands, and whether heartbeats come."""

from __future__ import annotations

from typing import Any

import pytest
from monitor_tools import PLAN, Envelope, apart, beats, command, done, mission, truth, watch

from cratous.bridge import lmcp
from cratous.services.monitor import Monitor
from cratous.spec.mission import (
    FaultySimulation,
)
from cratous.spec.mission.bridge_faults import BridgeFaults
from cratous.spec.mission.guarantees import Outcome


def gate(ms: int, owner: str, epoch: int, offered: bool = False) -> tuple[int, Any]:
    return ms, lmcp.new(
        "GateState", VehicleID=1, Time=ms, Owner=owner, Epoch=epoch, Offered=offered
    )


def dropped(ms: int, epoch: int) -> tuple[int, Any]:
    return ms, lmcp.new("CommandDropped", VehicleID=1, Time=ms, Epoch=epoch)


TAKEN = [gate(600, "ICAROUS", 1), command(600, "ICAROUS", 1)]
BACK = [gate(800, "ICAROUS", 2, True), command(900, "UxAS", 2), gate(900, "UxAS", 2)]


def authority(*messages: tuple[int, Any]) -> Any:
    basis = [*apart(), *beats(3000), *done()]
    return watch(mission(), sorted([*messages, *basis], key=lambda m: m[0]))["G4"]


def test_a_takeover_that_is_handed_back_holds():
    assert authority(command(0, "UxAS", 0), *TAKEN, *BACK).outcome is Outcome.HOLDS
    stale = [command(700, "UxAS", 0), dropped(700, 0)]
    assert authority(*TAKEN, *stale, *BACK).outcome is Outcome.HOLDS


def link(ms: int, alive: bool, vehicle: int = 1) -> tuple[int, Any]:
    note = "heard again" if alive else "link lost: eof"
    return ms, lmcp.new("BridgeStatus", VehicleID=vehicle, Time=ms, Alive=alive, Note=note)


@pytest.mark.parametrize(
    ("statuses", "expected"),
    [
        ([], "violated"),
        ([link(100, False)], "unknown"),  # before the takeover
        ([link(900, False)], "unknown"),
        ([link(900, True)], "violated"),
        (
            [link(900, False), link(1000, True)],
            "violated",
        ),  # alive again, and still not handed back
        ([link(900, False), link(1000, True), link(1100, False)], "unknown"),
        ([link(900, False, 90)], "violated"),  # another vehicle's
    ],
)
def test_a_takeover_that_is_open_at_the_end_is_unknown_only_where_the_link_is_declared_down(
    statuses, expected
):
    verdict = authority(command(0, "UxAS", 0), *TAKEN, *statuses)
    assert verdict.outcome.value == expected
    assert "the takeover of 0.60 s was never handed back" in verdict.note
    assert ("the link was declared down since" in verdict.note) == (expected == "unknown")
    assert authority(command(0, "UxAS", 0), *TAKEN, *BACK, *statuses).outcome is Outcome.HOLDS
    # what else is wrong stays so
    assert authority(*TAKEN, command(700, "UxAS", 0), *statuses).outcome is Outcome.VIOLATED


@pytest.mark.parametrize(
    ("messages", "wanted"),
    [
        (TAKEN, "never handed back"),
        ([*TAKEN, gate(900, "UxAS", 2)], "went from ICAROUS in epoch 1 to UxAS in epoch 2"),
        ([gate(600, "ICAROUS", 0)], "went from UxAS in epoch 0 to ICAROUS in epoch 0"),
        ([*TAKEN, command(700, "UxAS", 0), *BACK], "was not dropped"),
        ([command(100, "UxAS", 0), dropped(100, 0)], "dropped that had authority"),
        ([*TAKEN, *BACK[:2]], "the gate did not change"),
    ],
)
def test_two_commanders_or_none_are_seen(messages, wanted):
    verdict = authority(*messages)
    assert verdict.outcome is Outcome.VIOLATED
    assert wanted in verdict.note


def test_what_was_forged_is_refused_counted_and_told():
    forged = [command(700, "UxAS", 10**14), dropped(700, 10**14)]
    mode = lmcp.new("ModeRefused", VehicleID=1, Time=750, Owner="ICAROUS", Epoch=10**14)
    verdict = authority(command(0, "UxAS", 0), *TAKEN, *forged, (750, mode), *BACK)
    assert verdict.outcome is Outcome.HOLDS
    assert (
        "1 of them stale and dropped, 1 of these of an epoch that was never given" in verdict.note
    )
    assert verdict.note.endswith("1 modes refused that could not be true")


def test_a_silent_bridge_is_seen_and_a_missing_one_is_unknown():
    gap = [m for m in beats(3000) if not 700 < m[0] < 2300]
    verdict = watch(mission(), [*apart(), *gap, *done()])["G5"]
    assert verdict.outcome is Outcome.VIOLATED
    assert verdict.margin == pytest.approx(-1.0)
    none = watch(mission(instances=()), [*apart(), *done()])["G5"]
    assert none.outcome is Outcome.UNKNOWN


WAYS = {way: f"G5:heartbeat {way} the ICAROUS instance of 1" for way in ("to", "from")}


def outcomes(messages: list[tuple[int, Any]], end_ms: int = 3000, **how: bool) -> dict[str, str]:
    seen = watch(mission(), [*apart(end_ms), *messages, *done(end_ms)], **how)
    return {way: str(seen[item].outcome) for way, item in WAYS.items()}


def test_no_heartbeat_at_all_is_a_silence_unless_the_protocol_has_none():
    down = [m for m in beats(3000) if m[1].Direction.name == "Down"]
    assert outcomes([]) == {"to": "violated", "from": "violated"}
    assert outcomes(down) == {"to": "holds", "from": "violated"}
    assert outcomes(down, says_beats=False) == {"to": "holds", "from": "unknown"}
    assert outcomes([], says_beats=False) == {"to": "violated", "from": "unknown"}
    assert outcomes([*down, link(2500, False)], says_beats=False) == dict.fromkeys(WAYS, "violated")


def test_of_a_flight_too_short_for_one_to_be_late_none_is_missed():
    assert outcomes([], end_ms=1000) == {"to": "unknown", "from": "unknown"}


def again(number: int, *times: int) -> list[tuple[int, Any]]:
    """A heartbeat that comes again at these times, both ways of both vehicles."""
    return [
        (ms, lmcp.new("Heartbeat", VehicleID=v, Time=ms, Direction=way, Sequence=number))
        for ms in times
        for v in (1, 2)
        for way in ("Down", "Up")
    ]


def in_order(messages: list[tuple[int, Any]]) -> list[tuple[int, Any]]:
    return sorted(messages, key=lambda one: one[0])


def test_a_heartbeat_that_comes_again_or_too_late_is_no_sign_of_life():
    whole = in_order([*beats(3000), *again(1, 1200, 2700), *again(3, 2600)])
    assert watch(mission(), [*apart(), *whole, *done()])["G5"].outcome is Outcome.HOLDS
    gap = in_order([m for m in beats(3000) if not 700 < m[0] < 2300] + again(1, 1000, 1500, 2000))
    verdict = watch(mission(), [*apart(), *gap, *done()])["G5"]
    assert verdict.outcome is Outcome.VIOLATED
    assert verdict.margin == pytest.approx(-1.0)


def test_of_a_bridge_that_was_made_to_fail_nobody_knows_what_came_down():
    faulty = mission(simulation=FaultySimulation(bridge_faults=BridgeFaults(loss=0.5)))
    seen = watch(faulty, [*apart(), *beats(3000), *done()])
    ways = {way: seen[f"G5:heartbeat {way} the ICAROUS instance of 1"] for way in ("to", "from")}
    assert {way: v.outcome for way, v in ways.items()} == {
        "to": Outcome.UNKNOWN,
        "from": Outcome.HOLDS,
    }
    assert "whether they came is not logged" in ways["to"].note
    assert ways["to"].kernels == ()


def test_messages_that_stop_leave_it_unknown():
    seen = watch(mission(), [*apart(), *beats(3000), *done()[:-1]])
    assert seen["G4"].outcome is Outcome.UNKNOWN
    assert seen["G3"].outcome is Outcome.UNKNOWN


def test_a_violation_is_told_when_it_happens():
    told: list[Any] = []
    monitor = Monitor(mission(), PLAN, told.append)
    for ms, body in [
        truth(1, 0, 0, 0),
        truth(2, 0, 10, 0),
        truth(1, 250, 0, 0),
        truth(2, 250, 10, 0),
    ]:
        monitor.tap(Envelope(lmcp.full_names(body)[0], ms, body))
    assert told == []
    ms, body = truth(1, 500, 0, 0)
    monitor.tap(Envelope(lmcp.full_names(body)[0], ms, body))
    assert [v.requirement for v in told] == ["G2"]
