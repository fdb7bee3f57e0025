"""Rows on circles at the end in the safe state, on logs made by hand: each condition of monitor and judge counts."""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from flight_logs import ALT_M, STEP_MS, Flies, Place, gate, message, mission_of, says, sent
from flight_logs import log_of as log_until
from ground_tools import Flown

from cratous.services.mission.zone_times import zones_of
from cratous.spec.mission import Mission

END_MS, LAST_MS = 150_000, 120_000
RADIUS_M, SPEED_M_S = 100.0, 22.0


def row(vehicle: int) -> str:
    return f"circle of vehicle {vehicle} at the end"


def circle(now_ms: int) -> Place:
    rad = SPEED_M_S * now_ms / 1000 / RADIUS_M
    return RADIUS_M * math.cos(rad), RADIUS_M * math.sin(rad), ALT_M


def slow(now_ms: int) -> Place:
    """The same circle at a speed at which it is too wide."""
    return circle(now_ms * 15 // 22)


def from_far(until_ms: int) -> Flies:
    """It comes straight from the north until then, and circles afterwards."""

    def path(now_ms: int) -> Place:
        if now_ms >= until_ms:
            return circle(now_ms)
        north, east, alt_m = circle(until_ms)
        return north + 33.0 * (until_ms - now_ms) / 1000, east, alt_m

    return path


def stands(north_m: float, east_m: float, alt_m: float = 0.0, until_ms: int = 0) -> Flies:
    """It circles until then, and stands there afterwards."""
    return lambda now_ms: circle(now_ms) if now_ms < until_ms else (north_m, east_m, alt_m)


def failed(vehicle: int) -> Any:
    return message("FailureState", 9000, VehicleID=vehicle, Failure="Ended")


log_of = partial(log_until, end_ms=END_MS)
ALONE = (gate("ICAROUS", 5000), says("Over", 20_000))
"""ICAROUS has vehicle 1, and it is said to circle."""


def both(mission: Mission, log: list[Any], folder: Path) -> dict[int, str]:
    """What monitor and judge say of each vehicle's circle; they agree."""
    flight = Flown(mission, log, None)  # type: ignore[arg-type]
    verdicts, judged = flight.verdicts(), flight.judged(folder, log)
    there = [n for n in sorted(mission.instances) if row(n) in verdicts]
    found = {n: verdicts[row(n)].outcome.value for n in there}
    assert {n: judged[row(n)] for n in sorted(mission.instances) if row(n) in judged} == found
    return found


@pytest.fixture(scope="module")
def mission(root: Path, tmp_path_factory: pytest.TempPathFactory) -> Mission:
    return mission_of(root, tmp_path_factory.mktemp("mission"))


BEGUN = END_MS - LAST_MS


@pytest.mark.parametrize(
    ("path", "said", "expected"),
    [
        (circle, ALONE, "holds"),
        (circle, (gate("ICAROUS", 5000), says("Loiter", 20_000)), "holds"),
        # it circles all the time, in one way or another
        (circle, (*ALONE, says("Loiter", 90_000)), "holds"),
        (circle, (*ALONE, says("Finish", 90_000), says("Over", 90_500)), "violated"),
        (circle, (gate("ICAROUS", 5000), says("Over", BEGUN)), "holds"),
        (circle, (gate("ICAROUS", 5000), says("Over", BEGUN + 1)), "violated"),
        (circle, (gate("ICAROUS", 5000), says("Finish", 20_000)), "violated"),
        (slow, ALONE, "violated"),
        # what was flown before does not count
        (from_far(BEGUN), ALONE, "holds"),
        (from_far(BEGUN + 30_000), ALONE, "violated"),
        # UxAS had it at the end, and nobody else was in ICAROUS's hand
        (circle, (*ALONE, gate("UxAS", 100_000)), "violated"),
        (circle, (says("Over", 20_000),), "violated"),
    ],
)  # fmt: skip
def test_it_is_said_to_circle_and_does(
    mission: Mission, path: Flies, said: tuple[Any, ...], expected: str, tmp_path: Path
) -> None:
    assert both(mission, log_of({1: path}, *said), tmp_path) == {1: expected}


def test_another_end_has_no_rows(mission: Mission, tmp_path: Path) -> None:
    assert both(mission, log_of({1: circle}, *ALONE, outcome="complete"), tmp_path) == {}
    assert both(mission, log_of({1: circle}, *ALONE)[:-1], tmp_path) == {}


def test_a_failure_that_was_not_asked_about_is_no_excuse(root: Path, tmp_path: Path) -> None:
    mission = mission_of(root, tmp_path, on_failure=None, landing_sites=None)
    assert both(mission, log_of({1: circle}, *ALONE, failed(1)), tmp_path) == {1: "holds"}


def test_the_row_tells_how_wide_it_flew(mission: Mission, tmp_path: Path) -> None:
    flight = Flown(mission, log_of({1: circle}, *ALONE), None)  # type: ignore[arg-type]
    found = flight.verdicts()[row(1)]
    assert found.note == (
        "in the last 120 s within 100.0 m of one place; a circle of 114.0 m is allowed; "
        "said to circle from 20.00 s"
    )
    assert (found.margin, found.unit) == (pytest.approx(14.0, abs=0.1), "m")
    assert found.checks == LAST_MS // STEP_MS + 1


def test_a_command_does_not_tell_who_has_it(mission: Mission, tmp_path: Path) -> None:
    late = sent(100_000, "GatedCommand", VehicleID=1, Sender="UxAS", Epoch=1)
    assert both(mission, log_of({1: circle}, *ALONE, late), tmp_path) == {1: "holds"}


def test_the_first_of_its_places_counts(mission: Mission, tmp_path: Path) -> None:
    """It was seen for exactly so long, and far away at first."""

    def path(now_ms: int) -> Place:
        return (5000.0, 0.0, ALT_M) if now_ms == 0 else circle(now_ms)

    said = gate("ICAROUS", 0), says("Over", 0)
    assert both(mission, log_of({1: circle}, *said, end_ms=LAST_MS), tmp_path) == {1: "holds"}
    assert both(mission, log_of({1: path}, *said, end_ms=LAST_MS), tmp_path) == {1: "violated"}


@pytest.mark.parametrize(
    ("path", "gap", "expected"),
    [
        (circle, range(20_000, 25_000), "holds"),
        (circle, range(5000), "holds"),
        (circle, range(60_000, 65_000), "unknown"),
        # last seen before, and far from its circle: that is no place of its last two minutes
        (from_far(20_000), range(BEGUN - 250, END_MS + 1), "unknown"),
    ],
)  # fmt: skip
def test_what_was_not_seen(
    mission: Mission, path: Flies, gap: range, expected: str, tmp_path: Path
) -> None:
    log = log_of({1: path}, *ALONE, gap=gap)
    assert both(mission, log, tmp_path) == {1: expected}


def test_who_is_elsewhere_has_no_row(root: Path, tmp_path: Path) -> None:
    """Vehicle 1 circles, 2 has declared a failure, 3 has landed, and UxAS has 4."""
    places = ({"north_m": 0, "east_m": 500 * n, "alt_m": 300} for n in (2, 3, 4))
    others = ({"id": n, "position": place} for n, place in enumerate(places, 2))
    mission = mission_of(root, tmp_path, *others)
    flies = {1: circle, 2: circle, 3: stands(300, 1500, 0, 40_000), 4: circle}
    said = [one for n in (2, 3) for one in (gate("ICAROUS", 5000, n), says("Over", 20_000, n))]
    log = log_of(flies, *ALONE, *said, failed(2), failed(9))
    assert both(mission, log, tmp_path) == {1: "holds"}
    # vehicle 1 is seen later than the others
    log = log_of(flies, *ALONE, *said, failed(2), gap=range(5000))
    assert both(mission, log, tmp_path) == {1: "holds"}
    # vehicle 3 stands beside all sites
    log = log_of({**flies, 3: stands(1000, 1500, 0, 40_000)}, *ALONE, *said, failed(2))
    assert both(mission, log, tmp_path) == {1: "holds", 3: "violated"}
    # with nobody but 2 and 3 in ICAROUS's hand nobody is in the safe state
    log = log_of(flies, *said, failed(2))
    assert both(mission, log, tmp_path) == dict.fromkeys(range(1, 5), "violated")


@pytest.mark.parametrize(("stays", "rows"), [(True, {1}), (False, {1, 2})])
def test_who_never_left_the_ground_has_no_row(
    root: Path, stays: bool, rows: set[int], tmp_path: Path
) -> None:
    start = {"north_m": 0, "east_m": 3000, "alt_m": 150}
    other = {"id": 2, "start": "ground", "position": start}
    mission = mission_of(root, tmp_path, other, on_failure=None, landing_sites=None)
    flies = {1: circle, 2: stands(0, 3000) if stays else circle}
    said = gate("ICAROUS", 5000, 2), says("Over", 20_000, 2)
    log = log_of(flies, *ALONE, *said)
    assert both(mission, log, tmp_path) == dict.fromkeys(rows, "holds")


@pytest.mark.parametrize(
    ("flies", "expected"),
    [
        (stands(1000, 1500, 0, 40_000), "violated"),  # beside all sites
        (stands(1000, 1500, 300, 40_000), "violated"),  # in the air
    ],
)
def test_who_stands_elsewhere_has_a_row(
    mission: Mission, flies: Flies, expected: str, tmp_path: Path
) -> None:
    """It jumped there: its places are in no circle."""
    assert both(mission, log_of({1: flies}, *ALONE), tmp_path) == {1: expected}


def between(now_ms: int, share: float = 0.5) -> dict[str, Any]:
    """A zone of 2 m about a place of the leg that begins then."""
    (a, b, _), (c, d, _) = circle(now_ms), circle(now_ms + STEP_MS)
    return square(a + share * (c - a), b + share * (d - b), 1.0)


def square(north_m: float, east_m: float, half_m: float) -> dict[str, Any]:
    corners = [(-half_m, -half_m), (half_m, -half_m), (half_m, half_m), (-half_m, half_m)]
    ring = [[north_m + a, east_m + b] for a, b in corners]
    return {"id": 7, "kind": "keep_out", "vertices": ring}


AT_MS = 140_000
"""After this the vehicle does not come to the same place again: a circle takes 28 s."""


@pytest.mark.parametrize(
    ("from_s", "until_s", "expected"),
    [
        (None, None, "violated"),
        (140, None, "violated"),
        # the leg had begun when the zone appeared, and begins when it ends
        (140.25, None, "holds"),
        (60, 140.25, "violated"),
        (139, 140, "holds"),
    ],
)
def test_zones_are_kept_while_they_are_in_force(
    root: Path, from_s: float | None, until_s: float | None, expected: str, tmp_path: Path
) -> None:
    zone = between(AT_MS)
    if from_s is None:
        found = mission_of(root, tmp_path, zones=[zone])
    else:
        changes = [{"at_s": from_s, "zone": zone}]
        changes += [] if until_s is None else [{"at_s": until_s, "zone_ends": 7}]
        found = mission_of(root, tmp_path, changes=changes)
    assert len(zones_of(found, END_MS)) == 1
    flies = from_far(AT_MS - 20_000) if from_s is None else circle
    begun = says("Over", 0) if from_s is None else says("Over", 20_000)
    log = log_of(
        {1: flies},
        gate("ICAROUS", 0),
        begun,
        end_ms=AT_MS - 20_000 + LAST_MS if from_s is None else END_MS,
    )
    assert both(found, log, tmp_path) == {1: expected}


def test_a_zone_that_it_may_have_flown_around_while_it_was_not_seen(
    root: Path, tmp_path: Path
) -> None:
    """The straight way between the places before and after crosses it, the circle does not."""
    gap = range(60_250, 70_000, STEP_MS)
    (a, b, _), (c, d, _) = circle(60_000), circle(70_000)
    mission = mission_of(root, tmp_path, zones=[square((a + c) / 2, (b + d) / 2, 5.0)])
    assert both(mission, log_of({1: circle}, *ALONE), tmp_path) == {1: "holds"}
    assert both(mission, log_of({1: circle}, *ALONE, gap=gap), tmp_path) == {1: "unknown"}


def test_a_zone_that_appears_at_the_end(root: Path, tmp_path: Path) -> None:
    """It is above the vehicle, and no leg begins in it."""
    north, east, _ = circle(END_MS)
    changes = [{"at_s": END_MS / 1000, "zone": square(north, east, 5.0)}]
    mission = mission_of(root, tmp_path, changes=changes)
    assert both(mission, log_of({1: circle}, *ALONE), tmp_path) == {1: "holds"}


def test_a_zone_that_was_broken_before(root: Path, tmp_path: Path) -> None:
    path = from_far(BEGUN)
    north, east, _ = path(BEGUN - 10_000)
    mission = mission_of(root, tmp_path, zones=[square(north, east, 5.0)])
    assert both(mission, log_of({1: path}, *ALONE), tmp_path) == {1: "holds"}
    path = from_far(BEGUN + 1000)
    north, east, _ = path(BEGUN + 500)
    mission = mission_of(root, tmp_path, zones=[square(north, east, 5.0)])
    assert both(mission, log_of({1: path}, *ALONE), tmp_path) == {1: "violated"}
