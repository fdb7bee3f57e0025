"""A stand-in for a flight, which campaigns fly in processes of their own: it does what its mission says."""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import Any

FUNCTION = "campaign_child:fly"
ONCE = "once"
"""A word in a mission: what follows happens at the first attempt alone."""


def fly(task: dict[str, Any]) -> dict[str, Any]:
    """The result of a run; its mission's description is what to do, its speed decides the margin."""
    import yaml

    data = yaml.safe_load(task["mission"])
    _do(str(data.get("description", "")))
    speed = float(data["vehicles"][0]["speed_m_s"])
    margin = round(60 - 2 * speed if task["daa"] else -speed, 6)
    return flown({"G2": margin})


def _do(what: str) -> None:
    first, _, mark = what.partition(" ")
    if mark.startswith("/"):
        try:
            with open(mark, "x") as file:
                file.write(f"{os.getppid()}\n")
        except FileExistsError:
            return  # it has happened
    if first == "die":
        os.kill(os.getpid(), 9)
    elif first == "hang":
        time.sleep(1000)
    elif first == "eat":
        kept = []
        while True:
            kept.append(bytearray(50_000_000))
    elif first == "sleep":
        time.sleep(0.5)


def flown(margins: dict[str, float], **more: Any) -> dict[str, Any]:
    """A result as a flight gives it: requirements with a margin below 0 are violated, others hold."""
    found = {}
    for name in ("G1", "G2", "G3", "G4", "G5"):
        margin = margins.get(name)
        verdict = "holds" if margin is None or margin >= 0 else "violated"
        found[name] = {
            "verdict": verdict, "margin": margin, "unit": "m" if margin is not None else "",
            "time_ms": None, "item": "well clear of 1 and 2",
        }  # fmt: skip
    judge = {
        "verdict": "holds", "guarantees": {n: r["verdict"] for n, r in found.items()},
        "disagreements": [], "differences": 0, "rows": 9,
    }  # fmt: skip
    return {
        "kind": "flown", "proved": True, "requirements": found, "takeovers": 1, "outcome": "complete",
        "end_ms": 1000, "separation_m": None, "log": "f" * 64, "mission_hash": "e" * 64, "drawn": {},
        "judge": judge, **more,
    }  # fmt: skip


MISSION = """
name: {name}
description: "{what}"
frame: {{latitude_deg: 45, longitude_deg: -120}}
vehicles:
  - {{id: 1, position: {{north_m: 0, east_m: 0, alt_m: 300}}, heading_deg: 0, speed_m_s: 20,
     min_speed_m_s: 1, max_speed_m_s: 100}}
tasks:
  - {{id: 1, kind: must_fly, points: [{{north_m: 2000, east_m: 0, alt_m: 300}}]}}
"""


def written(folder: Path, missions: dict[str, str], rest: str) -> Path:
    """A campaign file of missions that do what they say."""
    for name, what in missions.items():
        (folder / f"{name}.yaml").write_text(MISSION.format(name=name, what=what))
    files = "".join(f"  - {name}.yaml\n" for name in missions)
    file = folder / "campaign.yaml"
    file.write_text(f"name: trial\nmissions:\n{files}{rest}")
    return file
