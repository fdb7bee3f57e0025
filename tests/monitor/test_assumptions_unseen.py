"""What the watch of "flown as looked at" says of an aircraft that is not seen for a while."""

from __future__ import annotations

from dataclasses import replace

import pytest
from assumption_logs import LIMIT_MS, WHOLE, Change, flown, judged, tampered
from tampering import Log


def unseen(number: int, since_ms: int, until_ms: int) -> Change:
    """An aircraft has no samples between two instants."""

    def change(log: Log) -> None:
        log[:] = [
            one for one in log
            if not one.topic.endswith("TruthState") or one.body.VehicleID != number
            or not since_ms <= one.time_ms < until_ms
        ]  # fmt: skip

    return change


@pytest.mark.parametrize("number", [1, 90])
@pytest.mark.parametrize(
    ("since_ms", "until_ms", "said"),
    [
        (0, LIMIT_MS, "was not seen from 0.00 s to"),
        (0, 5000, "was not seen from 0.00 s to 5.00 s"),
        (10_000, 10_001, "was not seen from 9."),
        (30_000, LIMIT_MS, "was not seen from 29."),
    ],
)
def test_what_is_not_seen_is_not_said_to_be_flown_as_looked_at(
    number: int, since_ms: int, until_ms: int, said: str
) -> None:
    rows = tampered(unseen(number, since_ms, until_ms))
    row = rows["flown as looked at"]
    assert (row["state"], row["checks"] > 50) == ("not observed", True)
    assert row["note"].startswith(f"aircraft {number} {said}")
    row = rows["permitted as offered"]
    assert row["state"] == "not observed"
    assert row["checks"] == 0 or row["note"].startswith(f"aircraft {number} {said}")


def test_an_aircraft_that_comes_and_vanishes_is_seen_while_it_is_there() -> None:
    (intruder,) = WHOLE.traffic
    seldom = replace(intruder, appears_ms=5_000, vanishes_ms=30_000)
    mission = replace(WHOLE, traffic=(seldom,))
    log = list(flown(WHOLE))
    for since_ms, until_ms in ((0, 5_000), (30_001, LIMIT_MS)):
        unseen(90, since_ms, until_ms)(log)
    assert judged(mission, log)["flown as looked at"]["state"] == "held"
    unseen(90, 20_000, LIMIT_MS)(log)
    row = judged(mission, log)["flown as looked at"]
    assert row["state"] == "not observed"
    assert row["note"].endswith("to 30.00 s")
