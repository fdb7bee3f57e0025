"""Arbitrary values for theorems on states known within errors: growing discs, layers, and their spans."""

from __future__ import annotations

from typing import Any, NamedTuple

from cratous.core.daa.uncertainty import Uncertainty, circle_span, layer_span
from cratous.core.kernel import Vec2
from cratous.core.well_clear.interval import violation_interval_taumod
from cratous.core.well_clear.thresholds import Thresholds
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import any_state


class Uncertain(NamedTuple):
    """A state with its errors, thresholds and a window: the arguments of the kernels for uncertain states."""

    s: Vec2
    v: Vec2
    sz: Any
    vz: Any
    errors: Uncertainty
    limits: Thresholds
    begin: Any
    end: Any


def any_uncertain(c: Claim) -> Uncertain:
    """An arbitrary state, errors `es`, `ez`, `ev`, `ew`, thresholds, `begin` and `end`, of any sign."""
    state, limits = any_state(c), Thresholds(*c.reals("dthr zthr tthr tcoa vmod"))
    es, ez, ev, ew, begin, end = c.reals("es ez ev ew begin end")
    return Uncertain(*state, Uncertainty(es, ez, ev, ew), limits, begin, end)


def spans_of(c: Claim, asked: Uncertain) -> tuple[Any, Any, Any]:
    """The spans that the whole is composed of: the volume's own, the altitude's and the circle's."""
    s, v, sz, vz, (es, ez, ev, ew), limits, begin, end = asked
    dthr, zthr, tthr, tcoa, vmod = limits
    own = c.use(violation_interval_taumod, s, v, sz, vz, limits, begin, end)
    layer = c.use(layer_span, sz, vz, ez, ew, zthr, tcoa, vmod, end)
    circle = c.use(circle_span, s, v, es, ev, dthr, tthr, end)
    return own, layer, circle


class Disc(NamedTuple):
    """A position with a growing disc, and the quadratic, eventually rising, that tells when it is within a circle."""

    s: Vec2
    v: Vec2
    es: Any
    ev: Any
    dthr: Any
    spare: Any
    half: Any
    rest: Any


def any_growing_disc(c: Claim) -> Disc:
    """Arbitrary `s`, `v`, errors `es`, `ev` and `dthr`, not negative, where the speed exceeds its error."""
    s, v = c.vector("s"), c.vector("v")
    es, ev, dthr = c.reals("es ev dthr")
    for least in (es, ev, dthr):
        c.premise(least >= 0)
    wide = dthr + es
    spare = v.x * v.x + v.y * v.y - ev * ev
    half = s.x * v.x + s.y * v.y - ev * wide
    rest = s.x * s.x + s.y * s.y - wide * wide
    c.premise(spare > 0)
    return Disc(s, v, es, ev, dthr, spare, half, rest)


def layer_lies_within(
    c: Claim, kernel: Any, names: str, inner: tuple[Any, str], inner_names: str
) -> None:
    """The span of a layer over [0, T] lies within it or is empty, since this is so for the kernel that it calls.

    names: of the arguments of the kernel, the last four zthr, tcoa, vmod and end, not negative; inner: the kernel
    that it calls and the theorem that this one's spans lie within the window, inner_names: its arguments.
    """
    arguments = c.reals(names)
    *_, zthr, tcoa, vmod, end = arguments
    for least in (zthr, tcoa, vmod, end):
        c.premise(least >= 0)
    asked, lemma = inner
    c.opaque(asked)
    first, last = c.use(kernel, *arguments)
    for args in c.calls(asked):
        c.lemma(lemma, **dict(zip(inner_names.split(), args, strict=True)))
    c.show(c.implies(first <= last, c.all_of(first >= 0, last <= end)))
