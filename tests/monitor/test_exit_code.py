"""The exit code of verdicts: what kernels without proof have judged is at best unknown."""

from __future__ import annotations

import pytest

from cratous.spec.mission.guarantees import Outcome, exit_code

HOLDS, VIOLATED = Outcome.HOLDS, Outcome.VIOLATED


@pytest.mark.parametrize(
    ("outcomes", "proved", "unproved"),
    [
        ([HOLDS, HOLDS], 0, 3),
        ([HOLDS, Outcome.EXCUSED], 3, 3),
        ([HOLDS, Outcome.UNKNOWN], 3, 3),
        ([VIOLATED, HOLDS], 1, 1),
        ([], 3, 3),
    ],
)
def test_no_verdict_without_proof_is_better_than_unknown(
    outcomes: list[Outcome], proved: int, unproved: int
) -> None:
    assert exit_code(outcomes) == proved
    assert exit_code(outcomes, unproved=True) == unproved
