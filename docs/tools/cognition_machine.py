"""The decision logic of a vehicle's ICAROUS as a state machine, drawn from the kernels that decide.

    python docs/tools/cognition_machine.py

prints the diagram for docs/guides/detect-and-avoid.md. `decide` is evaluated for each mode and each combination of its
conditions. Modes that go to the same modes under all conditions are left through one choice; an arrow to a mode bears the
fewest conditions that lead to it, and its rank: of several that hold the first counts. The groups are those that
`mode_takes`, `mode_lets_go` and `mode_avoids` make of the modes, and inside a conflict stand the ways in which `resolution`
says that it is avoided. The names are those of the specification: `CRATOUS/CognitionMode` and
`CRATOUS/ConflictResolution` of spec/lmcp.
"""

from __future__ import annotations

from itertools import product
from typing import Any

from cratous.bridge import lmcp
from cratous.core.authority.cognition import (
    Conditions,
    decide,
    mode_avoids,
    mode_lets_go,
    mode_takes,
    resolution,
)
from cratous.spec.authority.cognition import NOMINAL, NONE

EITHER = (False, True)
GROUPS = {
    (False, False, False): ("Uxas", "UxAS flies, ICAROUS monitors"),
    (True, True, False): ("Back", "ICAROUS flies, the way back is permitted"),
    (True, False, False): ("Course", "ICAROUS flies a course of its own"),
    (True, False, True): ("Avoiding", "ICAROUS avoids a conflict"),
}
"""By what three kernels say of a mode: whether ICAROUS takes the vehicle, lets it go, avoids."""
WORDS = {
    "landed": "on the ground",
    "descends": "in the final descent",
    "departs": "the take-off is not over",
    "traffic": "traffic forbids what would be flown",
    "fence": "a zone forbids what would be flown",
    "lands": "to a landing site",
    "failed": "a failure is declared",
    "alone": "by itself",
    "merges": "at a merge fix",
    "has": "ICAROUS has the vehicle",
    "skips": "waypoints are left out",
    "deviates": "off the plan",
}


def names(field: str) -> dict[int, str]:
    """The names of the modes (`Mode`) or of the ways to avoid a conflict (`Resolution`), by number."""
    value: Any = getattr(lmcp.new("CognitionState"), field)
    return {int(one): one.name for one in type(value)}


def leads_to(mode: int) -> dict[tuple[bool, ...], int]:
    """The mode after a mode, by the conditions."""
    asked = product(EITHER, repeat=len(Conditions._fields))
    return {seen: decide(mode, Conditions(*seen)) for seen in asked}


def alike() -> list[list[int]]:
    """The modes, those together that go to the same modes under all conditions."""
    found: dict[tuple[int, ...], list[int]] = {}
    for mode in names("Mode"):
        found.setdefault(tuple(leads_to(mode).values()), []).append(mode)
    return list(found.values())


def reasons(mode: int) -> dict[int, list[tuple[str, ...]]]:
    """The least sets of conditions that lead from a mode to each mode."""
    to: dict[int, list[set[str]]] = {}
    for seen, after in sorted(leads_to(mode).items(), key=lambda one: sum(one[0])):
        true = {name for name, holds in zip(Conditions._fields, seen, strict=True) if holds}
        least = to.setdefault(after, [])
        if not any(one <= true for one in least):
            least.append(true)
    order = Conditions._fields.index
    return {after: [tuple(sorted(one, key=order)) for one in least] for after, least in to.items()}


def block() -> str:
    """The diagram, as Mermaid text."""
    modes, lines = names("Mode"), ["stateDiagram-v2", "  state heartbeat <<choice>>"]
    (together,) = (one for one in alike() if NOMINAL in one)
    lines += [line for group in GROUPS for line in _group(group, together)]
    lines.append("  [*] --> heartbeat: starts")
    lines += [f"  {group} --> heartbeat: each heartbeat" for group, _ in GROUPS.values()]
    to = reasons(NOMINAL)
    for rank, after in enumerate(sorted(to, reverse=True), 1):
        lines.append(f"  heartbeat --> {modes[after]}: {rank}. {_why(to[after])}")
    for mode in (one for one in modes if one not in together):
        to = reasons(mode)
        for after in (one for one in to if one != mode):
            lines.append(f"  {modes[mode]} --> {modes[after]}: {_why(to[after])}")
    return "\n".join(("```mermaid", *lines, "```"))


def _group(said: tuple[bool, bool, bool], together: list[int]) -> list[str]:
    """The modes of a group, of those that are left through one choice."""
    modes, (group, text) = names("Mode"), GROUPS[said]
    lines = [f'  state "{text}" as {group} {{']
    for mode in together:
        if (mode_takes(mode), mode_lets_go(mode), mode_avoids(mode)) == said:
            lines += _state(mode, modes[mode])
    return [*lines, "  }"]


def _state(mode: int, name: str) -> list[str]:
    """A mode; with the ways in which it avoids a conflict, if it does."""
    flown = {resolution(mode, *seen) for seen in product(EITHER, repeat=4)} - {NONE}
    if not flown:
        return [f"    {name}"]
    ways = names("Resolution")
    inside = (f'      state "{ways[way]}" as {name}{ways[way]}' for way in sorted(flown))
    return [f"    state {name} {{", *inside, "    }"]


def _why(least: list[tuple[str, ...]]) -> str:
    """The least sets of conditions, in words."""
    return " / ".join(", ".join(WORDS[name] for name in one) or "none of these" for one in least)


if __name__ == "__main__":
    print(block())
