"""Merging: a fix that vehicles of a mission pass one after the other, at slots that they agree on."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple


class Silence(NamedTuple):
    """An interval [ms] in which a vehicle's direct link is down: it sends and receives nothing."""

    vehicle: int
    from_ms: int
    until_ms: int


@dataclass(frozen=True)
class DirectFaults:
    """Faults of the direct links, the same for the same seed. loss: share of the messages that are lost, 0 to 1."""

    seed: int = 0
    loss: float = 0.0
    silences: tuple[Silence, ...] = ()


@dataclass(frozen=True)
class Merging:
    """A fix at which vehicles merge.

    name, north_m, east_m: of the fix; vehicles: ids of those that merge there; separation_ms: least time between two
    that pass it. Distances from the fix: within coordination_m a vehicle requests a slot, within schedule_m it does
    not continue without one, within entry_m it no longer waits.
    """

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
