"""A packet is accepted exactly when its number is none that may have been accepted and within the window of 64: what
was overtaken within the window is accepted, what is older is refused, and what was accepted is never accepted again."""

from cratous.core.authority.replay_window import (
    packet_is_fresh,
    window_last_after,
    window_mark_after,
)
from cratous.proofs.claim import Claim
from cratous.spec.authority import replay_window


def claim(c: Claim) -> None:
    mark, last, sequence, ahead, t = (
        c.integer(name) for name in ("mark", "last", "sequence", "ahead", "t")
    )
    c.premise(last >= 0)
    c.premise(mark >= last)
    c.premise(ahead >= 0)
    fresh = c.use(packet_is_fresh, mark, last, sequence, ahead)
    at_any = c.define(replay_window.is_fresh, t, mark, last, sequence, ahead)
    c.show(c.implies(fresh, at_any), "what is accepted was not accepted before, and is within")
    witness = c.define(replay_window.is_fresh, sequence, mark, last, sequence, ahead)
    c.show(
        c.implies(c.negation(fresh), c.negation(witness)), "else it may have been, or is outside"
    )
    c.show(c.implies(mark - sequence >= 64, c.negation(fresh)), "older than the window: refused")
    turns = c.integer("turns")
    kept = c.any_of(last == 0, last == sequence + 64 * turns)
    near = c.define(replay_window.is_within, mark, sequence, ahead)
    c.show(
        c.implies(c.all_of(kept, near, sequence != last), fresh),
        "within the window and not accepted yet: accepted, whatever has overtaken it",
    )
    mark_after = c.use(window_mark_after, mark, last, sequence, ahead)
    last_after = c.use(window_last_after, mark, last, sequence, ahead)
    c.show(c.define(replay_window.is_kept_after, t, mark_after, mark, sequence, fresh), "the mark")
    c.show(c.define(replay_window.is_kept_after, t, last_after, last, sequence, fresh), "its last")
    c.show(c.all_of(last_after >= last, mark_after >= mark), "neither goes back")
    c.show(c.all_of(last_after >= 0, last_after <= mark_after), "and last is not above the mark")
    later_mark, later_last = c.integer("later_mark"), c.integer("later_last")
    c.premise(later_last >= last_after)
    c.premise(later_mark >= mark_after)
    again = c.use(packet_is_fresh, later_mark, later_last, sequence, ahead)
    c.show(c.implies(fresh, c.negation(again)), "what was accepted is never accepted again")
