"""A packet is accepted exactly when its number is none that may have been accepted and within the window; once
accepted, it is never accepted again, whatever came since."""

from cratous.core.authority.replay import mark_after, packet_is_new
from cratous.proofs.claim import Claim
from cratous.spec.authority import replay


def claim(c: Claim) -> None:
    mark, sequence, window, t = (c.integer(name) for name in ("mark", "sequence", "window", "t"))
    c.premise(mark >= 0)
    c.premise(window >= 0)
    new = c.use(packet_is_new, mark, sequence, window)
    at_any = c.define(replay.is_new, t, mark, sequence, window)
    c.show(c.implies(new, at_any), "what is accepted was not accepted before")
    witness = c.define(replay.is_new, sequence, mark, sequence, window)
    c.show(
        c.implies(c.negation(new), c.negation(witness)), "else it may have been, or is far ahead"
    )
    other = c.define(replay.is_new, t, mark, sequence, window)
    near = c.all_of(sequence >= 1, sequence <= mark + window)
    c.show(c.implies(c.all_of(near, t != sequence), other), "no other packet stands in its way")
    after = c.use(mark_after, mark, sequence, window)
    c.show(c.define(replay.is_mark_after, t, after, mark, sequence, new), "the mark covers it")
    c.show(after >= mark, "the mark never goes back")
    later = c.integer("later")
    c.premise(later >= after)
    again = c.use(packet_is_new, later, sequence, window)
    c.show(c.implies(new, c.negation(again)), "and it is never accepted again")
