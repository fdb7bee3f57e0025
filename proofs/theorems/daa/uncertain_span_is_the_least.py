"""The span for uncertain states is the least that holds the volume's own and every instant of [B, T] that
the spans of altitude and circle share; and a conflict is found exactly if the volume itself is violated,
or nothing is known exactly and that span holds an instant: where nothing is, exactly if there is an
instant of the volume's own or one that the spans of altitude and circle share."""

from cratous.core.daa.uncertainty import circle_span, layer_span, uncertain_conflict, uncertain_span
from cratous.core.well_clear.during import layer_window, violation_during_taumod
from cratous.core.well_clear.interval import (
    horizontal_interval_taumod,
    violation_interval_taumod,
)
from cratous.proofs.claim import Claim
from cratous.proofs.methods.detections import named_instant
from cratous.proofs.methods.kinds import TAUMOD
from cratous.proofs.methods.uncertainty import any_uncertain, spans_of
from cratous.spec import well_clear
from cratous.spec.daa import meaning as daa_meaning


def claim(c: Claim) -> None:
    asked = any_uncertain(c)
    s, v, sz, vz, (es, ez, ev, ew), limits, begin, end = asked
    dthr, zthr, tthr, tcoa, vmod = limits
    t = c.real("t")
    c.opaque(violation_during_taumod, violation_interval_taumod, circle_span, layer_span)
    c.opaque(horizontal_interval_taumod, layer_window)
    span = c.use(uncertain_span, *asked)
    spans = [daa_meaning.Span(*span_of) for span_of in spans_of(c, asked)]
    every = c.define(daa_meaning.in_own_or_both, *spans, begin, end, t)
    c.show(c.implies(every, c.define(well_clear.in_span, *span, t)), "holds them")
    for instant in span:
        at = c.define(daa_meaning.in_own_or_both, *spans, begin, end, instant)
        c.show(c.implies(span.first_s <= span.last_s, at), "is the least")
    plain = c.use(violation_during_taumod, s, v, sz, vz, limits, begin, end)
    unknown = c.all_of(es > 0, ez > 0, ev > 0, ew > 0, span.first_s <= span.last_s)
    c.show(c.same(c.use(uncertain_conflict, *asked), c.any_of(plain, unknown)), "a conflict")
    sizes = c.all_of(*[threshold >= 0 for threshold in limits])
    witness = c.real("witness")
    named_instant(c, TAUMOD, (s, v, sz, vz, begin, end), limits, witness)
    c.lemma(
        "well_clear_detection_taumod_is_the_interval", when=sizes, witness=witness,
        s=s, v=v, sz=sz, vz=vz, begin=begin, end=end,
        dthr=dthr, zthr=zthr, tthr=tthr, tcoa=tcoa, vmod=vmod,
    )  # fmt: skip
    found = c.use(uncertain_conflict, *asked)
    inexact = c.all_of(sizes, es > 0, ez > 0, ev > 0, ew > 0)
    c.show(c.implies(c.all_of(inexact, every), found), "a conflict misses no instant")
    at_first = c.define(daa_meaning.in_own_or_both, *spans, begin, end, span.first_s)
    c.show(c.implies(c.all_of(inexact, found), at_first), "and has one")
    c.lemma(
        "well_clear_interval_taumod_first_and_last_violate", when=sizes,
        s=s, v=v, sz=sz, vz=vz, begin=begin, end=end,
        dthr=dthr, zthr=zthr, tthr=tthr, tcoa=tcoa, vmod=vmod,
    )  # fmt: skip
    empty = c.all_of(span.first_s == 1, span.last_s == 0)
    c.show(c.implies(c.all_of(sizes, span.first_s > span.last_s), empty), "one empty span")
