"""Blame and margins of user requirements in words. Imports nothing that judges."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

Data = dict[str, Any]


def margin(one: Data) -> str:
    """A margin in words."""
    unit = "" if one["unit"] == "1" else f" {one['unit']}"
    if one["least"] is None:
        return f"{one['of']}: never known"
    return (
        f"{one['of']}: least {one['least']:g}{unit} at {one['least_s']:g} s, "
        f"greatest {one['greatest']:g}{unit} at {one['greatest_s']:g} s"
    )


def lines(rows: Iterable[Data]) -> Iterator[str]:
    """The rows as text, one line each."""
    for one in rows:
        at = f"{one['at_s']:g} s" if "at_s" in one else f"sample {one['at']}"
        yield f"blame, {one['requirement']} at {at}: {sentence(one)}"


def sentence(one: Data) -> str:
    """The text of a row without its requirement and instant."""
    said = [" and ".join(one["facts"])]
    said += [_had(c, "") for c in one["command"]]
    said += [_had(c, " when it was known") for c in one["command_known"]]
    said += [f"vehicle {n} has no gate, which would tell who had it" for n in one["no_gate"]]
    if why := one.get("why_unknown"):
        said.append(f"who was in command is not told: {why}")
    elif (first := one["broken_first"]) is not None:
        said.append(f"first broken assumption: {first['name']} at {_s(first['since_ms'])}")
    else:
        said.append("no watched assumption had broken by then")
    if one["not_observed"]:
        said.append(f"not observed: {', '.join(one['not_observed'])}")
    return "; ".join(said)


def _had(command: Data, when: str) -> str:
    side, vehicle = command["side"], command["vehicle"]
    return f"{side} had vehicle {vehicle}{when}, since {_s(command['since_ms'])}"


def _s(time_ms: int) -> str:
    return f"{time_ms / 1000:.2f} s"
