"""When vehicles pass a merge fix, by monitor and judge: once per stay. And the direct links that lose messages."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest

from cratous.judge import merging as judge
from cratous.judge.log import Log, State
from cratous.judge.mission_file import read
from cratous.judge.tracks import tracks
from cratous.services.flight.merging import DirectTalk
from cratous.services.icarous.merger import FOLLOWS, Said, Wish
from cratous.services.icarous.messages import Tells
from cratous.services.loading import load
from cratous.services.mission.merging import merging_of
from cratous.services.monitor.merging import KERNELS, MergeWatch
from cratous.services.monitor.observation import Ending, Presence
from cratous.services.monitor.samples import Sample
from cratous.spec.mission import MergingDaa, Mission, Position
from cratous.spec.mission.guarantees import Outcome, Verdict
from cratous.spec.mission.merging import DirectFaults

EXAMPLE = "examples/merging/mission.yaml"
STEP_MS, END_MS, SPEED_M_S = 250, 120_000, 20.0
East = Callable[[int], float]
"""Position of a vehicle on the east axis [m], by the time [ms]; the fix is the origin."""


def straight(at_ms: float) -> East:
    """It passes the fix once, at an instant."""
    return lambda now_ms: (now_ms - at_ms) / 1000 * SPEED_M_S


def far(now_ms: int) -> float:
    return 5000.0


def turns_before(now_ms: int) -> float:
    """It comes straight up to 1000 m before the fix, and goes back."""
    return 1000 + abs(60_000 - now_ms) / 1000 * SPEED_M_S


def there_and_back(now_ms: int) -> float:
    """It passes at 20 s, turns 1200 m behind the fix, and passes at 100 s."""
    return min(now_ms - 20_000, 100_000 - now_ms) / 1000 * SPEED_M_S


def turns_inside(now_ms: int) -> float:
    """It comes up to 200 m before the fix at 60 s, and goes back."""
    return 200 + abs(60_000 - now_ms) / 1000 * SPEED_M_S


def hovers(now_ms: int) -> float:
    return 100.0


def seen(root: Path, one: East, other: East, gap: range = range(0)) -> tuple[Verdict, str]:
    """The monitor's verdict and the judge's on vehicles 1 and 2. gap: when 2 was not seen [ms]."""
    mission = load(root / EXAMPLE)
    presence = Presence(STEP_MS)
    watch = MergeWatch(mission, presence)
    times = range(0, END_MS + 1, STEP_MS)
    paths = {1: one, 2: other, 3: far}

    def instant(now_ms: int) -> dict[int, Sample]:
        return {
            n: Sample(now_ms, Position(0.0, path(now_ms), 300.0), 0.0, True, 0)
            for n, path in paths.items()
            if n != 2 or now_ms not in gap
        }

    for before, after in pairwise(map(instant, times)):
        presence.step(before, after)
        watch.step(before, after)
    first = watch.verdicts(Ending(END_MS, True))[0]
    assert first.vehicles == (1, 2)
    log = Log(root, ends=[(END_MS, "complete")])
    log.states = {
        n: [
            State(t, 0.0, path(t), 300.0, 0.0, (path(t + STEP_MS) - path(t)) * 1000 / STEP_MS, 0.0)
            for t in times
            if n != 2 or t not in gap
        ]
        for n, path in paths.items()
    }
    judged = read(root / EXAMPLE)
    return first, next(judge.rows(judged, tracks(judged, log))).verdict


@pytest.mark.parametrize(
    ("one", "other", "outcome", "judged", "passages"),
    [
        (straight(30_000), straight(50_000), Outcome.HOLDS, "holds", 1),
        (straight(30_000), straight(49_998), Outcome.VIOLATED, "violated", 1),
        # half a millisecond short: the monitor's whole milliseconds do not decide it
        (straight(30_000), straight(49_999.5), Outcome.UNKNOWN, "violated", 1),
        (straight(60_000), there_and_back, Outcome.HOLDS, "holds", 2),
        (straight(90_000), there_and_back, Outcome.VIOLATED, "violated", 2),
        (straight(30_000), there_and_back, Outcome.VIOLATED, "violated", 2),
        # where it turns it is nearest
        (straight(80_000), turns_inside, Outcome.HOLDS, "holds", 1),
        (straight(79_000), turns_inside, Outcome.VIOLATED, "violated", 1),
        (straight(40_000), turns_inside, Outcome.HOLDS, "holds", 1),
        (straight(41_000), turns_inside, Outcome.VIOLATED, "violated", 1),
        (straight(30_000), hovers, Outcome.HOLDS, "holds", 1),
    ],
)  # fmt: skip
def test_each_stay_at_the_fix_is_one_passage(
    root: Path, one: East, other: East, outcome: Outcome, judged: str, passages: int
) -> None:
    verdict, by_judge = seen(root, one, other)
    assert (verdict.outcome, by_judge) == (outcome, judged)
    assert (verdict.checks, verdict.unit) == (passages, "s")
    assert verdict.kernels == KERNELS
    assert (verdict.margin or 0) >= 0 if judged == "holds" else (verdict.margin or 0) < 0


@pytest.mark.parametrize(
    ("other", "gap", "expected"),
    [
        (straight(60_000), range(45_000, 48_000), "unknown"),
        (straight(60_000), range(59_000, 62_000), "unknown"),
        (straight(60_000), range(45_000), "unknown"),
        (straight(40_000), range(100_000, 105_000), "violated"),
    ],
)
def test_what_was_not_seen_shows_nothing(
    root: Path, other: East, gap: range, expected: str
) -> None:
    verdict, judged = seen(root, straight(30_000), other, gap)
    assert (verdict.outcome.value, judged) == (expected, expected)
    assert verdict.note.startswith("aircraft 2 was not observed") == (expected == "unknown")


@pytest.mark.parametrize("other", [far, turns_before])
@pytest.mark.parametrize(("one", "passed"), [(straight(30_000), True), (far, False)])
def test_a_pair_of_which_one_does_not_pass_is_unknown(
    root: Path, one: East, passed: bool, other: East
) -> None:
    """It held with 0 checks, also where neither passed."""
    verdict, judged = seen(root, one, other)
    assert (verdict.outcome, judged) == (Outcome.UNKNOWN, "unknown")
    assert (verdict.checks, verdict.kernels, verdict.margin) == (0, (), None)
    assert verdict.note.startswith("no two passages to compare; ")
    assert ("vehicle 1 did not pass" in verdict.note) is not passed
    assert "vehicle 2 did not pass" in verdict.note


def test_the_messages_of_a_share_are_lost_and_the_same_ones_each_time(root: Path) -> None:
    def delivered(loss: float, seed: int) -> list[int]:
        links = DirectTalk(lossy(load(root / EXAMPLE), loss, seed), {1, 2, 3})
        said = Said(1, 0, 0, 0, FOLLOWS, Wish(), ())
        arrived = []
        for k in range(500):
            links.tell(Tells(1, said))
            arrived.append(len(list(links.come(500 * k))))
        return arrived

    assert sum(delivered(0.0, 0)) == 1000
    assert 250 < sum(delivered(0.7, 0)) < 350
    assert delivered(0.7, 0) == delivered(0.7, 0)
    assert delivered(0.7, 0) != delivered(0.7, 1)


def lossy(mission: Mission, loss: float, seed: int) -> Mission:
    merging, daa = merging_of(mission), mission.daa
    assert merging is not None
    assert isinstance(daa, MergingDaa)
    merging = replace(merging, faults=DirectFaults(seed, loss))
    return replace(mission, daa=replace(daa, merging=merging))
