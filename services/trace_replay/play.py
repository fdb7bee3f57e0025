"""Replays a trace on the real actors, until they deviate from it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from cratous.services.trace_replay.actors import Actors
from cratous.services.trace_replay.files import Trace
from cratous.services.trace_replay.holder import Holder
from cratous.services.trace_replay.impossible_delivery import NeverSent
from cratous.spec.system import hand_trace
from cratous.spec.system.trace import NOTHING, Entry, Standing

NAMES = ("UxAS", "ICAROUS")
MODES = ("watching", "avoiding", "offering control")


class Played(NamedTuple):
    """followed: number of entries that matched the trace; why: how the next one differed, empty at the end."""

    followed: int
    why: str


def play_trace(told: Trace) -> Played:
    """Replay a trace of either kind from the start of a flight."""
    if told.of_hand:
        return play_hand([one for one in told.entries if isinstance(one, hand_trace.Entry)])
    return play([one for one in told.entries if isinstance(one, Entry)])


def play(entries: Sequence[Entry]) -> Played:
    """Replay a trace of authority from the start of a flight."""
    with Actors() as actors:
        for number, entry in enumerate(entries):
            try:
                stands = actors.happen(entry.event)
            except NeverSent as error:
                return Played(number, str(error))
            if why := differs(entry.after, stands):
                return Played(number, why)
    return Played(len(entries), "")


def play_hand(entries: Sequence[hand_trace.Entry]) -> Played:
    """Replay a trace of the certificate in hand from the start of a flight."""
    holder = Holder()
    for number, entry in enumerate(entries):
        try:
            stands = holder.happen(entry.event)
        except NeverSent as error:
            return Played(number, str(error))
        if stands != entry.after:
            return Played(number, f"{_holds(stands)}, in the trace {_holds(entry.after)}")
    return Played(len(entries), "")


def _holds(stands: hand_trace.InHand) -> str:
    if stands.until <= stands.now:
        return f"nothing is certain at heartbeat {stands.now}"
    return f"what is in hand at heartbeat {stands.now} is certain until {stands.until}"


def differs(told: Standing, flown: Standing) -> str:
    """Differences between trace and flight, in words; empty if none."""
    rows = [
        ("the gate", _gate(told), _gate(flown)),
        ("ICAROUS is", _of(MODES, told.mode), _of(MODES, flown.mode)),
        ("UxAS believes that", _belief(told), _belief(flown)),
        ("UxAS's flying is", _flies(told.suspended), _flies(flown.suspended)),
        ("the command is", _acts(told.accepted), _acts(flown.accepted)),
        ("UxAS sends", _sends(told.sent), _sends(flown.sent)),
    ]
    return "; ".join(f"{what} {b}, in the trace {a}" for what, a, b in rows if a != b)


def _gate(stands: Standing) -> str:
    offers = ", offers control" if stands.offered else ""
    return f"is {_of(NAMES, stands.owner)}'s{offers} in epoch {stands.epoch}"


def _belief(stands: Standing) -> str:
    return f"{NAMES[stands.active]} commands since epoch {stands.heard}"


def _flies(suspended: bool) -> str:
    return "suspended" if suspended else "not suspended"


def _acts(accepted: bool) -> str:
    return "flown" if accepted else "not flown"


def _sends(epoch: int) -> str:
    return {NOTHING: "no command"}.get(epoch, f"a command of epoch {epoch}")


def _of(names: Sequence[str], code: int) -> str:
    return dict(enumerate(names)).get(code, f"unknown code {code}")
