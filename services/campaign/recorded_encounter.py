"""An encounter from a file of states (`.daa`, `.xyz`): each aircraft starts as in its first step
and flies straight on.

The ownship is a protected vehicle in level flight on its course; the others are traffic and keep
their velocity, including climb. Later states, wind and parameters of the file are not used.
"""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

from cratous.services.campaign.generators import FRAME, Point, vehicle_at
from cratous.services.daa import aircraft
from cratous.spec.daa.encounter_files import read
from cratous.spec.errors import BadInput

ENDINGS = (".daa", ".xyz")
FIRST_TRAFFIC = 101
FARTHER = 1.5
"""Distance of the vehicle's target point, as a multiple of the distance flown in the time."""


def mission_of_states(file: Path, duration_s: float) -> dict[str, Any]:
    """The mission file of an encounter, as data; BadInput if the file is invalid, or has no traffic
    in its first step.
    """
    encounters = read(file)
    rows = encounters.steps[0][1]
    (own, *others), wind = aircraft(rows)
    if not others:
        raise BadInput(
            "no intruder in the first step", where=str(file), expected="an ownship and others",
            got=own.id,
        )  # fmt: skip
    north, east = own.vn_m_s + wind[1], own.ve_m_s + wind[0]
    speed, course_deg = math.hypot(north, east), math.degrees(math.atan2(east, north))
    start: Point = (own.north_m, own.east_m, own.alt_m)
    far = FARTHER * duration_s
    point = {"north_m": start[0] + far * north, "east_m": start[1] + far * east, "alt_m": start[2]}
    return {
        "name": re.sub(r"[^A-Za-z0-9_-]", "-", file.stem).lstrip("-_")[:64] or "encounter",
        "description": f"the first step of {file.name}, flown on",
        "frame": dict(FRAME),
        "vehicles": [vehicle_at(1, start, course_deg, speed)],
        "tasks": [{"id": 1, "kind": "must_fly", "eligible": [1], "points": [point]}],
        "traffic": [
            {
                "id": FIRST_TRAFFIC + k,
                "position": {"north_m": o.north_m, "east_m": o.east_m, "alt_m": o.alt_m},
                "velocity": {
                    "north_m_s": o.vn_m_s + wind[1],
                    "east_m_s": o.ve_m_s + wind[0],
                    "down_m_s": -o.vu_m_s,
                },
            }
            for k, o in enumerate(others)
        ],
    }
