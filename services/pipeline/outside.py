"""How plans go out to vehicles that fly by messages alone."""

from __future__ import annotations

from typing import NamedTuple


class Outside(NamedTuple):
    """For vehicles that fly by messages alone: what is done so that an autopilot and its payloads can.

    separation_m: least distance of waypoints, as the configuration says [m], which a vehicle's turn radius may
    exceed; 0: all are sent.
    """

    separation_m: float = 50.0
