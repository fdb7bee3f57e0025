"""Random missions of two or three vehicles with changes in flight: vehicles that are lost or join,
zones on tasks and routes, wind, late and withdrawn tasks, at the same time or apart.
"""

from __future__ import annotations

from math import cos, pi, sin
from random import Random
from typing import Any

ALTITUDES_M = (300.0, 500.0, 700.0)
"""One altitude layer per vehicle, so that encounters are rare."""
KINDS = ("must_fly",) * 4 + ("point_search",) * 2 + ("line_search",) * 3 + ("area_search",)
SQUARE = ((0, 0), (0, 500), (500, 500), (500, 0))


def changing_mission(name: str, seed: int, most_changes: int) -> dict[str, Any]:
    """The mission file of a seed as data, with between one and the given number of changes."""
    random = Random(f"{seed} changes")
    vehicles = [_vehicle(number, random) for number in range(1, random.randrange(2, 4) + 1)]
    ids = [v["id"] for v in vehicles]
    tasks = [_task(number, ids, random) for number in range(1, random.randrange(3, 7) + 1)]
    changes: list[dict[str, Any]] = []
    wanted = random.randrange(1, most_changes + 1)
    while len(changes) < wanted:
        _change(changes, ids, tasks, random)
    late = {c["task_added"] for c in changes if "task_added" in c}
    if late >= {t["id"] for t in tasks}:  # a mission must begin with a task
        changes = [c for c in changes if c.get("task_added") != tasks[0]["id"]]
    return {
        "name": f"{name}-{seed}",
        "description": f"{len(changes)} changes, made by a campaign with seed {seed}",
        "frame": {"latitude_deg": 45.3, "longitude_deg": -121.0, "terrain_m": 0},
        "vehicles": vehicles,
        "tasks": tasks,
        "relations": _relations([t["id"] for t in tasks], random),
        "simulation": {"limit_s": 1500},
        "changes": changes,
    }


def _vehicle(number: int, random: Random) -> dict[str, Any]:
    return {
        "id": number,
        "position": {
            "north_m": random.randrange(-300, 300), "east_m": 2500 * (number - 1),
            "alt_m": ALTITUDES_M[number - 1],
        },
        "heading_deg": random.choice((0, 20, 340)), "speed_m_s": 25,
        "min_speed_m_s": random.choice((12, 18)), "max_speed_m_s": random.choice((35, 45)),
        "max_bank_deg": 35, "max_climb_m_s": 5, "cameras": [{"payload_id": 1, "hfov_deg": 60}],
    }  # fmt: skip


def _task(number: int, vehicles: list[int], random: Random) -> dict[str, Any]:
    kind = random.choice(KINDS)
    north, east = random.randrange(900, 3500), random.randrange(-800, 4500)
    points: list[dict[str, float]] = [{"north_m": north, "east_m": east}]
    if kind == "line_search":
        turn = random.uniform(0, 2 * pi)
        points.append({"north_m": north + 700 * cos(turn), "east_m": east + 700 * sin(turn)})
    elif kind == "area_search":
        points = [{"north_m": north + a, "east_m": east + b} for a, b in SQUARE]
    task: dict[str, Any] = {"id": number, "kind": kind, "points": points}
    if random.random() < 0.35:
        task["eligible"] = [random.choice(vehicles)]
    if random.random() < 0.3:
        task["priority"] = random.randrange(1, 4)
    return task


def _change(
    changes: list[dict[str, Any]], vehicles: list[int], tasks: list[dict[str, Any]], random: Random
) -> None:
    """Append one more change, sometimes at the same time as the last one."""
    at = random.choice((0, 5, 20, 40, 70, 110, 160))
    if changes and random.random() < 0.3:
        at = changes[-1]["at_s"]
    kind = random.choice(("lost", "lost", "joins", "zone", "zone", "wind", "added", "removed"))
    entry: dict[str, Any] = {"at_s": at}
    if kind == "lost":
        entry["vehicle_lost"] = random.choice(vehicles)
    elif kind == "joins":
        number = random.choice(vehicles)
        there = set(vehicles) - {c.get("vehicle_joins") for c in changes}
        if there <= {number}:
            return
        entry["vehicle_joins"] = number
    elif kind == "zone":
        place = random.choice(tasks)["points"][0]
        middle = place["north_m"] - random.choice((0, 0, 500)), place["east_m"]
        size = random.randrange(100, 500)
        corners = [(1, 1), (1, -1), (-1, -1), (-1, 1)]
        entry["zone"] = {
            "id": 100 + len(changes), "kind": "keep_out",
            "vertices": [[middle[0] + size * a, middle[1] + size * b] for a, b in corners],
        }  # fmt: skip
    elif kind == "wind":
        entry["wind"] = {"north_m_s": random.randrange(-14, 15), "east_m_s": random.choice((0, 6))}
    elif kind == "added":
        entry["task_added"] = random.choice(tasks)["id"]
    else:
        entry["task_removed"] = random.choice(tasks)["id"]
    changes.append(entry)


def _relations(ids: list[int], random: Random) -> str:
    """Relations of all tasks, sometimes with a time window; sometimes empty."""
    if random.random() < 0.15:
        return ""
    rest = list(ids)
    random.shuffle(rest)
    parts = []
    while rest:
        count = min(len(rest), random.randrange(1, 4))
        mine, rest = rest[:count], rest[count:]
        atoms = " ".join(f"p{t}" for t in mine)
        part = atoms if count == 1 else f"{random.choice('..~|+')}({atoms})"
        if random.random() < 0.35:
            low = random.choice((0, 0, 20_000))
            kind = "_" if random.random() < 0.7 else "-"
            part += f"{kind}[{low}-{low + random.randrange(40_000, 260_000)}]"
        parts.append(part)
    return f"|({' '.join(parts)})"
