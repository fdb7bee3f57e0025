"""How a flight ended."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class FlightResult:
    """How a flight ended. outcome: "complete", "failed" or "limit"; times in ms."""

    outcome: str
    end_ms: int
    starts: dict[int, int]
    ends: dict[int, int]
    failed: dict[int, str]
    takeovers: int
    replans: int
    steps: int
