"""Coverage of a replay: calls of each step's kernels, and what was not checked."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from cratous.core.authority import cycle, gate, link_end
from cratous.core.kernel import qualified
from cratous.core.permit import hand

STEPS = {
    "the gate takes a command": (gate.gate_accepts, gate.gate_after),
    "the gate changes at ICAROUS's wish": (cycle.gate_wished, gate.gate_takeover, gate.gate_offer),
    "a heartbeat of ICAROUS": (cycle.cycle_begun, cycle.cycle_watched, cycle.cycle_flown),
    "a SETMOD line that may have come to the UxAS end": (
        link_end.link_mode,
        link_end.suspended_after,
    ),
    "a sign of life, or silence": (link_end.link_sign,),
    "a change of the certificate in hand": (hand.hand_step, hand.accepts, hand.hand_passed),
    "UxAS commands a track": (link_end.track_is_told,),
}
"""Each step of the model, with its kernels."""
NOT_COVERED = (
    "whether a conflict was foreseen or the way back free (either is allowed at each heartbeat)",
    "when ICAROUS heard UxAS (an offer is allowed also while nothing goes to it)",
    "what a certificate permits (its trajectory and tracks are not in the log), and whether one was offered at all",
    "SETMOD lines (not in the log: any may have come, also a forged one that is true)",
    "silence that is not reported once ICAROUS has flown (its other lines count as signs of life)",
    "notes on the link of lines that cannot be read",
    "whether UxAS commands at all (that a command of its own is missing is noticed only where it takes a vehicle back)",
    "what a command says: the path, the velocity or the circle",
    "reasons and intruders of changes of authority",
    "the executive: tasks, plans, order and timing (G1 and G3 judge them)",
    "motion of the aircraft (G1 and G2 judge it)",
)
"""What the model does not decide, in words."""


def steps(calls: Mapping[str, Any]) -> dict[str, dict[str, int]]:
    """Number of calls of each kernel of each step in a replay, by qualified name; 0 if never
    called.

    calls: counted during the replay, of `certify.evidence.Calls.data`.
    """
    called = calls["called"]
    return {
        step: {
            (name := qualified(kernel)): sum(called.get(name, {}).values()) for kernel in kernels
        }
        for step, kernels in STEPS.items()
    }


def lines(steps: Mapping[str, Mapping[str, int]]) -> list[str]:
    """The steps as text: their kernels with the number of calls, and those not called. steps: of `steps`."""
    found = []
    for step, kernels in steps.items():
        short = {name.rpartition(".")[2]: count for name, count in kernels.items()}
        if asked := [f"{name} {count} times" for name, count in short.items() if count]:
            found.append(f"covered: {step} ({', '.join(asked)})")
        if never := [name for name, count in short.items() if not count]:
            found.append(f"not exercised: {step} ({', '.join(never)})")
    return found


def rows(passed: Mapping[str, int]) -> list[str]:
    """What was not covered in this log. passed: number of unchecked messages by topic."""
    unread = [f"{count} {topic}: message not looked at" for topic, count in sorted(passed.items())]
    return [*NOT_COVERED, *unread]
