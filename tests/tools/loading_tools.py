"""A small mission as data."""

from __future__ import annotations


def small() -> dict:
    """A small mission that is right, to be made wrong."""
    return {
        "name": "small",
        "frame": {"latitude_deg": 45.0, "longitude_deg": -120.0},
        "vehicles": [
            {
                "id": 1,
                "position": {"north_m": 0, "east_m": 0, "alt_m": 300},
                "heading_deg": 90,
                "speed_m_s": 20,
                "min_speed_m_s": 15,
                "max_speed_m_s": 30,
            },
            {
                "id": 2,
                "position": {"latitude_deg": 45.01, "longitude_deg": -120.0, "alt_m": 300},
                "heading_deg": 0,
                "speed_m_s": 20,
            },
        ],
        "tasks": [
            {"id": 1, "kind": "must_fly", "points": [{"north_m": 0, "east_m": 900, "alt_m": 300}]},
            {
                "id": 2,
                "kind": "line_search",
                "points": [{"north_m": 0, "east_m": 0}, {"north_m": 900, "east_m": 0}],
                "eligible": [2],
            },
        ],
        "relations": "|(p1 p2)",
    }
