"""The result of a flight."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class FlightResult:
    """The result of a flight. outcome: "complete", "failed" or "limit"; times in ms."""

    outcome: str
    end_ms: int
    starts: dict[int, int]
    ends: dict[int, int]
    failed: dict[int, str]
    takeovers: int
    replans: int
    steps: int
