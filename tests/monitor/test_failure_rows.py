"""Rows on declared failures, on logs made by hand: each condition of monitor and judge counts."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from flight_logs import ALT_M, both_of, gate, log_of, message, mission_of, says, sent
from ground_tools import Flown

from cratous.spec.mission import Mission

ROW = "what vehicle 1 does after a failure"
END_MS = 90_000
GOOD, BAD = "holds", "violated"


def declared(failure: str, time_ms: int = 10_000) -> Any:
    return message("FailureState", time_ms, VehicleID=1, Failure=failure)


def given_up(time_ms: int = 9000, vehicle: int = 1, **fields: Any) -> Any:
    said = {"TaskID": 1, "Phase": "Failed", "Note": "blocked: by 90", **fields}
    return message("TaskProgress", time_ms, VehicleID=vehicle, **said)


def hand(change: str, time_ms: int) -> Any:
    return message("HandState", time_ms, VehicleID=1, Change=change)


def holds_from(time_ms: int = 10_000, **fields: Any) -> Any:
    return says("Loiter", time_ms, Chosen="Loiter", **fields)


TAKEN, UXAS_LAST = gate("ICAROUS", 5000), gate("ICAROUS", 10_000)
MISSING = hand("Missing", 8000)


@pytest.fixture(scope="module")
def mission(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Mission:
    return mission_of(
        root, tmp_path_factory.mktemp("mission"), on_failure={"choice": "hold"}, landing_sites=None
    )


def verdicts(mission: Mission, folder: Path, *said: Any, ends: bool = True) -> tuple[str, str]:
    """The monitor's verdict and the judge's."""
    log = log_of({}, *said, end_ms=END_MS, outcome="failed")
    return both_of(mission, log if ends else log[:-1], ROW, folder)


BLOCKED = (TAKEN, given_up(), declared("Blocked"), holds_from())
ENDED = (declared("Ended"), UXAS_LAST, holds_from())
EXPIRING = (TAKEN, MISSING, declared("Expiring"), holds_from())


@pytest.mark.parametrize(
    ("said", "expected"),
    [
        ((), GOOD),
        (BLOCKED, GOOD),
        (ENDED, GOOD),
        (EXPIRING, GOOD),
        ((TAKEN, MISSING, declared("Surprised"), holds_from()), GOOD),
        # no task of it was given up by then
        ((TAKEN, declared("Blocked"), holds_from()), BAD),
        ((TAKEN, given_up(vehicle=2), declared("Blocked"), holds_from()), BAD),
        ((TAKEN, given_up(Phase="Suspended"), declared("Blocked"), holds_from()), BAD),
        ((TAKEN, declared("Blocked"), holds_from(), given_up(11_000)), BAD),
        # who had it
        ((given_up(), declared("Blocked"), UXAS_LAST, holds_from()), BAD),
        ((MISSING, declared("Expiring"), UXAS_LAST, holds_from()), BAD),
        ((TAKEN, *ENDED), BAD),
        ((TAKEN, gate("UxAS", 6000), *ENDED), GOOD),
        ((TAKEN, gate("UxAS", 6000), *BLOCKED[1:]), BAD),
        ((TAKEN, gate("UxAS", 6000), *ENDED[::2]), BAD),
        ((*BLOCKED, gate("ICAROUS", 20_000), gate("UxAS", 20_500, 2)), GOOD),
        (ENDED[::2], BAD),
        ((*ENDED[::2], gate("ICAROUS", 10_001)), BAD),
        ((*ENDED, gate("UxAS", 20_000)), BAD),
        ((*ENDED, gate("UxAS", 20_000), gate("ICAROUS", 21_000)), BAD),
        # certificates were there until less than four heartbeats before
        ((TAKEN, hand("Missing", 8001), declared("Expiring"), holds_from()), BAD),
        ((TAKEN, declared("Expiring"), holds_from()), BAD),
        ((TAKEN, hand("Known", 7000), declared("Expiring"), holds_from()), BAD),
        ((TAKEN, MISSING, hand("Offered", 8500), declared("Expiring"), holds_from()), BAD),
        ((TAKEN, MISSING, hand("Offered", 8500), hand("Missing", 9000), *EXPIRING[2:]), BAD),
        ((TAKEN, MISSING, hand("Missing", 9000), *EXPIRING[2:]), GOOD),
        ((TAKEN, MISSING, hand("Known", 9000), *EXPIRING[2:]), GOOD),
        ((*EXPIRING, hand("Offered", 20_000)), GOOD),
        # a failure is for good
        ((*BLOCKED, declared("Blocked", 20_000)), BAD),
        ((*BLOCKED, *BLOCKED[2:]), BAD),
        ((*BLOCKED, MISSING, declared("Expiring", 20_000)), BAD),
        # what is flown then
        (BLOCKED[:-1], BAD),
        ((*BLOCKED[:-1], holds_from(10_500)), BAD),
        ((*BLOCKED[:-1], holds_from(10_001)), BAD),
        ((*BLOCKED[:-1], says("Loiter", 10_000, Chosen="Return")), BAD),
        ((*BLOCKED[:-1], says("Return", 10_000, Chosen="Loiter")), BAD),
        ((*BLOCKED[:-1], says("Linked", 10_000, Chosen="Loiter")), BAD),
        ((*BLOCKED, holds_from(20_000)), BAD),
        ((*BLOCKED, says("Linked", 20_000, Chosen="Loiter", Heard=20_000)), BAD),
        ((*BLOCKED, says("Landed", 20_000, Chosen="Loiter")), BAD),
        # said at the same instant, but before the failure
        ((TAKEN, MISSING, holds_from(), declared("Expiring")), BAD),
        ((TAKEN, MISSING, holds_from(), declared("Expiring"), holds_from()), BAD),
    ],
)  # fmt: skip
def test_a_failure_and_what_is_flown_then(
    mission: Mission, said: tuple[Any, ...], expected: str, tmp_path: Path
) -> None:
    assert verdicts(mission, tmp_path, *said) == (expected, expected)


COMMAND = sent(20_000, "GatedCommand", VehicleID=1, Sender="UxAS", Epoch=1)
FLIES_ON = says("Finish", 40_000, Heard=9999)
"""UxAS was heard last 30.001 s before."""


@pytest.mark.parametrize(
    ("said", "expected"),
    [
        ((TAKEN, FLIES_ON), GOOD),
        ((TAKEN, FLIES_ON, says("Over", 50_000, Heard=9999)), GOOD),
        ((TAKEN, FLIES_ON, says("Linked", 50_000, Heard=49_900)), GOOD),
        ((TAKEN, FLIES_ON, says("Linked", 50_000, Heard=49_900), gate("UxAS", 50_500)), GOOD),
        ((TAKEN, FLIES_ON, gate("UxAS", 49_950), says("Linked", 50_000, Heard=49_900)), GOOD),
        ((TAKEN, gate("UxAS", 20_000, 2), COMMAND, FLIES_ON), GOOD),
        # what UxAS has counts as heard
        ((TAKEN, FLIES_ON, gate("UxAS", 49_950), says("Linked", 50_000, Heard=9999)), GOOD),
        ((TAKEN, FLIES_ON, says("Linked", 50_000, Heard=9999)), BAD),
        ((TAKEN, says("Finish", 40_000, Heard=10_000)), BAD),
        ((TAKEN, says("Over", 40_000, Heard=9999)), BAD),
        ((TAKEN, says("Finish", 40_000, Heard=9999, Chosen="Loiter")), BAD),
        ((TAKEN, FLIES_ON, says("Land", 50_000, Heard=9999)), BAD),
        # what is flown already does not begin
        ((TAKEN, FLIES_ON, says("Finish", 50_000, Heard=9999)), BAD),
        ((TAKEN, says("Linked", 5500, Heard=5500)), BAD),
        ((FLIES_ON,), BAD),
        ((TAKEN, gate("UxAS", 20_000), FLIES_ON), BAD),
        # a failure begins what is flown anew
        ((TAKEN, MISSING, FLIES_ON, declared("Expiring", 50_000), holds_from(50_000)), GOOD),
        ((TAKEN, MISSING, FLIES_ON, declared("Expiring", 50_000)), BAD),
    ],
)  # fmt: skip
def test_what_is_flown_without_the_link_before_a_failure(
    mission: Mission, said: tuple[Any, ...], expected: str, tmp_path: Path
) -> None:
    assert verdicts(mission, tmp_path, *said) == (expected, expected)


SENSING = {"sensors": [{"kind": "adsb", "horizontal_m": 8, "vertical_m": 6, "velocity_m_s": 0.8}]}
MERGING = {
    "fix": {"name": "gate", "position": {"north_m": 3000, "east_m": 0, "alt_m": 300}},
    "vehicles": [1, 2], "coordination_m": 2500, "schedule_m": 1500, "entry_m": 300,
}  # fmt: skip
CLOSE = {"well_clear": {"dthr_m": 150, "zthr_m": 30, "tthr_s": 5, "tcoa_s": 0}, "lookahead_s": 30}
SILENT = {"choice": "finish", "after_s": 3}


@pytest.mark.parametrize(
    ("sections", "expected"),
    [
        ({"sensing": SENSING}, BAD),
        ({"merging": MERGING, "daa": CLOSE}, BAD),
        # the mission's own procedure has a row of its own
        ({"sensing": SENSING, "link_loss": SILENT}, GOOD),
    ],
)
def test_vehicles_that_sense_or_merge_fly_nothing_without_the_link_before_a_failure(
    root: Path, sections: dict[str, Any], expected: str, tmp_path: Path
) -> None:
    other = {"id": 2, "position": {"north_m": 0, "east_m": 2000, "alt_m": 300}}
    after = {"choice": "hold"}
    mission = mission_of(root, tmp_path, other, on_failure=after, landing_sites=None, **sections)
    assert verdicts(mission, tmp_path, TAKEN, FLIES_ON) == (expected, expected)
    anew = (TAKEN, MISSING, FLIES_ON, declared("Expiring", 50_000), holds_from(50_000))
    assert verdicts(mission, tmp_path, *anew) == (expected, expected)
    assert verdicts(mission, tmp_path, *BLOCKED) == (GOOD, GOOD)


ENDS_IT = (*ENDED[:2], holds_from())
TELLS_LATE = says("Finish", 10_000, Heard=2000)
"""It began 8 s after UxAS was last heard, where 3 s were asked for."""
DOWN = message("BridgeStatus", 0, VehicleID=1, Alive=False, Note="link lost: closed")
AT_ONCE = (declared("Ended", 0), gate("ICAROUS", 0), holds_from(0))


@pytest.mark.parametrize(
    ("said", "expected"),
    [
        (ENDS_IT, GOOD),
        # at the instant of the failure: before it what is said counts here, and not after it
        ((TELLS_LATE, *ENDS_IT), BAD),
        ((*ENDED[:2], TELLS_LATE), GOOD),
        ((DOWN, *ENDS_IT), BAD),
        ((DOWN, *AT_ONCE), GOOD),
    ],
)
def test_the_row_on_the_link_goes_up_to_the_failure(
    root: Path, said: tuple[Any, ...], expected: str, tmp_path: Path
) -> None:
    after = {"choice": "hold"}
    mission = mission_of(root, tmp_path, on_failure=after, landing_sites=None, link_loss=SILENT)
    log = log_of({}, *said, end_ms=END_MS, outcome="failed")
    row = "what vehicle 1 flies without the link"
    assert both_of(mission, log, row, tmp_path) == (expected, expected)


@pytest.mark.parametrize(
    ("said", "note"),
    [
        ((), "it declared no failure"),
        (BLOCKED, "blocked at 10.00 s, Loiter from 10.00 s"),
        ((TAKEN, FLIES_ON), "Finish from 40.00 s, without the link"),
        # what others say is not of this vehicle
        (
            (given_up(vehicle=9), gate("ICAROUS", 1, 9), says("Over", 2, 9)),
            "it declared no failure",
        ),
        (
            (
                message("FailureState", 1, VehicleID=9, Failure="Ended"),
                message("HandState", 1, VehicleID=9, Change="Missing"),
            ),
            "it declared no failure",
        ),
    ],
)
def test_the_row_tells_what_was_said(
    mission: Mission, said: tuple[Any, ...], note: str, tmp_path: Path
) -> None:
    log = log_of({}, *said, end_ms=END_MS, outcome="failed")
    flight = Flown(mission, log, None)  # type: ignore[arg-type]
    found = flight.verdicts()[ROW]
    assert found.note == note
    assert bool(found.kernels) == bool(found.checks)
    assert flight.judged(tmp_path)[ROW] == GOOD


def test_a_mission_that_asks_about_none_has_no_row(root: Path, tmp_path: Path) -> None:
    mission = mission_of(root, tmp_path, on_failure=None, landing_sites=None)
    assert verdicts(mission, tmp_path, *BLOCKED) == ("", "")


def test_failures_that_a_mission_does_not_ask_about(root: Path, tmp_path: Path) -> None:
    after = {"choice": "hold", "of": ["blocked"]}
    mission = mission_of(root, tmp_path, on_failure=after, landing_sites=None)
    assert verdicts(mission, tmp_path, *BLOCKED) == (GOOD, GOOD)
    assert verdicts(mission, tmp_path, *ENDED) == (BAD, BAD)
    assert verdicts(mission, tmp_path, *EXPIRING) == (BAD, BAD)


def test_a_task_that_was_given_up_for_another_reason(mission: Mission, tmp_path: Path) -> None:
    """The judge does not read the reason."""
    other = given_up(Note="it cannot be served in time")
    monitor, _ = verdicts(mission, tmp_path, TAKEN, other, *BLOCKED[2:])
    assert monitor == BAD


def test_what_is_not_whole_is_unknown(mission: Mission, tmp_path: Path) -> None:
    assert verdicts(mission, tmp_path, *BLOCKED, ends=False) == ("unknown", "unknown")
    assert verdicts(mission, tmp_path, ends=False) == ("unknown", "unknown")
    assert verdicts(mission, tmp_path, *BLOCKED[:2], ends=False) == ("unknown", "unknown")
    assert verdicts(mission, tmp_path, *ENDED[::2], ends=False) == ("unknown", "unknown")
    assert verdicts(mission, tmp_path, *BLOCKED[:-1], ends=False) == ("unknown", "unknown")
    # what is wrong is wrong without an end
    assert verdicts(mission, tmp_path, TAKEN, *ENDED, ends=False) == (BAD, BAD)


def descent(now_ms: int) -> tuple[float, float, float]:
    """It is at rest on the ground of the site from 60 s on."""
    return 300.0, 1500.0, max(ALT_M - 5 * now_ms / 1000, 0.0)


def beside(now_ms: int) -> tuple[float, float, float]:
    return descent(now_ms)[0] + 400, *descent(now_ms)[1:]


LANDS = tuple(says(m, t, Chosen="Land") for m, t in (("Land", 10_000), ("Final", 40_000)))
SAYS_SO = says("Landed", 60_500, Chosen="Land")


@pytest.mark.parametrize(
    ("path", "said", "gap", "expected"),
    [
        (descent, (*LANDS, SAYS_SO), range(0), GOOD),
        (descent, LANDS, range(0), BAD),
        (descent, (*LANDS, says("Landed", 50_000, Chosen="Land")), range(0), BAD),
        (beside, (*LANDS, SAYS_SO), range(0), BAD),
        (descent, (*LANDS, SAYS_SO), range(20_000, 25_000), "unknown"),
        (descent, (*LANDS, SAYS_SO, declared("Ended", 70_000)), range(0), BAD),
    ],
)  # fmt: skip
def test_a_landing_is_judged_by_its_positions(
    root: Path, path: Any, said: tuple[Any, ...], gap: range, expected: str, tmp_path: Path
) -> None:
    mission = mission_of(root, tmp_path)
    log = log_of({1: path}, *ENDED[:2], *said, end_ms=END_MS, outcome="failed", gap=gap)
    assert both_of(mission, log, ROW, tmp_path) == (expected, expected)


def test_a_command_of_uxas_takes_no_vehicle_back(mission: Mission, tmp_path: Path) -> None:
    assert verdicts(mission, tmp_path, *BLOCKED, COMMAND) == (GOOD, GOOD)
    early = sent(9500, "GatedCommand", VehicleID=1, Sender="UxAS", Epoch=1)
    assert verdicts(mission, tmp_path, *BLOCKED[:2], early, *BLOCKED[2:]) == (GOOD, GOOD)
