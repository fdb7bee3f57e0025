"""The modes of each vehicle's decision logic over time, read from `CognitionState` messages.

Each message is put through the kernel `decide` again, with the mode before it and the conditions that it tells; not
while a flight is read (`note`), since whoever watches one would add to the calls that it counts.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from cratous.bridge import lmcp
from cratous.core.authority.cognition import Conditions, decide, mode_avoids, mode_lets_go
from cratous.spec.authority.cognition import NOMINAL

WAYS = {
    "NoResolution": "",
    "Turn": "by a turn",
    "Altitude": "by a change of altitude",
    "Speed": "by a change of speed",
    "Combined": "by several of these",
    "LeastBad": "none is free of conflict: the least bad",
}
WORDS = {
    "landed": "on the ground after its flight",
    "descends": "in the final descent",
    "departs": "the take-off is not over",
    "traffic": "traffic forbids what would be flown",
    "fence": "a zone forbids what would be flown",
    "lands": "on the way to a landing site",
    "failed": "a failure is declared",
    "alone": "by itself",
    "merges": "at a merge fix",
    "has": "ICAROUS has the vehicle",
    "skips": "waypoints are left out",
    "deviates": "off the plan",
}
OTHERWISE = "not the mode that the kernel makes of this"


def note(modes: list[dict[str, Any]], body: dict[str, Any]) -> None:
    """Add what a `CognitionState` says to the modes so far."""
    vehicle, name = int(body["VehicleID"]), str(body["Mode"])
    mode = _numbers()[name]
    before = next((one["code"] for one in reversed(modes) if one["vehicle"] == vehicle), NOMINAL)
    seen = Conditions(*(bool(body[name.capitalize()]) for name in Conditions._fields))
    modes.append(
        {
            "vehicle": vehicle,
            "from_ms": int(body["Time"]),
            "code": mode,
            "before": before,
            "seen": seen,
            "skipped": body["Skipped"],
            "mode": "".join(f" {c.lower()}" if c.isupper() else c for c in name).strip(),
            "way": WAYS[str(body["Resolution"])],
            "intruder": int(body["IntruderID"]),
        }
    )


def spans(modes: list[dict[str, Any]], end_ms: int) -> list[dict[str, Any]]:
    """The modes with their ends, by vehicle and time; a mode whose conditions change is several."""
    found = []
    for k, one in enumerate(modes):
        later = (m["from_ms"] for m in modes[k + 1 :] if m["vehicle"] == one["vehicle"])
        code, group = one["code"], "other"
        if mode_avoids(code):
            group = "avoids"
        elif mode_lets_go(code):
            group = "back"
        elif code == NOMINAL:
            group = "nominal"
        found.append(
            {
                "vehicle": one["vehicle"],
                "mode": one["mode"],
                "way": one["way"],
                "intruder": one["intruder"],
                "why": _why(one),
                "group": group,
                "from_ms": one["from_ms"],
                "to_ms": next(later, max(end_ms, one["from_ms"])),
            }
        )
    return sorted(found, key=lambda one: (one["vehicle"], one["from_ms"]))


def _why(one: dict[str, Any]) -> str:
    """The conditions that a message told, in words, and whether they make its mode."""
    why = [text for name, text in WORDS.items() if getattr(one["seen"], name)]
    if one["skipped"]:
        why = [f"{one['skipped']} {text}" if text == WORDS["skips"] else text for text in why]
    if decide(one["before"], one["seen"]) != one["code"]:
        why.append(OTHERWISE)
    return "; ".join(why)


@cache
def _numbers() -> dict[str, int]:
    """The numbers of the modes, by name."""
    mode: Any = lmcp.new("CognitionState").Mode
    return {one.name: int(one) for one in type(mode)}
