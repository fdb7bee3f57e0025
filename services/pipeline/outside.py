"""Settings for vehicles that are controlled by messages only."""

from __future__ import annotations

from typing import NamedTuple


class Outside(NamedTuple):
    """How plans are sent to vehicles that are controlled by messages only, so that autopilot and payloads can
    follow.

    separation_m: configured least distance of waypoints [m], raised to a vehicle's turn radius if that is
    larger; 0: all points are sent.
    """

    separation_m: float = 50.0
