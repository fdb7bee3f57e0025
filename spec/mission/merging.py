"""Where vehicles of a mission merge: a fix that they pass one after the other, at slots that they agree upon."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple


class Silence(NamedTuple):
    """The direct link of a vehicle is gone from the one to the other [ms]: it says and hears nothing."""

    vehicle: int
    from_ms: int
    until_ms: int


@dataclass(frozen=True)
class DirectFaults:
    """What fails on the direct links, the same for the same seed. loss: share of the messages that do not come."""

    seed: int = 0
    loss: float = 0.0
    silences: tuple[Silence, ...] = ()


@dataclass(frozen=True)
class Merging:
    """name, north_m, east_m: of the fix; vehicles: those that merge there; separation_ms: between two that pass it;
    coordination_m: nearer than this they ask for a slot; schedule_m: nearer than this nobody flies on without one; entry_m:
    nearer than this nobody waits any more."""

    name: str = ""
    north_m: float = 0.0
    east_m: float = 0.0
    vehicles: tuple[int, ...] = ()
    separation_ms: int = 0
    coordination_m: float = 0.0
    schedule_m: float = 0.0
    entry_m: float = 0.0
    faults: DirectFaults = field(default_factory=DirectFaults)


def words(merging: Merging) -> str:
    """The section in words, for reports."""
    who = ", ".join(map(str, merging.vehicles))
    text = f"vehicles {who} pass {merging.name} at least {merging.separation_ms / 1000:g} s apart"
    faults = merging.faults
    said = [f"{faults.loss:g} of the messages are lost"] if faults.loss else []
    said += [
        f"vehicle {one.vehicle} is silent from {one.from_ms / 1000:g} to {one.until_ms / 1000:g} s"
        for one in faults.silences
    ]
    return f"{text}; on the direct links {', '.join(said)}" if said else text
