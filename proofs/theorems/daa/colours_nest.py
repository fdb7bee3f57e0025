"""Colours nest: if every threshold of the more severe region is at most that of the milder one, and its
span of time lies within the other's, then what conflicts with the severe region conflicts with the
milder one: no value is free in MID and not in NEAR."""

from cratous.core.daa.volume import conflict_span, in_conflict
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_nested_thresholds, any_state, by_name
from cratous.proofs.theorems.daa.conflict_has_an_instant import witnesses
from cratous.spec import well_clear


def claim(c: Claim) -> None:
    s, v, sz, vz = any_state(c)
    severe, mild = any_nested_thresholds(c)
    begin, end, begin2, end2 = c.reals("begin end begin2 end2")
    c.premise(begin2 <= begin)
    c.premise(end <= end2)
    c.opaque(in_conflict, conflict_span, well_clear.violation_taumod_at)
    kind = 0
    state = {"s": s, "v": v, "sz": sz, "vz": vz}
    limits, greater = by_name(severe), by_name(mild)
    red = c.use(in_conflict, kind, s, v, sz, vz, severe, begin, end)
    first, _ = c.use(conflict_span, kind, s, v, sz, vz, severe, begin, end)
    some = witnesses(c, "", (s, v, sz, vz), severe, begin, end)
    c.lemma(
        "daa_conflict_has_an_instant", kind=kind, begin=begin, end=end, **some, **state, **limits
    )
    both = {f"{name}2": value for name, value in greater.items()}
    c.lemma("daa_violation_at_an_instant_is_monotone", t=first, **state, **limits, **both)
    c.lemma(
        "daa_conflict_misses_no_instant",
        when=red, kind=kind, t=first, begin=begin2, end=end2, **state, **greater,
    )  # fmt: skip
    c.show(c.implies(red, c.use(in_conflict, kind, s, v, sz, vz, mild, begin2, end2)))
