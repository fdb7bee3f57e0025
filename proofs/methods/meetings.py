"""Arbitrary values for theorems on a vehicle that meets an intruder: tubes, positions within them, cylinders."""

from __future__ import annotations

from typing import Any

from cratous.core.permit.pieces import Growth, Margins, Meeting, Tube
from cratous.proofs.claim import Claim
from cratous.spec.permit import motion

FIELDS = ("start", "rate", "gain")


def any_tube(c: Claim) -> Tube:
    """An arbitrary tube: radii `wide_start`, ..., `high_gain`; none negative."""
    tube = _tube(c)
    _none_shrinks(c, tube)
    return tube


def any_offs(c: Claim) -> motion.Offs:
    """Arbitrary deviations: the vehicle's from its reference (`own_x`, ...), the intruder's from its prediction."""
    own, other = (motion.Off(*c.reals(f"{name}_x {name}_y {name}_z")) for name in ("own", "other"))
    return motion.Offs(own, other)


def any_margins(c: Claim) -> Margins:
    """An arbitrary cylinder of `radius` and `half` height, and `rho` about the reference; none negative."""
    margins = Margins(c.real("radius"), c.real("half"), c.real("rho"))
    c.premise(c.all_of(margins.rho_m >= 0, margins.radius_m >= 0, margins.half_m >= 0))
    return margins


def any_guard(c: Claim) -> tuple[Tube, Margins, motion.Offs]:
    """An arbitrary tube, cylinder and deviations, which together determine how close is too close."""
    return any_tube(c), any_margins(c), any_offs(c)


def clear_is_not_hit(
    c: Claim, clear: Any, state: tuple[Any, ...], guard: tuple[Tube, Margins, motion.Offs], t: Any
) -> None:
    """Show that a clear state is not hit at t: entering the cylinder would be near."""
    tube, margins, offs = guard
    s, v, sz, vz = state
    hit = c.define(motion.hit_at, s, v, sz, vz, offs, tube, margins, t)
    c.lemma(
        "permit_entered_is_near", s=s, v=v, sz=sz, vz=vz, t=t,
        **margins_by_name(margins), **tube_by_name(tube), **offs_by_name(offs),
    )  # fmt: skip
    c.show(c.implies(clear, c.negation(hit)))


def any_meeting(c: Claim) -> Meeting:
    """An arbitrary intruder at the start of a trajectory: position `s`, `sz`, velocity `w`, `wz`, its tube, and the
    cylinder of `radius` and `half` height to keep clear; no radius is negative or shrinks."""
    tube = _tube(c)
    s, w = c.vector("s"), c.vector("w")
    sz, wz, radius, half = c.reals("sz wz radius half")
    _none_shrinks(c, tube)
    c.premise(c.all_of(radius >= 0, half >= 0))
    return Meeting(s, sz, w, wz, tube.wide, tube.high, radius, half)


def about(tube: Tube, margins: Margins) -> tuple[Growth, Growth]:
    """How close the reference may come to the prediction, horizontally and in altitude, over time."""
    wide, high = tube
    around = Growth(wide.start_m + margins.radius_m + margins.rho_m, wide.rate_m_s, wide.gain_m_s2)
    layer = Growth(high.start_m + margins.half_m + margins.rho_m, high.rate_m_s, high.gain_m_s2)
    return around, layer


def growth_by_name(growth: Growth) -> dict[str, Any]:
    """A radius under the names that theorems use, for lemmas."""
    return dict(zip(FIELDS, growth, strict=True))


def tube_by_name(tube: Tube) -> dict[str, Any]:
    """A tube under the names that theorems use, for lemmas."""
    parts = (("wide", tube.wide), ("high", tube.high))
    return {
        f"{name}_{field}": v
        for name, growth in parts
        for field, v in zip(FIELDS, growth, strict=True)
    }


def margins_by_name(margins: Margins) -> dict[str, Any]:
    """Margins under the names that theorems use, for lemmas."""
    return {"radius": margins.radius_m, "half": margins.half_m, "rho": margins.rho_m}


def offs_by_name(offs: motion.Offs) -> dict[str, Any]:
    """Deviations under the names that theorems use, for lemmas."""
    parts = (("own", offs.own), ("other", offs.other))
    return {f"{name}_{axis}": v for name, off in parts for axis, v in zip("xyz", off, strict=True)}


def any_growth(c: Claim) -> Growth:
    """An arbitrary growing radius (`start`, `rate`, `gain`), none of the three negative."""
    growth = Growth(*c.reals("start rate gain"))
    _grows(c, growth)
    return growth


def _tube(c: Claim) -> Tube:
    wide, high = (Growth(*c.reals(f"{n}_start {n}_rate {n}_gain")) for n in ("wide", "high"))
    return Tube(wide, high)


def _none_shrinks(c: Claim, tube: Tube) -> None:
    for growth in tube:
        _grows(c, growth)


def _grows(c: Claim, growth: Growth) -> None:
    c.premise(c.all_of(growth.start_m >= 0, growth.rate_m_s >= 0, growth.gain_m_s2 >= 0))
