"""Bridge faults requested by a mission: what its connections do to lines, from a seed."""

from __future__ import annotations

from dataclasses import dataclass

LONGEST_DELAY_MS = 5000
"""Upper limit of the delay of a line [ms]."""


@dataclass(frozen=True)
class BridgeFaults:
    """The faults on every connection of the bridge, reproducible from the seed.

    Shares apply to the lines of either direction, each line independently: loss, repeat (duplicated), reorder (moved
    among the lines of its heartbeat), truncation (its end is missing, the newline included), corruption (one byte is
    changed). delay_ms: each line is delayed by up to this, uniformly distributed. forged_modes: share of the
    exchanges, two per heartbeat, at which UxAS receives a SETMOD with a random mode and an epoch from 0 to 5 that
    ICAROUS did not send. cut_ms, reconnect_ms: every connection breaks, and is reopened. stops_reading_ms,
    reads_again_ms: between these times ICAROUS reads nothing from its connection, which breaks when too much is
    queued. silent_ms, speaks_again_ms: between these times ICAROUS on board every vehicle is stopped: it reads and
    commands nothing; lines to it are queued.
    """

    seed: int = 0
    loss: float = 0.0
    repeat: float = 0.0
    reorder: float = 0.0
    truncation: float = 0.0
    corruption: float = 0.0
    delay_ms: int = 0
    forged_modes: float = 0.0
    cut_ms: int | None = None
    reconnect_ms: int | None = None
    stops_reading_ms: int | None = None
    reads_again_ms: int | None = None
    silent_ms: int | None = None
    speaks_again_ms: int | None = None

    def icarous_is_silent(self, now_ms: int) -> bool:
        """Whether ICAROUS is stopped at an instant [ms]."""
        return _within(self.silent_ms, self.speaks_again_ms, now_ms)

    def icarous_does_not_read(self, now_ms: int) -> bool:
        """Whether ICAROUS reads nothing from its connection at an instant [ms]."""
        return _within(self.stops_reading_ms, self.reads_again_ms, now_ms)

    def is_cut(self, now_ms: int) -> bool:
        """Whether all connections are down at an instant [ms]."""
        return _within(self.cut_ms, self.reconnect_ms, now_ms)


def _within(begin_ms: int | None, end_ms: int | None, now_ms: int) -> bool:
    return begin_ms is not None and begin_ms <= now_ms and (end_ms is None or now_ms < end_ms)


SHARES = ("loss", "repeat", "reorder", "truncation", "corruption", "forged_modes")
INSTANTS = {
    "cut_ms": "cut",
    "reconnect_ms": "opened anew",
    "stops_reading_ms": "ICAROUS stops reading",
    "reads_again_ms": "ICAROUS reads again",
    "silent_ms": "ICAROUS falls silent",
    "speaks_again_ms": "ICAROUS speaks again",
}


def words(faults: BridgeFaults) -> str:
    """The faults in words, for reports; those not requested are left out."""
    said = [
        f"{name.replace('_', ' ')} {getattr(faults, name):g}"
        for name in SHARES
        if getattr(faults, name)
    ]
    if faults.delay_ms:
        said.append(f"delay up to {faults.delay_ms / 1000:g} s")
    for name, text in INSTANTS.items():
        at_ms = getattr(faults, name)
        if at_ms is not None:
            said.append(f"{text} at {at_ms / 1000:g} s")
    return f"bridge faults are injected (seed {faults.seed}): {', '.join(said) or 'none'}"
