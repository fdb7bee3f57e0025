"""The end of a request for the services of the pipeline, and how many requests they keep."""

from __future__ import annotations

from typing import Any, TypeVar

from cratous.spec.files.limits import integer_of

RESPONSE = "uxas.messages.task.UniqueAutomationResponse"
STATUS = "afrl.cmasi.ServiceStatus"
ENDINGS = (RESPONSE, STATUS)
AT_ONCE = 16
"""Requests kept at the same time: one is in the pipeline, older ones have been given up."""

V = TypeVar("V")


def request_ended(topic: str, body: Any) -> int:
    """The RequestID that a response or an error ends, 0 for none."""
    if topic == RESPONSE:
        return int(body.ResponseID)
    if topic != STATUS or body.StatusType.name != "Error":
        return 0
    number = next((pair.Value for pair in body.Info if pair.Key == "RequestID"), "")
    return integer_of(number, -(2**63), 2**63 - 1) or 0


def newest(kept: dict[int, V]) -> dict[int, V]:
    """The newest entries, by insertion order."""
    return dict(list(kept.items())[-AT_ONCE:])
