"""Where a moving zone of a report is at some instants of the flight, for the map."""

from __future__ import annotations

from typing import Any

SHOWN = 4
"""Positions of a moving zone on a map."""


def positions(regions: list[dict[str, Any]], end_ms: int) -> list[tuple[dict[str, Any], Any]]:
    """The zones that these regions hold, each at SHOWN instants while it is in force, with the instants [s].

    end_ms: of the flight.
    """
    found = []
    for zone in {region["id"]: region for region in regions}.values():
        moving = zone["moving"]
        until_ms = end_ms if moving["until_ms"] is None else min(end_ms, moving["until_ms"])
        in_force = range(moving["from_ms"], until_ms + 1)  # empty: from after the end of the flight
        for k in range(SHOWN) if in_force else ():
            gone_s = (until_ms - moving["from_ms"]) * k / (SHOWN - 1) / 1000
            north, east = (gone_s * v for v in moving["velocity_m_s"])
            vertices = [(n + north, e + east) for n, e in moving["vertices"]]
            at_s = round(moving["from_ms"] / 1000 + gone_s, 1)
            found.append(({**zone, "vertices": vertices, "at_s": at_s}, at_s))
    return found
