"""Theorems on well-clear volumes as sets, for tau_mod, tcpa and tep.

Each function states one theorem for any of these volumes.
"""

from __future__ import annotations

from typing import Any

from cratous.core.kernel import Vec2
from cratous.core.well_clear import layer_violation, vertical_interval
from cratous.core.well_clear.thresholds import Thresholds
from cratous.proofs.claim import Claim
from cratous.proofs.methods.encounters import (
    any_in_the_plane,
    any_instants,
    any_loss,
    any_nested_thresholds,
    any_state,
    by_name,
)
from cratous.proofs.methods.kinds import Volume
from cratous.spec import well_clear


def horizontal_is_its_definition(c: Claim, horizontal_now: Any, meant_horizontally: Any) -> None:
    """The horizontal kernel says violated exactly where its definition does."""
    s, v, dthr, tthr = any_in_the_plane(c)
    verdict = c.use(horizontal_now, s, v, dthr, tthr)
    c.show(c.same(verdict, c.define(meant_horizontally, s, v, dthr, tthr)))


def vertical_is_its_definition(
    c: Claim, threshold: str, vertical_now: Any, meant_vertically: Any
) -> None:
    """The vertical kernel says violated exactly where its definition does; threshold: the one beside ZTHR."""
    sz, vz, zthr, other = c.reals(f"sz vz zthr {threshold}")
    c.premise(zthr >= 0)
    c.premise(other >= 0)
    verdict = c.use(vertical_now, sz, vz, zthr, other)
    c.show(c.same(verdict, c.define(meant_vertically, sz, vz, zthr, other)))


def decision_is_the_definition(c: Claim, decision: Any, meant_horizontally: Any) -> None:
    """The decision from the invariants of a state equals that of the definition for the state."""
    s, v, dthr, tthr = any_in_the_plane(c)
    ss, vv = s.x * s.x + s.y * s.y, v.x * v.x + v.y * v.y
    sv, cross = s.x * v.x + s.y * v.y, s.x * v.y - s.y * v.x
    verdict = c.use(decision, ss, vv, sv, cross, dthr * dthr, tthr)
    c.show(c.same(verdict, c.define(meant_horizontally, s, v, dthr, tthr)))


def horizontal_scales(c: Claim, volume: Volume) -> None:
    """Kernel and definition do not change if s, DTHR and TTHR are scaled by the same positive factor."""
    s, v, dthr, tthr = any_in_the_plane(c)
    k = c.real("k")
    c.premise(k > 0)
    here, scaled = (s, v, dthr, tthr), (Vec2(k * s.x, k * s.y), v, k * dthr, k * tthr)
    for at, w, d, t in (here, scaled):
        c.lemma(
            f"well_clear_{volume.flat.now.__name__}_is_its_definition", s=at, v=w, dthr=d, tthr=t
        )
    near, far = c.use(volume.flat.now, *here), c.use(volume.flat.now, *scaled)
    c.show(c.same(near, far), "the kernel does not")
    meant = c.define(volume.meant.flat, *here), c.define(volume.meant.flat, *scaled)
    c.show(c.same(*meant), "the definition does not")


def horizontal_is_monotone(
    c: Claim,
    horizontal_now: Any,
) -> None:
    """The horizontal volume grows with DTHR and TTHR."""
    s, v, dthr, tthr = any_in_the_plane(c)
    dthr2, tthr2 = c.reals("dthr2 tthr2")
    c.premise(dthr <= dthr2)
    c.premise(tthr <= tthr2)
    before = c.use(horizontal_now, s, v, dthr, tthr)
    wider = c.use(horizontal_now, s, v, dthr2, tthr)
    c.step(c.implies(before, wider), "in DTHR")
    after = c.use(horizontal_now, s, v, dthr2, tthr2)
    c.step(c.implies(wider, after), "in TTHR")
    c.show(c.implies(before, after), "in both")


def volume_is_convex(c: Claim, volume: Volume) -> None:
    """If two instants of straight flight violate the volume, so do those between them."""
    s, v, sz, vz, limits = any_loss(c)
    early, middle, late = any_instants(c, "early middle late")
    c.opaque(volume.space.interval, volume.meant.at)
    size = by_name(limits)
    state = {"s": s, "v": v, "sz": sz, "vz": vz, "begin": early, "end": late}
    c.use(volume.space.interval, s, v, sz, vz, limits, early, late)
    lost = []
    for t in (early, middle, late):
        c.lemma(f"well_clear_interval_{volume.name}_is_exact", t=t, **state, **size)
        arguments = (s, v, sz, vz, limits, t)
        lost.append(c.define(volume.meant.at, *arguments))
    c.show(c.implies(c.all_of(lost[0], lost[2]), lost[1]))


def volume_is_monotone(c: Claim, volume: Volume) -> None:
    """The volume grows with each of its thresholds."""
    s, v, sz, vz = any_state(c)
    small, great = any_nested_thresholds(c)
    c.opaque(volume.flat.now, layer_violation)
    before = c.use(volume.space.now, s, v, sz, vz, small)
    after = c.use(volume.space.now, s, v, sz, vz, great)
    both_parts_grow(
        c, f"well_clear_horizontal_{volume.name}_is_monotone", (s, v, sz, vz), small, great
    )
    c.show(c.implies(before, after))


def both_parts_grow(
    c: Claim, flat: str, state: tuple[Any, Any, Any, Any], small: Thresholds, great: Thresholds
) -> None:
    """Use that both parts of a volume grow with their thresholds; flat: the theorem on the horizontal part."""
    s, v, sz, vz = state
    (dthr, zthr, tthr, tcoa, vmod), (dthr2, zthr2, tthr2, tcoa2, vmod2) = small, great
    c.lemma(flat, s=s, v=v, dthr=dthr, tthr=tthr, dthr2=dthr2, tthr2=tthr2)
    c.lemma(
        "well_clear_vertical_volume_is_monotone",
        sz=sz, vz=vz, zthr=zthr, tcoa=tcoa, vmod=vmod, zthr2=zthr2, tcoa2=tcoa2, vmod2=vmod2,
    )  # fmt: skip


def volume_is_symmetric(c: Claim, volume: Volume) -> None:
    """Seen from the intruder, the present verdict and the span are the same."""
    s, v, sz, vz, limits = any_loss(c)
    dthr, zthr, tthr, tcoa, vmod = limits
    begin, end = c.reals("begin end")
    c.opaque(volume.flat.interval, volume.flat.now, layer_violation, vertical_interval)
    back = (Vec2(0 - s.x, 0 - s.y), Vec2(0 - v.x, 0 - v.y), 0 - sz, 0 - vz)
    low, high = c.use(vertical_interval, sz, vz, zthr, tcoa, vmod, begin, end)
    low_back, high_back = c.use(vertical_interval, 0 - sz, 0 - vz, zthr, tcoa, vmod, begin, end)
    c.lemma(
        "well_clear_vertical_volume_is_symmetric",
        sz=sz, vz=vz, zthr=zthr, tcoa=tcoa, vmod=vmod, begin=begin, end=end,
    )  # fmt: skip
    c.lemma(
        "well_clear_horizontal_volumes_are_symmetric",
        s=s, v=v, dthr=dthr, tthr=tthr, begin=low, end=high,
    )  # fmt: skip
    c.congruence(
        volume.flat.interval,
        (back[0], back[1], dthr, tthr, low, high),
        (back[0], back[1], dthr, tthr, low_back, high_back),
    )
    ours = c.use(volume.space.now, s, v, sz, vz, limits)
    c.show(c.same(ours, c.use(volume.space.now, *back, limits)), "now")
    span = c.use(volume.space.interval, s, v, sz, vz, limits, begin, end)
    c.show(c.same(span, c.use(volume.space.interval, *back, limits, begin, end)), "the span")


def violation_is_its_definition(c: Claim, volume: Volume) -> None:
    """The kernel in space says lost now exactly where its definition does."""
    s, v, sz, vz, limits = any_loss(c)
    dthr, zthr, tthr, tcoa, vmod = limits
    c.opaque(volume.meant.flat, well_clear.layer_violation)
    lost = c.define(volume.meant.at, s, v, sz, vz, limits, sz - sz)
    c.lemma(
        f"well_clear_{volume.flat.now.__name__}_is_its_definition", s=s, v=v, dthr=dthr, tthr=tthr
    )
    c.lemma(
        "well_clear_layer_violation_is_its_definition",
        sz=sz, vz=vz, zthr=zthr, tcoa=tcoa, vmod=vmod,
    )  # fmt: skip
    c.show(c.same(c.use(volume.space.now, s, v, sz, vz, limits), lost))
