"""Alerts of a flight as its report tells them: from the first message of an alert to the last, the worst of each."""

from __future__ import annotations

from typing import Any

import pytest

from cratous.services.certify.alerts import TOPIC, AlertReader, none_said
from cratous.spec.errors import BadInput


def told(vehicle: int, *alerts: tuple[int, Any, Any]) -> dict[str, Any]:
    """Who is told of: (intruder, level, time to a violation [s])."""
    names = ("EntityList", "AlertLevelList", "TimeToViolationList")
    return {
        "EntityId": vehicle,
        **{name: [one[k] for one in alerts] for k, name in enumerate(names)},
    }


def test_an_alert_lasts_from_the_first_message_to_the_last_without_one_in_between() -> None:
    reader = AlertReader()
    for second, body in enumerate((
        told(1, (2, 1.0, 40.0)), told(1, (2, 2.0, 20.0), (3, 0.0, 50.0)), told(5, (1, 1.0, 30.0)),
        told(1, (2, 1.0, 35.0), (3, 1.0, 9.0)), told(1), told(1, (2, 1.0, 50.0)),
    )):  # fmt: skip
        reader.add(body, 1000 * second)
    assert [tuple(row.values()) for row in reader.found] == [
        (1, 2, 0, 3000, 2, 20.0),
        (5, 1, 2000, 2000, 1, 30.0),
        (1, 3, 3000, 3000, 1, 9.0),
        (1, 2, 5000, 5000, 1, 50.0),
    ]


@pytest.mark.parametrize(
    "wrong",
    [{"AlertLevelList": []}, {"AlertLevelList": ["NaN"]}, {"TimeToViolationList": ["Infinity"]}],
)
def test_what_cannot_be_told_is_a_typed_error(wrong: dict[str, Any]) -> None:
    with pytest.raises(BadInput, match="WellClearViolationIntervals at 7000 ms"):
        AlertReader().add({**told(1, (2, 1.0, 40.0)), **wrong}, 7000)


def test_nobody_alerted_and_nobody_asked_are_told_apart() -> None:
    def said(**by_topic: int) -> str:
        return none_said({"log": {"by_topic": by_topic}})

    assert said(**{TOPIC: 3}) == "None: 3 looks of detect and avoid are in the log."
    assert said(**{"cratous.Heartbeat": 3}).startswith("The log has no look of detect and avoid.")
